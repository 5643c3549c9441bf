/* Little-endian numbers out of bytes and into bytes, wherever they lie.
 *
 * A reader or writer that would pass the end stays where it is and is no longer good, so that one
 * look at the end is enough.
 */
#ifndef DV_BYTES_H
#define DV_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct dv_reader {
    const uint8_t *at;
    size_t left; /* bytes */
    bool good;
};

struct dv_writer {
    uint8_t *at;
    size_t left; /* bytes */
    bool good;
};

static inline uint32_t dv_read_bytes(struct dv_reader *reader, size_t count)
{
    if (reader->left < count) {
        reader->good = false;
        return 0;
    }
    uint32_t value = 0;
    for (size_t i = 0; i < count; i++) {
        value |= (uint32_t)reader->at[i] << (8 * i);
    }
    reader->at += count;
    reader->left -= count;
    return value;
}

static inline uint8_t dv_read_u8(struct dv_reader *reader)
{
    return (uint8_t)dv_read_bytes(reader, 1);
}

static inline uint16_t dv_read_u16(struct dv_reader *reader)
{
    return (uint16_t)dv_read_bytes(reader, 2);
}

static inline uint32_t dv_read_u32(struct dv_reader *reader)
{
    return dv_read_bytes(reader, 4);
}

static inline int8_t dv_read_i8(struct dv_reader *reader)
{
    return (int8_t)dv_read_u8(reader);
}

static inline int32_t dv_read_i32(struct dv_reader *reader)
{
    return (int32_t)dv_read_bytes(reader, 4);
}

static inline float dv_read_f32(struct dv_reader *reader)
{
    uint32_t bits = dv_read_bytes(reader, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* 0 or 1; anything else is malformed. */
static inline bool dv_read_bool(struct dv_reader *reader)
{
    uint8_t value = dv_read_u8(reader);
    reader->good = reader->good && value <= 1;
    return value == 1;
}

/* The highest value means "none", which is -1 here. */
static inline int16_t dv_read_optional_u8(struct dv_reader *reader)
{
    uint8_t value = dv_read_u8(reader);
    return value == UINT8_MAX ? -1 : value;
}

static inline int32_t dv_read_optional_u16(struct dv_reader *reader)
{
    uint16_t value = dv_read_u16(reader);
    return value == UINT16_MAX ? -1 : value;
}

/* How many entries the arrays have: at most `most`. */
static inline uint8_t dv_read_count(struct dv_reader *reader, uint8_t most)
{
    uint8_t count = dv_read_u8(reader);
    if (count > most) {
        reader->good = false;
        return 0;
    }
    return count;
}

/* A length and as many bytes of printable ASCII, into `size` bytes that end with a NUL. */
static inline void dv_read_text(struct dv_reader *reader, char *text, size_t size)
{
    uint8_t length = dv_read_u8(reader);
    text[0] = '\0';
    if (length >= size || length > reader->left) {
        reader->good = false;
        return;
    }
    for (size_t i = 0; i < length; i++) {
        text[i] = (char)dv_read_u8(reader);
        reader->good = reader->good && text[i] >= ' ' && text[i] <= '~';
    }
    text[length] = '\0';
}

/* Whether all was well and nothing is left. */
static inline bool dv_read_all(const struct dv_reader *reader)
{
    return reader->good && reader->left == 0;
}

static inline void dv_write_bytes(struct dv_writer *writer, uint32_t value, size_t count)
{
    if (writer->left < count) {
        writer->good = false;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        writer->at[i] = (uint8_t)(value >> (8 * i));
    }
    writer->at += count;
    writer->left -= count;
}

static inline void dv_write_u8(struct dv_writer *writer, uint8_t value)
{
    dv_write_bytes(writer, value, 1);
}

static inline void dv_write_u16(struct dv_writer *writer, uint16_t value)
{
    dv_write_bytes(writer, value, 2);
}

static inline void dv_write_u32(struct dv_writer *writer, uint32_t value)
{
    dv_write_bytes(writer, value, 4);
}

static inline void dv_write_i8(struct dv_writer *writer, int8_t value)
{
    dv_write_bytes(writer, (uint8_t)value, 1);
}

static inline void dv_write_i32(struct dv_writer *writer, int32_t value)
{
    dv_write_bytes(writer, (uint32_t)value, 4);
}

static inline void dv_write_f32(struct dv_writer *writer, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    dv_write_bytes(writer, bits, 4);
}

static inline void dv_write_bool(struct dv_writer *writer, bool value)
{
    dv_write_bytes(writer, value ? 1 : 0, 1);
}

static inline void dv_write_optional_u8(struct dv_writer *writer, int16_t value)
{
    writer->good = writer->good && value >= -1 && value < UINT8_MAX;
    dv_write_bytes(writer, (uint8_t)value, 1);
}

static inline void dv_write_optional_u16(struct dv_writer *writer, int32_t value)
{
    writer->good = writer->good && value >= -1 && value < UINT16_MAX;
    dv_write_bytes(writer, (uint16_t)value, 2);
}

/* A count above `most` spoils the writer; the entries to write are returned. */
static inline uint8_t dv_write_count(struct dv_writer *writer, uint8_t count, uint8_t most)
{
    writer->good = writer->good && count <= most;
    dv_write_u8(writer, count);
    return count <= most ? count : 0;
}

static inline void dv_write_text(struct dv_writer *writer, const char *text, size_t size)
{
    size_t length = 0;
    while (length < size && text[length] != '\0') {
        writer->good = writer->good && text[length] >= ' ' && text[length] <= '~';
        length++;
    }
    writer->good = writer->good && length < size;
    dv_write_u8(writer, (uint8_t)length);
    for (size_t i = 0; i < length; i++) {
        dv_write_u8(writer, (uint8_t)text[i]);
    }
}

#endif
