/* The board's lease on its host's attention: motion needs a host that saw recent telemetry. */
#ifndef DV_LEASE_H
#define DV_LEASE_H

#include <stdbool.h>
#include <stdint.h>

/* Alive for `ticks` after the newest telemetry tick that the host is known to have seen. */
struct dv_lease {
    uint32_t ticks;
    uint32_t seen; /* while it is alive */
    bool alive;
};

void dv_lease_init(struct dv_lease *lease, uint32_t ticks);

/* A `seen` in the future, expired, or older than the one that counts changes nothing. */
void dv_lease_extend(struct dv_lease *lease, uint32_t seen, uint32_t now);

/* While it is alive: ticks from `tick` until it ends. */
int32_t dv_lease_remaining(const struct dv_lease *lease, uint32_t tick);

/* Forgets `seen`, so that it is never compared with a counter that has wrapped since. */
void dv_lease_expire(struct dv_lease *lease);

#endif
