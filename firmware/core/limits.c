#include "limits.h"

#include "floats.h"
#include "integers.h"
#include "kinematics.h"
#include "tip.h"

#include <math.h>
#include <string.h>

static const float P_STEP = 1.0f / 1024.0f; /* microsteps: the unit of a knot's position */

struct dv_range dv_joint_range(const struct dv_parameters *parameters, int joint, int32_t start)
{
    const struct dv_configure *configure = &parameters->configure;
    int64_t least = (int64_t)configure->joint_min[joint] - DV_JOINT_SLACK;
    int64_t most = (int64_t)configure->joint_max[joint] + DV_JOINT_SLACK;
    least = least < start ? least : start;
    most = dv_larger(most, start);
    return (struct dv_range){
        .least = least,
        .most = most,
        .low = dv_to_float(least - start) * P_STEP - DV_POSITION_ERROR,
        .high = dv_to_float(most - start) * P_STEP + DV_POSITION_ERROR,
    };
}

void dv_brake_ends(const struct dv_parameters *parameters, int joints, const float *positions,
                   const float *speeds, float *ends)
{
    float time = 0.0f;
    for (int i = 0; i < joints; i++) {
        time = fmaxf(time, fabsf(speeds[i]) / parameters->acceleration[i]);
    }
    for (int i = 0; i < joints; i++) {
        ends[i] = positions[i] + speeds[i] * time / 2.0f;
    }
}

static float beyond(const float range[2], float value)
{
    return fmaxf(range[0] - value, value - range[1]);
}

float dv_tip_outside(const struct dv_parameters *parameters, const float tip[3])
{
    const struct dv_configure *configure = &parameters->configure;
    float radius = sqrtf(tip[0] * tip[0] + tip[1] * tip[1]) - configure->workspace_radius;
    float level =
        fmaxf(beyond(configure->workspace_x, tip[0]), beyond(configure->workspace_y, tip[1]));
    return fmaxf(fmaxf(level, radius), fmaxf(beyond(configure->workspace_z, tip[2]), 0.0f));
}

float dv_arms_outside(const struct dv_parameters *parameters, const float *microsteps)
{
    float theta[DV_ARMS_MAX], tip[3];
    for (int i = 0; i < parameters->arms; i++) {
        theta[i] = microsteps[i] / parameters->configure.microsteps_per_rad[i];
    }
    return dv_forward(parameters, theta, tip) ? dv_tip_outside(parameters, tip) : INFINITY;
}

static float knot_outside(const struct dv_parameters *parameters, const struct dv_knot *knot)
{
    float place[DV_ARMS_MAX];
    for (int i = 0; i < DV_ARMS_MAX; i++) {
        place[i] = (float)knot->p[i] * (knot->cartesian ? DV_TIP_STEP : P_STEP);
    }
    return knot->cartesian ? dv_tip_outside(parameters, place) : dv_arms_outside(parameters, place);
}

struct dv_leeway dv_leeway_at(const struct dv_parameters *parameters, const struct dv_knot *knot,
                              bool homed)
{
    struct dv_leeway leeway = {.outside = 0.0f};
    memcpy(leeway.began, knot->p, sizeof leeway.began);
    if (homed && parameters->arms > 0) {
        leeway.outside = knot_outside(parameters, knot);
    }
    return leeway;
}

void dv_leeway_come_to(struct dv_leeway *leeway, const struct dv_parameters *parameters,
                       const struct dv_knot *knot)
{
    if (leeway->outside > 0.0f) {
        leeway->outside = fminf(leeway->outside, knot_outside(parameters, knot));
    }
}
