#include "tip.h"

#include "floats.h"
#include "kinematics.h"

#include <math.h>
#include <string.h>

static const float JOINT_STEPS = 1024.0f; /* to a microstep, of a joint knot's position */
static const float MOST = 2147483520.0f; /* the largest float that is an int32_t */

bool dv_tip_knot(const struct dv_parameters *parameters, const struct dv_knot *joints,
                 struct dv_knot *tip)
{
    float theta[DV_ARMS_MAX], point[3];
    int beyond = parameters->arms;
    for (int i = 0; i < parameters->arms; i++) {
        theta[i] = (float)joints->p[i] / JOINT_STEPS / parameters->configure.microsteps_per_rad[i];
    }
    if (!dv_forward(parameters, theta, point)) {
        return false;
    }
    *tip = (struct dv_knot){.cartesian = true};
    for (int i = 0; i < 3; i++) {
        tip->p[i] = dv_to_integer(rintf(point[i] / DV_TIP_STEP), MOST);
    }
    for (int i = 3; beyond < parameters->configure.joints; i++, beyond++) {
        tip->p[i] = joints->p[beyond];
    }
    return true;
}

bool dv_joint_knot(const struct dv_parameters *parameters, const struct dv_knot *tip,
                   struct dv_knot *joints)
{
    float theta[DV_ARMS_MAX], point[3];
    int beyond = parameters->arms;
    for (int i = 0; i < 3; i++) {
        point[i] = (float)tip->p[i] * DV_TIP_STEP;
    }
    if (!dv_inverse(parameters, point, theta)) {
        return false;
    }
    *joints = (struct dv_knot){.cartesian = false};
    for (int i = 0; i < parameters->arms; i++) {
        float microsteps = theta[i] * parameters->configure.microsteps_per_rad[i];
        joints->p[i] = dv_to_integer(rintf(microsteps * JOINT_STEPS), MOST);
    }
    for (int i = 3; beyond < parameters->configure.joints; i++, beyond++) {
        joints->p[beyond] = tip->p[i];
    }
    return true;
}

void dv_tip_motion(struct dv_tip_motion *motion, const struct dv_knot *start,
                   const struct dv_knot *end, uint32_t ticks, uint32_t tick_hz)
{
    for (int i = 0; i < 3; i++) {
        motion->start[i] = (float)start->p[i] * DV_TIP_STEP;
        motion->axis[i] =
            dv_tip_cubic(start->p[i], end->p[i], start->v[i], end->v[i], ticks, tick_hz);
    }
}

void dv_tip_position(const struct dv_tip_motion *motion, float u, float position[3])
{
    for (int i = 0; i < 3; i++) {
        position[i] = motion->start[i] + dv_real_cubic_position(&motion->axis[i], u);
    }
}

void dv_tip_state(const struct dv_tip_motion *motion, float u, float position[3],
                  float velocity[3], float acceleration[3])
{
    dv_tip_position(motion, u, position);
    for (int i = 0; i < 3; i++) {
        velocity[i] = dv_real_cubic_velocity(&motion->axis[i], u);
        acceleration[i] = dv_real_cubic_acceleration(&motion->axis[i], u);
    }
}
