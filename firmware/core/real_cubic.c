#include "real_cubic.h"

#include "floats.h"

#include <math.h>

/* Units of a knot: `length` is that of its velocity times a ms, 2^16 of them (in microsteps or mm),
 * and `fraction` of the velocity's units make one of the position's.
 */
struct units {
    float length;
    int32_t fraction;
};

static const struct units JOINT = {1.0f, 64};    /* 2^-10 and 2^-16 microsteps */
static const struct units TIP = {1.0e-3f, 256}; /* 2^-8 and 2^-16 um */

static struct dv_real_cubic cubic_of(const struct units *units, int32_t p0, int32_t p1, int32_t v0,
                                     int32_t v1, uint32_t ticks, uint32_t tick_hz)
{
    int64_t distance = ((int64_t)p1 - p0) * units->fraction;
    float seconds = (float)ticks / (float)tick_hz;
    float step = units->length / 65536.0f;
    /* Accelerations are differences that nearly vanish where the motion is even, so they are taken
     * exactly, times seconds² and in 2^-16 lengths / tick_hz:
     * a0 = 6 d / h² - (4 v0 + 2 v1) / h, a1 = (2 v0 + 4 v1) / h - 6 d / h².
     */
    float unit = step / ((float)tick_hz * seconds * seconds);
    int64_t mean = 6 * distance * (int64_t)tick_hz;
    int64_t time = 1000 * (int64_t)ticks;
    return (struct dv_real_cubic){
        .distance = dv_to_float(distance) * step,
        .v0 = (float)v0 * (1000.0f * step),
        .v1 = (float)v1 * (1000.0f * step),
        .a0 = dv_to_float(mean - (4 * (int64_t)v0 + 2 * (int64_t)v1) * time) * unit,
        .a1 = dv_to_float((2 * (int64_t)v0 + 4 * (int64_t)v1) * time - mean) * unit,
        .seconds = seconds,
    };
}

struct dv_real_cubic dv_joint_cubic(int32_t p0, int32_t p1, int32_t v0, int32_t v1,
                                    uint32_t ticks, uint32_t tick_hz)
{
    return cubic_of(&JOINT, p0, p1, v0, v1, ticks, tick_hz);
}

struct dv_real_cubic dv_tip_cubic(int32_t p0, int32_t p1, int32_t v0, int32_t v1, uint32_t ticks,
                                  uint32_t tick_hz)
{
    return cubic_of(&TIP, p0, p1, v0, v1, ticks, tick_hz);
}

float dv_real_cubic_top_acceleration(const struct dv_real_cubic *cubic)
{
    return fmaxf(fabsf(cubic->a0), fabsf(cubic->a1));
}

float dv_real_cubic_top_speed(const struct dv_real_cubic *cubic)
{
    float a0 = cubic->a0, a1 = cubic->a1;
    float top = fmaxf(fabsf(cubic->v0), fabsf(cubic->v1));
    if ((a0 < 0.0f && a1 > 0.0f) || (a0 > 0.0f && a1 < 0.0f)) {
        float share = a0 / (a0 - a1); /* of the time, until the acceleration vanishes */
        top = fmaxf(top, fabsf(cubic->v0 + a0 * cubic->seconds * share / 2.0f));
    }
    return top;
}

float dv_real_cubic_position(const struct dv_real_cubic *cubic, float u)
{
    float rest = 1.0f - u;
    float by_velocity = rest * cubic->v0 - u * cubic->v1;
    return cubic->distance * u * u * (3.0f - 2.0f * u) + cubic->seconds * u * rest * by_velocity;
}

float dv_real_cubic_velocity(const struct dv_real_cubic *cubic, float u)
{
    float t = cubic->seconds * u;
    return cubic->v0 + t * (cubic->a0 + (cubic->a1 - cubic->a0) * u / 2.0f);
}

float dv_real_cubic_acceleration(const struct dv_real_cubic *cubic, float u)
{
    return cubic->a0 + (cubic->a1 - cubic->a0) * u;
}

static bool between(float low, float value, float high)
{
    return low <= value && value <= high;
}

bool dv_real_cubic_stays_within(const struct dv_real_cubic *cubic, float low, float high)
{
    if (!between(low, 0.0f, high) || !between(low, cubic->distance, high)) {
        return false;
    }
    float third = cubic->seconds / 3.0f;
    if (between(low, cubic->v0 * third, high)
        && between(low, cubic->distance - cubic->v1 * third, high)) {
        return true; /* so does its hull */
    }
    /* It turns where v0 + a0 h u + c u² = 0. The two roots without cancellation; either divisor
     * may vanish.
     */
    float change = cubic->a0 * cubic->seconds;
    float curve = (cubic->a1 - cubic->a0) * cubic->seconds / 2.0f;
    float inside = change * change - 4.0f * curve * cubic->v0;
    if (inside < 0.0f) {
        return true;
    }
    float q = -(change + copysignf(sqrtf(inside), change)) / 2.0f;
    const float roots[2] = {q / curve, cubic->v0 / q};
    for (int i = 0; i < 2; i++) {
        if (roots[i] > 0.0f && roots[i] < 1.0f /* neither for infinity nor for no number */
            && !between(low, dv_real_cubic_position(cubic, roots[i]), high)) {
            return false;
        }
    }
    return true;
}
