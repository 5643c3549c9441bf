/* One joint's motion between two knots as a cubic, from its start: in microsteps and seconds.
 *
 * What it begins with are integers, and differences are taken of integers; each number below is
 * then within 1e-6 of its size of the truth.
 */
#ifndef DV_JOINT_CUBIC_H
#define DV_JOINT_CUBIC_H

#include <stdbool.h>
#include <stdint.h>

struct dv_joint_cubic {
    float distance; /* microsteps */
    float v0, v1; /* microsteps/s, at both ends */
    float a0, a1; /* microsteps/s²; between the ends it changes evenly */
    float seconds;
};

/* Positions in 2^-10 microsteps, velocities in 2^-16 microsteps/ms; at most 50 ms and
 * DV_TICK_HZ_MAX.
 */
struct dv_joint_cubic dv_joint_cubic(int32_t p0, int32_t p1, int32_t v0, int32_t v1,
                                     uint32_t ticks, uint32_t tick_hz);

float dv_joint_cubic_top_acceleration(const struct dv_joint_cubic *cubic);
float dv_joint_cubic_top_speed(const struct dv_joint_cubic *cubic);

/* Where it is after the part `u` (0 to 1) of its time, in microsteps from its start. */
float dv_joint_cubic_position(const struct dv_joint_cubic *cubic, float u);

/* Whether it stays between two positions, in microsteps from its start. */
bool dv_joint_cubic_stays_within(const struct dv_joint_cubic *cubic, float low, float high);

#endif
