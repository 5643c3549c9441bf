/* A whole board and a host of no sense: what comes is cut into steps, each an operation and what it
 * needs. Frames get their CRC here, or nothing would pass the reader.
 *
 *     0  bytes on the wire      length (two bytes, as all numbers), bytes
 *     1  a frame                type, sequence, length, payload
 *     2  time passes            ticks
 *     3  what the inputs read   levels
 *     4  the next command       type, length, payload: with the sequence that is its turn
 *
 * Whatever comes, it stays within its memory, sends well-formed frames, and the steps that have left
 * are the count, but for two ticks.
 */
#include "frames.h"
#include "host.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define TICK_HZ 20000u
#define TICKS_MOST 8000u /* of one input */

struct input {
    const uint8_t *at;
    size_t left;
};

static void require(int condition)
{
    if (!condition) {
        abort();
    }
}

static uint8_t next(struct input *input)
{
    if (input->left == 0) {
        return 0;
    }
    input->left--;
    return *input->at++;
}

static uint32_t next_number(struct input *input)
{
    uint32_t low = next(input);
    return low + 256u * next(input);
}

static struct input next_bytes(struct input *input)
{
    size_t size = next_number(input);
    size = size < input->left ? size : input->left;
    struct input bytes = {input->at, size};
    input->at += size;
    input->left -= size;
    return bytes;
}

static void send_frame(struct dv_host *host, uint8_t type, uint8_t sequence, struct input payload)
{
    uint8_t frame[DV_FRAME_ROOM(DV_PAYLOAD_MAX)];
    size_t size =
        dv_frame_write(type, sequence, payload.at, payload.left, frame, sizeof frame);
    dv_host_feed(host, frame, size);
}

static void read_answers(struct dv_host *host)
{
    uint8_t bytes[512];
    struct dv_frame frame;
    struct dv_frame_reader reader;
    size_t size;
    dv_frame_reader_init(&reader);
    while ((size = dv_host_take(host, bytes, sizeof bytes)) > 0) {
        for (size_t i = 0; i < size; i++) {
            require(!dv_frame_read(&reader, bytes[i], &frame) || frame.type >= DV_HELLO_REPLY);
        }
    }
    require(reader.dropped == 0 && !reader.begun);
}

static void require_steps(const struct dv_host *host)
{
    struct dv_host_view view;
    dv_host_look(host, &view);
    for (int i = 0; i < view.joints; i++) {
        int64_t behind = (int64_t)view.counts[i] - view.emitted[i];
        require(-1 <= behind && behind <= 1);
    }
}

static uint32_t pass(struct dv_host *host, uint32_t ticks, uint32_t *to_boundary)
{
    for (uint32_t left = ticks; left > 0;) {
        uint32_t passed = dv_host_run(host, left < *to_boundary ? left : *to_boundary, NULL);
        left -= passed;
        *to_boundary -= passed;
        if (*to_boundary == 0) {
            *to_boundary = TICK_HZ / 1000;
            dv_host_control(host);
            read_answers(host);
        }
        require_steps(host);
    }
    return ticks;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct input input = {data, size};
    struct dv_host *host = dv_host_new(TICK_HZ, UINT32_MAX - 1000, 65530, 1);
    uint32_t ticks = 0, to_boundary = TICK_HZ / 1000;
    uint8_t sequence = 1, other;
    if (host == NULL) {
        return 0;
    }
    while (input.left > 0 && ticks < TICKS_MOST) {
        uint8_t operation = next(&input) % 5, type;
        struct input bytes;
        switch (operation) {
        case 0:
            bytes = next_bytes(&input);
            dv_host_feed(host, bytes.at, bytes.left);
            break;
        case 1:
            type = next(&input);
            other = next(&input);
            send_frame(host, type, other, next_bytes(&input));
            break;
        case 2:
            ticks += pass(host, next_number(&input) % 1000u, &to_boundary);
            break;
        case 3:
            dv_host_set_inputs(host, next(&input));
            break;
        default:
            type = next(&input);
            sequence = (uint8_t)(sequence % 255 + 1);
            send_frame(host, type, sequence, next_bytes(&input));
            break;
        }
        read_answers(host);
    }
    dv_host_free(host);
    return 0;
}
