/* Between 64-bit integers and floats. The compiler's own way to do this for a processor with a single
 * precision unit is a library call that brings soft floats with it.
 */
#ifndef DV_FLOATS_H
#define DV_FLOATS_H

#include <math.h>
#include <stdint.h>

/* The nearest float, or its neighbour. */
static inline float dv_to_float(int64_t value)
{
    uint64_t size = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    float near = (float)(uint32_t)(size >> 32) * 4294967296.0f + (float)(uint32_t)size;
    return value < 0 ? -near : near;
}

/* `value` is kept within `most` (less than 2^31) either way; what is no number is 0. */
static inline int32_t dv_to_integer(float value, float most)
{
    if (!(fabsf(value) < most)) {
        return value > 0.0f ? (int32_t)most : value < 0.0f ? -(int32_t)most : 0;
    }
    return (int32_t)value;
}

/* A whole number and its fraction, in 2^-32; `value` as above, kept within 2^30. */
static inline int64_t dv_to_q32(float value)
{
    int32_t whole = dv_to_integer(floorf(value), 1073741824.0f);
    float fraction = value - (float)whole;
    uint32_t rest = fraction >= 0.0f && fraction < 1.0f ? (uint32_t)(fraction * 4294967296.0f) : 0;
    return (int64_t)whole * 4294967296 + rest;
}

#endif
