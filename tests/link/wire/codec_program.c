/* Reads bytes from its input and says what it made of them, a line a frame: the payload as it is
 * encoded again, or that it is malformed; at the end, how many frames were dropped.
 */
#include "frames.h"
#include "messages.h"

#include <stdio.h>
#include <stdlib.h>

#define CASE(TYPE, name)                                                              \
    case TYPE: {                                                                      \
        struct dv_##name message;                                                     \
        return dv_decode_##name(frame->payload, frame->size, &message)                \
            ? (long)dv_encode_##name(&message, out, room)                             \
            : -1;                                                                     \
    }
#define EMPTY(TYPE, name)                                                             \
    case TYPE:                                                                        \
        return dv_decode_##name(frame->payload, frame->size) ? 0 : -1;

/* The size of the payload, encoded again; -1: malformed. */
static long again(const struct dv_frame *frame, uint8_t *out, size_t room)
{
    switch (frame->type) {
        CASE(DV_HELLO, hello)
        CASE(DV_CONFIGURE, configure)
        CASE(DV_ENABLE, enable)
        EMPTY(DV_HOME, home)
        CASE(DV_ARM, arm)
        CASE(DV_SEGMENT, segment)
        CASE(DV_CARTESIAN_SEGMENT, cartesian_segment)
        CASE(DV_KEEP, keep)
        EMPTY(DV_STOP, stop)
        EMPTY(DV_ESTOP, estop)
        EMPTY(DV_RESET, reset)
        CASE(DV_TOOL, tool)
        CASE(DV_HELLO_REPLY, hello_reply)
        CASE(DV_CONFIGURED, configured)
        CASE(DV_REFUSED, refused)
        CASE(DV_DONE, done)
        CASE(DV_TELEMETRY, telemetry)
        CASE(DV_STOPPED, stopped)
    default:
        return -1;
    }
}

int main(void)
{
    struct dv_frame_reader *reader = malloc(sizeof *reader); /* so that its bounds are watched */
    if (reader == NULL) {
        return 1;
    }
    dv_frame_reader_init(reader);
    for (int byte = getchar(); byte != EOF; byte = getchar()) {
        struct dv_frame frame;
        if (!dv_frame_read(reader, (uint8_t)byte, &frame)) {
            continue;
        }
        uint8_t payload[DV_PAYLOAD_MAX];
        long size = again(&frame, payload, sizeof payload);
        printf("%02x %02x ", frame.type, frame.sequence);
        for (long i = 0; i < size; i++) {
            printf("%02x", payload[i]);
        }
        puts(size < 0 ? "malformed" : "");
    }
    printf("%lu dropped\n", (unsigned long)reader->dropped);
    free(reader);
    return 0;
}
