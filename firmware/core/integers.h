/* Ticks that wrap, and divisions that round down, as in the simulated board. */
#ifndef DV_INTEGERS_H
#define DV_INTEGERS_H

#include <stdint.h>

_Static_assert(-3 >> 1 == -2, "a shift to the right has to round down");

/* Ticks from `origin` to `tick`, less than 2^31 either way. */
static inline int32_t dv_since(uint32_t tick, uint32_t origin)
{
    return (int32_t)(tick - origin);
}

/* The same for epochs and indices. */
static inline int16_t dv_since16(uint16_t number, uint16_t origin)
{
    return (int16_t)(uint16_t)(number - origin);
}

/* `divisor` is positive. */
static inline int64_t dv_floor_divide(int64_t value, int64_t divisor)
{
    int64_t quotient = value / divisor;
    return quotient * divisor > value ? quotient - 1 : quotient;
}

static inline int64_t dv_size_of(int64_t value)
{
    return value < 0 ? -value : value;
}

static inline int64_t dv_larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* The whole microsteps of a position in Q32; halves go up. */
static inline int32_t dv_nearest(int64_t position)
{
    return (int32_t)((position + ((int64_t)1 << 31)) >> 32);
}

/* Whole microsteps in Q32. */
static inline int64_t dv_whole(int32_t microsteps)
{
    return (int64_t)microsteps * ((int64_t)1 << 32);
}

#endif
