#include "checks.h"

#include "joint_cubic.h"
#include "kinematics.h"
#include "to_float.h"

#include <math.h>

static const float RELATIVE_SLACK = 1e-3f;
static const float P_STEP = 1.0f / 1024.0f; /* microsteps: the unit of a knot's position */
static const float V_STEP = 1000.0f / 65536.0f; /* microsteps/s: the unit of its velocity */
static const float TIP_SLACK = 0.1f; /* mm */
#define JOINT_SLACK 1024 /* 2^-10 microsteps: one microstep */

/* What single precision can add, with room to spare: tests/firmware/test_checks_c.py. */
static const float RELATIVE_ERROR = 2e-6f; /* of speeds and accelerations */
static const float POSITION_ERROR = 1.0f / 16.0f; /* microsteps */
static const float TIP_ERROR = 0.01f; /* mm */

static const struct dv_objection NONE = {0, -1};

/* The motion to be judged; positions are in microsteps from its start. */
struct motion {
    const struct dv_parameters *parameters;
    const int32_t *start, *end; /* 2^-10 microsteps */
    struct dv_joint_cubic cubic[DV_JOINTS_MAX];
    float brake_end[DV_JOINTS_MAX];
};

static struct dv_objection objection(enum dv_refusal reason, int joint)
{
    return (struct dv_objection){(uint8_t)reason, (int8_t)joint};
}

static bool within(float value, float limit, float slack)
{
    return value <= (limit * (1.0f + RELATIVE_SLACK) + slack) * (1.0f + RELATIVE_ERROR);
}

static struct dv_objection speed_objection(const struct motion *motion, bool homed)
{
    const struct dv_parameters *parameters = motion->parameters;
    const float *top = homed ? parameters->velocity : parameters->unhomed_velocity;
    for (int joint = 0; joint < parameters->configure.joints; joint++) {
        const struct dv_joint_cubic *cubic = &motion->cubic[joint];
        float h = cubic->seconds;
        if (!within(dv_joint_cubic_top_acceleration(cubic), parameters->acceleration[joint],
                    6.0f * P_STEP / (h * h) + 3.0f * V_STEP / h)) {
            return objection(DV_REFUSAL_ACCELERATION, joint);
        }
        if (!within(dv_joint_cubic_top_speed(cubic), top[joint], 1.5f * P_STEP / h + V_STEP)) {
            return objection(homed ? DV_REFUSAL_VELOCITY : DV_REFUSAL_UNHOMED_SPEED, joint);
        }
    }
    return NONE;
}

static void find_brake_ends(struct motion *motion)
{
    int joints = motion->parameters->configure.joints;
    float time = 0.0f;
    for (int joint = 0; joint < joints; joint++) {
        float speed = fabsf(motion->cubic[joint].v1);
        time = fmaxf(time, speed / motion->parameters->acceleration[joint]);
    }
    for (int joint = 0; joint < joints; joint++) {
        const struct dv_joint_cubic *cubic = &motion->cubic[joint];
        motion->brake_end[joint] = cubic->distance + cubic->v1 * time / 2.0f;
    }
}

/* Knots are judged as integers, so that no number of segments can creep beyond a limit. */
static struct dv_objection joint_objection(const struct motion *motion)
{
    const struct dv_configure *configure = &motion->parameters->configure;
    for (int joint = 0; joint < configure->joints; joint++) {
        int64_t start = motion->start[joint], end = motion->end[joint];
        int64_t least = (int64_t)configure->joint_min[joint] - JOINT_SLACK;
        int64_t most = (int64_t)configure->joint_max[joint] + JOINT_SLACK;
        least = least < start ? least : start;
        most = most > start ? most : start;
        float low = dv_to_float(least - start) * P_STEP - POSITION_ERROR;
        float high = dv_to_float(most - start) * P_STEP + POSITION_ERROR;
        if (end < least || end > most
            || !dv_joint_cubic_stays_within(&motion->cubic[joint], low, high)) {
            return objection(DV_REFUSAL_JOINT_LIMIT, joint);
        }
        if (!(low <= motion->brake_end[joint] && motion->brake_end[joint] <= high)) {
            return objection(DV_REFUSAL_BRAKE, joint);
        }
    }
    return NONE;
}

static float beyond(const float range[2], float value)
{
    return fmaxf(range[0] - value, value - range[1]);
}

/* How far the tool tip is outside its workspace (mm); infinite where there is no tip. */
static float outside(const struct motion *motion, const float from_start[DV_ARMS])
{
    const struct dv_configure *configure = &motion->parameters->configure;
    float theta[DV_ARMS], tip[3];
    for (int i = 0; i < DV_ARMS; i++) {
        float microsteps = (float)motion->start[i] * P_STEP + from_start[i];
        theta[i] = microsteps / configure->microsteps_per_rad[i];
    }
    if (!dv_forward(motion->parameters, theta, tip)) {
        return INFINITY;
    }
    float radius = sqrtf(tip[0] * tip[0] + tip[1] * tip[1]) - configure->workspace_radius;
    float box = fmaxf(beyond(configure->workspace_x, tip[0]), beyond(configure->workspace_y, tip[1]));
    return fmaxf(fmaxf(box, radius), fmaxf(beyond(configure->workspace_z, tip[2]), 0.0f));
}

static struct dv_objection workspace_objection(const struct motion *motion)
{
    if (motion->parameters->arms == 0) {
        return NONE;
    }
    static const float START[DV_ARMS] = {0.0f};
    float middle[DV_ARMS], end[DV_ARMS], halfway[DV_ARMS];
    for (int i = 0; i < DV_ARMS; i++) {
        middle[i] = dv_joint_cubic_position(&motion->cubic[i], 0.5f);
        end[i] = motion->cubic[i].distance;
        halfway[i] = end[i] + (motion->brake_end[i] - end[i]) * 0.75f; /* of the brake's time */
    }
    const float *const poses[] = {middle, end, halfway, motion->brake_end};
    float allowed = -1.0f; /* not known yet */
    for (int i = 0; i < 4; i++) {
        float far = outside(motion, poses[i]);
        if (far <= TIP_SLACK + TIP_ERROR) {
            continue;
        }
        allowed = allowed < 0.0f ? outside(motion, START) : allowed;
        if (far > allowed + TIP_SLACK + TIP_ERROR) {
            return objection(i < 2 ? DV_REFUSAL_WORKSPACE : DV_REFUSAL_BRAKE, -1);
        }
    }
    return NONE;
}

struct dv_objection dv_check_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                     const int32_t *p0, const int32_t *v0,
                                     const struct dv_segment *segment, bool homed)
{
    struct motion motion = {.parameters = parameters, .start = p0, .end = segment->p};
    for (int joint = 0; joint < parameters->configure.joints; joint++) {
        motion.cubic[joint] = dv_joint_cubic(p0[joint], segment->p[joint], v0[joint],
                                             segment->v[joint], segment->duration, tick_hz);
    }
    struct dv_objection found = speed_objection(&motion, homed);
    if (found.reason != 0 || !homed) {
        return found;
    }
    find_brake_ends(&motion);
    found = joint_objection(&motion);
    return found.reason != 0 ? found : workspace_objection(&motion);
}
