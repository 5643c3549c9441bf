/* Cartesian knots: the tip's motion between them, and what they are in joints.
 *
 * Their first three entries are the tip's (2^-8 um, 2^-16 um/ms); those behind are of the joints
 * beyond the arms, which stand still.
 */
#ifndef DV_TIP_H
#define DV_TIP_H

#include "parameters.h"
#include "paths.h"

#include <stdbool.h>
#include <stdint.h>

#define DV_TIP_STEP (1.0f / 256000.0f) /* mm: the unit of a Cartesian knot's position */

/* The Cartesian knot of a knot of the joints that rests. False: there is no tip. */
bool dv_tip_knot(const struct dv_parameters *parameters, const struct dv_knot *joints,
                 struct dv_knot *tip);

/* The knot of the joints of a Cartesian one that rests. False: out of reach. */
bool dv_joint_knot(const struct dv_parameters *parameters, const struct dv_knot *tip,
                   struct dv_knot *joints);

void dv_tip_motion(struct dv_tip_motion *motion, const struct dv_knot *start,
                   const struct dv_knot *end, uint32_t ticks, uint32_t tick_hz);

/* After the part `u` (0 to 1) of its time: mm, mm/s, mm/s². */
void dv_tip_position(const struct dv_tip_motion *motion, float u, float position[3]);
void dv_tip_state(const struct dv_tip_motion *motion, float u, float position[3],
                  float velocity[3], float acceleration[3]);

#endif
