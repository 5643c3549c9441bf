#include "frames.h"

#include "bytes.h"

/* The remainders of the sixteen nibbles by the reflected polynomial 0xEDB88320. */
static const uint32_t remainders[16] = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
};

static uint32_t crc_add(uint32_t crc, uint8_t byte)
{
    crc ^= byte;
    crc = (crc >> 4) ^ remainders[crc & 0xF];
    return (crc >> 4) ^ remainders[crc & 0xF];
}

static uint32_t crc_of(uint32_t crc, const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        crc = crc_add(crc, bytes[i]);
    }
    return crc;
}

uint32_t dv_crc32(const uint8_t *bytes, size_t count)
{
    return ~crc_of(UINT32_MAX, bytes, count);
}

/* Reading. */

void dv_frame_reader_init(struct dv_frame_reader *reader)
{
    memset(reader, 0, sizeof *reader);
}

static void begin(struct dv_frame_reader *reader)
{
    reader->size = 0;
    reader->block = 0;
    reader->zero = false;
    reader->begun = false;
}

static void take(struct dv_frame_reader *reader, uint8_t byte)
{
    if (reader->size < DV_FRAME_MAX) {
        reader->bytes[reader->size] = byte;
        reader->size++;
    } else {
        reader->size = DV_FRAME_MAX + 1;
    }
}

static bool finish(const struct dv_frame_reader *reader, struct dv_frame *frame)
{
    if (reader->block != 0 || reader->size < DV_FRAME_OVERHEAD || reader->size > DV_FRAME_MAX) {
        return false;
    }
    size_t covered = reader->size - 4;
    struct dv_reader tail = {reader->bytes + covered, 4, true};
    if (dv_read_u32(&tail) != dv_crc32(reader->bytes, covered)) {
        return false;
    }
    frame->type = reader->bytes[0];
    frame->sequence = reader->bytes[1];
    frame->payload = reader->bytes + 2;
    frame->size = covered - 2;
    return true;
}

bool dv_frame_read(struct dv_frame_reader *reader, uint8_t byte, struct dv_frame *frame)
{
    if (byte == 0) {
        bool whole = finish(reader, frame);
        if (reader->begun && !whole) {
            reader->dropped++;
        }
        begin(reader);
        return whole;
    }
    reader->begun = true;
    if (reader->block > 0) {
        reader->block--;
        take(reader, byte);
        return false;
    }
    if (reader->zero) {
        take(reader, 0);
    }
    reader->block = (uint8_t)(byte - 1);
    reader->zero = byte != UINT8_MAX; /* the longest block has no zero behind it */
    return false;
}

/* Writing. */

struct encoder {
    uint8_t *out;
    size_t code;  /* where the present block's code byte stands */
    size_t count; /* bytes written */
};

static void close_block(struct encoder *encoder)
{
    encoder->out[encoder->code] = (uint8_t)(encoder->count - encoder->code);
    encoder->code = encoder->count;
    encoder->count++;
}

static void put(struct encoder *encoder, uint8_t byte)
{
    if (encoder->count - encoder->code == UINT8_MAX) {
        close_block(encoder);
    }
    if (byte == 0) {
        close_block(encoder);
    } else {
        encoder->out[encoder->count] = byte;
        encoder->count++;
    }
}

size_t dv_frame_write(uint8_t type, uint8_t sequence, const uint8_t *payload, size_t size,
                      uint8_t *out, size_t room)
{
    if (size > DV_PAYLOAD_MAX || room < DV_FRAME_ROOM(size)) {
        return 0;
    }
    uint8_t head[2] = {type, sequence};
    uint32_t crc = ~crc_of(crc_of(UINT32_MAX, head, sizeof head), payload, size);
    struct encoder encoder = {out, 0, 1};
    put(&encoder, type);
    put(&encoder, sequence);
    for (size_t i = 0; i < size; i++) {
        put(&encoder, payload[i]);
    }
    for (unsigned shift = 0; shift < 32; shift += 8) {
        put(&encoder, (uint8_t)(crc >> shift));
    }
    close_block(&encoder); /* its next code byte is the zero */
    out[encoder.code] = 0;
    return encoder.count;
}
