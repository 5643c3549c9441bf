/* The motion of one coordinate between two knots as a cubic, from its start, in single precision.
 *
 * What it begins with are integers, and differences are taken of integers; each number below is
 * then within 1e-6 of its size of the truth. What runs in the joints is the same in integers: paths.
 */
#ifndef DV_REAL_CUBIC_H
#define DV_REAL_CUBIC_H

#include <stdbool.h>
#include <stdint.h>

/* Lengths are microsteps of a joint, or mm of the tip. */
struct dv_real_cubic {
    float distance;
    float v0, v1; /* 1/s, at both ends */
    float a0, a1; /* 1/s²; between the ends it changes evenly */
    float seconds;
};

/* Positions in 2^-10 microsteps, velocities in 2^-16 microsteps/ms; at most 50 ms and
 * DV_TICK_HZ_MAX.
 */
struct dv_real_cubic dv_joint_cubic(int32_t p0, int32_t p1, int32_t v0, int32_t v1,
                                    uint32_t ticks, uint32_t tick_hz);

/* Positions in 2^-8 um, velocities in 2^-16 um/ms. */
struct dv_real_cubic dv_tip_cubic(int32_t p0, int32_t p1, int32_t v0, int32_t v1, uint32_t ticks,
                                  uint32_t tick_hz);

float dv_real_cubic_top_acceleration(const struct dv_real_cubic *cubic);
float dv_real_cubic_top_speed(const struct dv_real_cubic *cubic);

/* After the part `u` (0 to 1) of its time; the position is from its start. */
float dv_real_cubic_position(const struct dv_real_cubic *cubic, float u);
float dv_real_cubic_velocity(const struct dv_real_cubic *cubic, float u);
float dv_real_cubic_acceleration(const struct dv_real_cubic *cubic, float u);

/* Whether it stays between two positions, from its start. */
bool dv_real_cubic_stays_within(const struct dv_real_cubic *cubic, float low, float high);

#endif
