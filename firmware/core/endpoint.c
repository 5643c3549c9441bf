#include "endpoint.h"

#include <string.h>

void dv_endpoint_init(struct dv_endpoint *endpoint)
{
    memset(endpoint, 0, sizeof *endpoint);
    dv_frame_reader_init(&endpoint->reader);
    dv_outbox_init(&endpoint->outbox);
}

/* Those that are numbered, sent one at a time, repeated until they are answered. */
static bool is_command(uint8_t type)
{
    switch (type) {
    case DV_HELLO:
    case DV_CONFIGURE:
    case DV_ENABLE:
    case DV_HOME:
    case DV_ARM:
    case DV_RESET:
    case DV_TOOL:
        return true;
    default:
        return false;
    }
}

static bool is_newer(uint8_t sequence, uint8_t last)
{
    uint8_t ahead = (uint8_t)(sequence - last);
    return 1 <= ahead && ahead <= 127;
}

static bool is_turn(struct dv_endpoint *endpoint, uint8_t type, uint8_t sequence)
{
    if (endpoint->greeted && sequence == endpoint->last) {
        if (endpoint->answer.size > 0) {
            dv_outbox_put(&endpoint->outbox, &endpoint->answer, false);
        }
        return false;
    }
    if (sequence == 0 || (type != DV_HELLO && !is_newer(sequence, endpoint->last))) {
        return false;
    }
    if (type == DV_HELLO) {
        endpoint->greeted = true;
        memset(endpoint->sequences, 0, sizeof endpoint->sequences);
    }
    endpoint->last = sequence;
    endpoint->answer.size = 0;
    endpoint->sequences[type] = sequence;
    return true;
}

bool dv_endpoint_admits(struct dv_endpoint *endpoint, const struct dv_frame *frame)
{
    uint8_t type = frame->type;
    if (!endpoint->greeted && type != DV_HELLO && type != DV_STOP && type != DV_ESTOP) {
        return false;
    }
    return !is_command(type) || is_turn(endpoint, type, frame->sequence);
}

void dv_endpoint_send(struct dv_endpoint *endpoint, uint8_t type, uint8_t answered,
                      const uint8_t *payload, size_t size)
{
    struct dv_out_frame frame;
    bool is_answer = is_command(answered), is_telemetry = type == DV_TELEMETRY;
    uint8_t sequence = is_answer ? endpoint->sequences[answered] : 0;
    if (is_telemetry && !endpoint->greeted) {
        return;
    }
    frame.size =
        (uint8_t)dv_frame_write(type, sequence, payload, size, frame.bytes, sizeof frame.bytes);
    if (frame.size == 0) {
        return;
    }
    dv_outbox_put(&endpoint->outbox, &frame, is_telemetry);
    if (is_answer && sequence == endpoint->last) {
        endpoint->answer = frame;
    }
}
