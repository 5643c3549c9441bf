/* Arms in single precision, one pose at a time. Lengths in mm, angles in rad; the frame has its
 * origin in the plane of the motor axes, z up; an angle is 0 with the upper arm horizontal and
 * positive with it pointing down. Every arm has its own lengths. Arrays have an entry for each arm.
 *
 * Nowhere that the host lets a rotary delta go (its reserve from singularities is kept) is the tip
 * more than a millionth of forearm and upper arm together away from the truth: 0.5 um in 500 mm.
 */
#ifndef DV_KINEMATICS_H
#define DV_KINEMATICS_H

#include "parameters.h"

#include <stdbool.h>

/* Of one joint, while the tip moves. */
struct dv_joint_motion {
    float angle;        /* rad */
    float rate;         /* rad/s */
    float acceleration; /* rad/s² */
    float gain;         /* rad/mm: how far it turns for a mm of the tip along the forearm */
};

/* The tool tip. False where the forearms cannot meet, where an arm has passed the edge of its
 * reach (elbow inside), and for parameters without a geometry.
 */
bool dv_forward(const struct dv_parameters *parameters, const float *theta, float tip[3]);

/* The joint angles, elbows outside. False where an arm cannot reach, and for parameters without
 * a geometry.
 */
bool dv_inverse(const struct dv_parameters *parameters, const float tip[3], float *theta);

/* Of the arms' joints, for a tip with this velocity (mm/s) and acceleration (mm/s²). False where
 * an arm cannot reach, where the forearms meet in the wrong assembly, and without a geometry.
 */
bool dv_joint_motions(const struct dv_parameters *parameters, const float tip[3],
                      const float velocity[3], const float acceleration[3],
                      struct dv_joint_motion *motions);

#endif
