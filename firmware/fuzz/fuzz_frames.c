/* Any bytes into the reader of frames and the decoders: nothing is read out of bounds, and what is
 * taken for a message is written again byte for byte.
 */
#include "frames.h"
#include "messages.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define AGAIN(TYPE, name)                                                                     \
    case TYPE: {                                                                              \
        struct dv_##name message;                                                             \
        if (dv_decode_##name(frame->payload, frame->size, &message)) {                        \
            require_same(frame, again, dv_encode_##name(&message, again, sizeof again));      \
        }                                                                                     \
        break;                                                                                \
    }
#define EMPTY(TYPE, name)                                                                     \
    case TYPE:                                                                                \
        dv_decode_##name(frame->payload, frame->size);                                        \
        break;

static void require_same(const struct dv_frame *frame, const uint8_t *again, size_t size)
{
    if (size != frame->size || memcmp(again, frame->payload, size) != 0) {
        abort();
    }
}

static void decode(const struct dv_frame *frame)
{
    uint8_t again[DV_PAYLOAD_MAX];
    switch (frame->type) {
        AGAIN(DV_HELLO, hello)
        AGAIN(DV_CONFIGURE, configure)
        AGAIN(DV_ENABLE, enable)
        EMPTY(DV_HOME, home)
        AGAIN(DV_ARM, arm)
        AGAIN(DV_SEGMENT, segment)
        AGAIN(DV_CARTESIAN_SEGMENT, cartesian_segment)
        AGAIN(DV_KEEP, keep)
        EMPTY(DV_STOP, stop)
        EMPTY(DV_ESTOP, estop)
        EMPTY(DV_RESET, reset)
        AGAIN(DV_TOOL, tool)
        AGAIN(DV_HELLO_REPLY, hello_reply)
        AGAIN(DV_CONFIGURED, configured)
        AGAIN(DV_REFUSED, refused)
        AGAIN(DV_DONE, done)
        AGAIN(DV_TELEMETRY, telemetry)
        AGAIN(DV_STOPPED, stopped)
    default:
        break;
    }
}

/* As bytes on the wire, and as a frame that arrived whole: type, sequence, payload. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct dv_frame frame;
    struct dv_frame_reader *reader = malloc(sizeof *reader);
    if (reader == NULL) {
        return 0;
    }
    dv_frame_reader_init(reader);
    for (size_t i = 0; i < size; i++) {
        if (dv_frame_read(reader, data[i], &frame)) {
            decode(&frame);
        }
    }
    free(reader);
    if (size >= 2 && size - 2 <= DV_PAYLOAD_MAX) {
        frame = (struct dv_frame){data[0], data[1], data + 2, size - 2};
        decode(&frame);
    }
    return 0;
}
