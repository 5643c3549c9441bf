#include "parameters.h"

#include "kinematics.h"
#include "rules.h"

#include <math.h>

#define TO_Q32 8 /* from 2^-24 */
#define LEAST_ACCELERATION 256 /* 2^-24 microsteps/ms²: 2^16 in those of the brake */
#define TWO_TICKS_A_STEP 2004u /* in 1/1000 ticks, with room for the slack of speeds */
#define BRAKE_MS_MAX 1000 /* so that the brake's arithmetic fits 64 bits */
#define HOMING_MICROSTEPS_MAX (1 << 20)
#define HOMING_MS_MAX 600000

static const float PER_SECOND = 1000.0f / 65536.0f; /* microsteps/s in 2^-16 microsteps/ms */
static const float PER_SECOND2 = 1e6f / 16777216.0f; /* microsteps/s² in 2^-24 microsteps/ms² */

static bool finite_numbers(const float *values, int count)
{
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            return false;
        }
    }
    return true;
}

static bool joint_makes_sense(const struct dv_configure *c, int joint)
{
    int64_t ready = (int64_t)c->ready[joint] * 1024;
    float per_rad = c->microsteps_per_rad[joint];
    return c->joint_min[joint] < c->joint_max[joint] && c->joint_min[joint] <= ready
        && ready <= c->joint_max[joint] && per_rad > 0.0f && isfinite(per_rad);
}

static bool speeds_make_sense(const struct dv_configure *c, int joint, uint32_t tick_hz)
{
    uint64_t velocity = c->velocity[joint], acceleration = c->acceleration[joint];
    return velocity > 0 && c->unhomed_velocity[joint] > 0
        && velocity * TWO_TICKS_A_STEP <= (uint64_t)tick_hz << 16
        && acceleration >= LEAST_ACCELERATION && velocity << 8 <= acceleration * BRAKE_MS_MAX;
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t size_of(int64_t value)
{
    return value < 0 ? -value : value;
}

/* What is bounded here keeps positions and times of homing inside their integers. */
static bool homing_makes_sense(const struct dv_configure *c, int joint)
{
    uint32_t fast = c->homing_fast[joint], slow = c->homing_slow[joint];
    uint32_t backoff = c->homing_backoff[joint], travel = c->homing_max_travel[joint];
    int64_t zero = c->homing_switch[joint];
    int64_t furthest = larger(larger(backoff, travel), size_of(zero));
    int64_t way = larger(furthest, size_of(c->ready[joint] - zero));
    return 0 < fast && fast <= c->velocity[joint] && 0 < slow && slow <= c->velocity[joint]
        && backoff > 0 && travel > 0 && furthest <= HOMING_MICROSTEPS_MAX
        && way << 16 <= (int64_t)(fast < slow ? fast : slow) * HOMING_MS_MAX;
}

static bool range_makes_sense(const float range[2])
{
    return range[0] < range[1]; /* either may be infinite, neither may be no number */
}

static int arms_of(const struct dv_configure *c)
{
    switch (c->kind) {
    case DV_KIND_ROTARY_DELTA:
        return 3;
    case DV_KIND_FIVE_BAR:
        return 2;
    default:
        return 0;
    }
}

static bool geometry_makes_sense(const struct dv_configure *c)
{
    int arms = arms_of(c);
    bool turns_tool = c->kind == DV_KIND_ROTARY_DELTA && c->joints == arms + 1;
    if (c->kind != DV_KIND_JOINTS_ONLY && c->joints != arms && !turns_tool) {
        return false;
    }
    for (int i = 0; i < arms; i++) {
        if (!(c->upper_arm[i] > 0.0f && c->forearm[i] > 0.0f)) {
            return false;
        }
    }
    return finite_numbers(c->base_radius, arms) && finite_numbers(c->effector_radius, arms)
        && finite_numbers(c->upper_arm, arms) && finite_numbers(c->forearm, arms)
        && finite_numbers(c->azimuth, arms);
}

static bool makes_sense(const struct dv_configure *c, uint32_t tick_hz)
{
    if (tick_hz < DV_TICK_HZ_MIN || tick_hz > DV_TICK_HZ_MAX || tick_hz % 1000 != 0 || c->joints < 1
        || c->joints > DV_JOINTS_MAX || (c->homing_direction != 1 && c->homing_direction != -1)) {
        return false;
    }
    for (int joint = 0; joint < c->joints; joint++) {
        if (!joint_makes_sense(c, joint) || !speeds_make_sense(c, joint, tick_hz)
            || !homing_makes_sense(c, joint)) {
            return false;
        }
    }
    return finite_numbers(c->tool_offset, 3) && range_makes_sense(c->workspace_x)
        && range_makes_sense(c->workspace_y) && range_makes_sense(c->workspace_z)
        && c->workspace_radius > 0.0f && geometry_makes_sense(c);
}

static void take_limits(struct dv_parameters *parameters)
{
    const struct dv_configure *c = &parameters->configure;
    for (int joint = 0; joint < c->joints; joint++) {
        parameters->accelerations[joint] = (int64_t)c->acceleration[joint] << TO_Q32;
        parameters->acceleration[joint] = (float)c->acceleration[joint] * PER_SECOND2;
        parameters->velocity[joint] = (float)c->velocity[joint] * PER_SECOND;
        parameters->unhomed_velocity[joint] =
            fminf((float)c->unhomed_velocity[joint] * PER_SECOND, parameters->velocity[joint]);
    }
}

/* The sine of the angle from one arm's azimuth to another's. */
static float turned(const struct dv_limb *one, const struct dv_limb *other)
{
    return one->cos_azimuth * other->sin_azimuth - one->sin_azimuth * other->cos_azimuth;
}

static void take_geometry(struct dv_parameters *parameters)
{
    const struct dv_configure *c = &parameters->configure;
    struct dv_limb *limb = parameters->limb;
    parameters->arms = (uint8_t)arms_of(c);
    for (int i = 0; i < parameters->arms; i++) {
        limb[i] = (struct dv_limb){
            .offset = c->base_radius[i] - c->effector_radius[i],
            .upper_arm = c->upper_arm[i],
            .forearm = c->forearm[i],
            .cos_azimuth = cosf(c->azimuth[i]),
            .sin_azimuth = sinf(c->azimuth[i]),
        };
    }
    if (c->kind == DV_KIND_FIVE_BAR) {
        limb[0].cos_azimuth = -1.0f; /* to the left */
        limb[1].cos_azimuth = 1.0f;
        limb[0].sin_azimuth = limb[1].sin_azimuth = 0.0f;
    } else {
        float around = turned(&limb[0], &limb[1]) + turned(&limb[1], &limb[2])
            + turned(&limb[2], &limb[0]);
        parameters->handedness = copysignf(1.0f, around);
    }
}

static bool ready_pose_has_a_tip(const struct dv_parameters *parameters)
{
    const struct dv_configure *c = &parameters->configure;
    float theta[DV_ARMS_MAX], tip[3];
    for (int i = 0; i < parameters->arms; i++) {
        theta[i] = (float)c->ready[i] / c->microsteps_per_rad[i];
    }
    return dv_forward(parameters, theta, tip);
}

bool dv_parameters_from(struct dv_parameters *parameters, const struct dv_configure *configure,
                        uint32_t tick_hz)
{
    *parameters = (struct dv_parameters){.configure = *configure, .handedness = 1.0f};
    if (!makes_sense(configure, tick_hz)) {
        return false;
    }
    take_limits(parameters);
    if (configure->kind == DV_KIND_JOINTS_ONLY) {
        return true;
    }
    take_geometry(parameters);
    return ready_pose_has_a_tip(parameters);
}
