/* Frames: COBS(type, sequence, payload, CRC-32) and a zero byte.
 *
 * A zero byte ends every frame and occurs nowhere else, so a reader that has lost its way finds it
 * again at the next one. The CRC-32 is zlib's, over type, sequence and payload, little-endian.
 */
#ifndef DV_FRAMES_H
#define DV_FRAMES_H

#include "messages.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DV_FRAME_OVERHEAD 6 /* bytes: type, sequence, CRC-32 */
#define DV_FRAME_MAX (DV_PAYLOAD_MAX + DV_FRAME_OVERHEAD)

/* COBS adds a byte, and another for each 254; then the zero. */
#define DV_FRAME_ROOM(payload) \
    ((payload) + DV_FRAME_OVERHEAD + ((payload) + DV_FRAME_OVERHEAD) / 254 + 2)

/* A frame that arrived whole; `payload` stays valid until the reader gets its next byte. */
struct dv_frame {
    uint8_t type;
    uint8_t sequence;
    const uint8_t *payload;
    size_t size; /* bytes */
};

struct dv_frame_reader {
    uint32_t dropped; /* frames that were too short, too long or damaged */
    size_t size;      /* decoded bytes of the present frame, one beyond DV_FRAME_MAX: too long */
    uint8_t block;    /* bytes until the next code byte */
    bool zero;        /* a zero stands before the next block */
    bool begun;       /* a byte has come since the last zero */
    uint8_t bytes[DV_FRAME_MAX];
};

void dv_frame_reader_init(struct dv_frame_reader *reader);

/* True when `byte` completes a frame. */
bool dv_frame_read(struct dv_frame_reader *reader, uint8_t byte, struct dv_frame *frame);

/* The length of the frame in `out`, its zero included; 0: no room, or too long a payload. */
size_t dv_frame_write(uint8_t type, uint8_t sequence, const uint8_t *payload, size_t size,
                      uint8_t *out, size_t room);

/* zlib's CRC-32. */
uint32_t dv_crc32(const uint8_t *bytes, size_t count);

#endif
