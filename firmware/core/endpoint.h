/* The board's end of the wire: frames in, frames out. Each command is carried out once: one that
 * comes again, because its answer was lost, is answered again.
 *
 * Until its first Hello the board takes only stops and sends no telemetry, so that what else opens
 * the link sees silence.
 */
#ifndef DV_ENDPOINT_H
#define DV_ENDPOINT_H

#include "frames.h"
#include "messages.h"
#include "outbox.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dv_endpoint {
    struct dv_frame_reader reader;
    struct dv_outbox outbox;
    bool greeted;
    uint8_t last;                      /* the sequence of the last command */
    struct dv_out_frame answer;        /* to it; of no size until it is there */
    uint8_t sequences[DV_TOOL + 1]; /* of the last command of each type */
};

void dv_endpoint_init(struct dv_endpoint *endpoint);

/* Whether a well-formed message is to be carried out. */
bool dv_endpoint_admits(struct dv_endpoint *endpoint, const struct dv_frame *frame);

/* `answered` is the type of the command that a message answers, 0 for none. */
void dv_endpoint_send(struct dv_endpoint *endpoint, uint8_t type, uint8_t answered,
                      const uint8_t *payload, size_t size);

#endif
