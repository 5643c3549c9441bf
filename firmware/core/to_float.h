/* A 64-bit integer as the nearest float, or its neighbour. The compiler's own way to do this for a
 * processor with a single precision unit is a library call that brings soft floats with it.
 */
#ifndef DV_TO_FLOAT_H
#define DV_TO_FLOAT_H

#include <stdint.h>

static inline float dv_to_float(int64_t value)
{
    uint64_t size = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    float near = (float)(uint32_t)(size >> 32) * 4294967296.0f + (float)(uint32_t)size;
    return value < 0 ? -near : near;
}

#endif
