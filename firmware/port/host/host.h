/* The board on this machine: a shared library for tests. The caller is the wire, the clock, and what
 * hangs on the pins.
 *
 * Nothing runs by itself. `dv_host_run` lets ticks pass and stops where a piece begins; the caller
 * then sets the inputs and calls `dv_host_control`, at once or, to see what a late one does, later.
 */
#ifndef DV_HOST_H
#define DV_HOST_H

#include "board.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dv_host;

/* What there is to see. */
struct dv_host_view {
    uint32_t now;
    uint32_t configuration; /* hash, 0: none */
    uint8_t state, fault, cause, joints;
    bool homed, moving;
    bool drivers_known, drivers_on, drivers_active_high;
    bool tool_on;
    float servo_angle;
    uint32_t fed; /* how often the watchdog was */
    int32_t counts[DV_JOINTS_MAX];
    int32_t emitted[DV_JOINTS_MAX];   /* steps that have left */
    int64_t positions[DV_JOINTS_MAX]; /* Q32 */
    int64_t travelled[DV_JOINTS_MAX]; /* microsteps that the counts have run through, since power-up */
};

/* A board that was just switched on. NULL: no memory. */
struct dv_host *dv_host_new(uint32_t tick_hz, uint32_t now, uint16_t last_epoch, uint32_t boot);
void dv_host_free(struct dv_host *host);

/* Once configured: enabled and homed at the ready pose. */
void dv_host_assume_homed(struct dv_host *host);

/* Bytes arrive and are carried out. */
void dv_host_feed(struct dv_host *host, const uint8_t *bytes, size_t size);

/* What was sent since the last call, in whole frames, up to `room` bytes; how many. */
size_t dv_host_take(struct dv_host *host, uint8_t *bytes, size_t room);

/* How many bytes `write` takes until the next `dv_host_take`. */
void dv_host_set_write_room(struct dv_host *host, size_t room);

/* Lets at most `ticks` pass, up to where a piece begins; how many passed. The pins (DV_PINS_...) at
 * each of them are written to `pins`, unless it is NULL.
 */
uint32_t dv_host_run(struct dv_host *host, uint32_t ticks, uint16_t *pins);

/* The levels (enum dv_level) that the inputs read from now on. */
void dv_host_set_inputs(struct dv_host *host, uint8_t levels);

/* The control interrupt. */
void dv_host_control(struct dv_host *host);

/* The next time that the main loop lets control in, so many pieces pass before it keeps it out again:
 * while a segment is judged, if one comes next.
 */
void dv_host_set_meanwhile(struct dv_host *host, uint32_t pieces);

void dv_host_look(const struct dv_host *host, struct dv_host_view *view);

#endif
