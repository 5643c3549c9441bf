#include "lease.h"

#include "integers.h"

void dv_lease_init(struct dv_lease *lease, uint32_t ticks)
{
    *lease = (struct dv_lease){.ticks = ticks};
}

void dv_lease_extend(struct dv_lease *lease, uint32_t seen, uint32_t now)
{
    uint32_t age = now - seen; /* of one in the future, too large */
    if (age < lease->ticks && (!lease->alive || dv_since(seen, lease->seen) > 0)) {
        lease->seen = seen;
        lease->alive = true;
    }
}

int32_t dv_lease_remaining(const struct dv_lease *lease, uint32_t tick)
{
    return (int32_t)(lease->ticks - (tick - lease->seen));
}

void dv_lease_expire(struct dv_lease *lease)
{
    lease->alive = false;
}
