/* The frames that wait to be sent, in order. Telemetry is the first to be dropped: it takes no more
 * than half of the room. The next telemetry says all that the last one did.
 *
 * Control and the main loop put, the main loop takes; control is kept out of both.
 */
#ifndef DV_OUTBOX_H
#define DV_OUTBOX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DV_OUTBOX_PLACES 32
#define DV_OUTBOX_FRAME_MAX 96 /* bytes of the longest frame that a board sends */

struct dv_out_frame {
    uint8_t size; /* bytes */
    uint8_t bytes[DV_OUTBOX_FRAME_MAX];
};

struct dv_outbox {
    uint8_t first, count;
    struct dv_out_frame frames[DV_OUTBOX_PLACES];
};

void dv_outbox_init(struct dv_outbox *outbox);

/* What finds no room is dropped. */
void dv_outbox_put(struct dv_outbox *outbox, const struct dv_out_frame *frame, bool is_telemetry);

/* NULL when there is none. Stays where it is until it is removed. */
const struct dv_out_frame *dv_outbox_first(const struct dv_outbox *outbox);

void dv_outbox_remove_first(struct dv_outbox *outbox);

#endif
