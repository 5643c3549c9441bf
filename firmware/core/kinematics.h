/* The rotary delta in single precision, one pose at a time. Lengths in mm, angles in rad; the frame
 * has its origin in the plane of the motor axes, z up; an angle is 0 with the upper arm horizontal
 * and positive with it pointing down. Every arm has its own lengths.
 *
 * Nowhere that the host lets a robot go (its reserve from singularities is kept) is the tip more
 * than a millionth of forearm and upper arm together away from the truth: 0.5 um in 500 mm.
 */
#ifndef DV_KINEMATICS_H
#define DV_KINEMATICS_H

#include "parameters.h"

#include <stdbool.h>

/* The tool tip. False where the forearms cannot meet, where an arm has passed the edge of its
 * reach (elbow inside), and for parameters without a geometry.
 */
bool dv_forward(const struct dv_parameters *parameters, const float theta[DV_ARMS], float tip[3]);

/* The joint angles, elbows outside. False where an arm cannot reach, and for parameters without
 * a geometry.
 */
bool dv_inverse(const struct dv_parameters *parameters, const float tip[3], float theta[DV_ARMS]);

#endif
