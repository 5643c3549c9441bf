#include "checks.h"

#include "real_cubic.h"

#include <math.h>

static const float P_STEP = 1.0f / 1024.0f; /* microsteps: the unit of a knot's position */
static const float V_STEP = 1000.0f / 65536.0f; /* microsteps/s: the unit of its velocity */

/* What single precision can add to speeds and accelerations, with room to spare:
 * tests/firmware/test_checks_c.py.
 */
static const float RELATIVE_ERROR = 2e-6f;

/* The motion to be judged; positions are in microsteps from its start. */
struct motion {
    const struct dv_parameters *parameters;
    const struct dv_knot *start, *end;
    struct dv_real_cubic cubic[DV_JOINTS_MAX];
    float brake_end[DV_JOINTS_MAX];
};

static bool within(float value, float limit, float slack)
{
    return value <= (limit * (1.0f + DV_RELATIVE_SLACK) + slack) * (1.0f + RELATIVE_ERROR);
}

static struct dv_objection speed_objection(const struct motion *motion, bool homed)
{
    const struct dv_parameters *parameters = motion->parameters;
    const float *top = homed ? parameters->velocity : parameters->unhomed_velocity;
    for (int joint = 0; joint < parameters->configure.joints; joint++) {
        const struct dv_real_cubic *cubic = &motion->cubic[joint];
        float h = cubic->seconds;
        if (!within(dv_real_cubic_top_acceleration(cubic), parameters->acceleration[joint],
                    6.0f * P_STEP / (h * h) + 3.0f * V_STEP / h)) {
            return dv_object(DV_REFUSAL_ACCELERATION, joint);
        }
        if (!within(dv_real_cubic_top_speed(cubic), top[joint], 1.5f * P_STEP / h + V_STEP)) {
            return dv_object(homed ? DV_REFUSAL_VELOCITY : DV_REFUSAL_UNHOMED_SPEED, joint);
        }
    }
    return dv_no_objection();
}

static void find_brake_ends(struct motion *motion)
{
    int joints = motion->parameters->configure.joints;
    float end[DV_JOINTS_MAX], speed[DV_JOINTS_MAX];
    for (int joint = 0; joint < joints; joint++) {
        end[joint] = motion->cubic[joint].distance;
        speed[joint] = motion->cubic[joint].v1;
    }
    dv_brake_ends(motion->parameters, joints, end, speed, motion->brake_end);
}

/* Knots are judged as integers, so that no number of segments can creep beyond a limit. */
static struct dv_objection joint_objection(const struct motion *motion)
{
    for (int joint = 0; joint < motion->parameters->configure.joints; joint++) {
        int32_t end = motion->end->p[joint];
        struct dv_range range =
            dv_joint_range(motion->parameters, joint, motion->start->p[joint]);
        if (end < range.least || end > range.most
            || !dv_real_cubic_stays_within(&motion->cubic[joint], range.low, range.high)) {
            return dv_object(DV_REFUSAL_JOINT_LIMIT, joint);
        }
        if (!(range.low <= motion->brake_end[joint] && motion->brake_end[joint] <= range.high)) {
            return dv_object(DV_REFUSAL_BRAKE, joint);
        }
    }
    return dv_no_objection();
}

static float outside_at(const struct motion *motion, const float from_start[DV_ARMS_MAX])
{
    float microsteps[DV_ARMS_MAX];
    for (int i = 0; i < motion->parameters->arms; i++) {
        microsteps[i] = (float)motion->start->p[i] * P_STEP + from_start[i];
    }
    return dv_arms_outside(motion->parameters, microsteps);
}

static struct dv_objection workspace_objection(const struct motion *motion, float allowed)
{
    if (motion->parameters->arms == 0) {
        return dv_no_objection();
    }
    float middle[DV_ARMS_MAX], end[DV_ARMS_MAX], halfway[DV_ARMS_MAX];
    for (int i = 0; i < motion->parameters->arms; i++) {
        middle[i] = dv_real_cubic_position(&motion->cubic[i], 0.5f);
        end[i] = motion->cubic[i].distance;
        halfway[i] = end[i] + (motion->brake_end[i] - end[i]) * 0.75f; /* of the brake's time */
    }
    const float *const poses[] = {middle, end, halfway, motion->brake_end};
    for (int i = 0; i < 4; i++) {
        if (outside_at(motion, poses[i]) > allowed + DV_TIP_SLACK + DV_TIP_ERROR) {
            return dv_object(i < 2 ? DV_REFUSAL_WORKSPACE : DV_REFUSAL_BRAKE, -1);
        }
    }
    return dv_no_objection();
}

struct dv_objection dv_check_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                     const struct dv_knot *start, const struct dv_knot *end,
                                     uint32_t ticks, bool homed, float outside)
{
    struct motion motion = {.parameters = parameters, .start = start, .end = end};
    for (int i = 0; i < parameters->configure.joints; i++) {
        motion.cubic[i] =
            dv_joint_cubic(start->p[i], end->p[i], start->v[i], end->v[i], ticks, tick_hz);
    }
    struct dv_objection found = speed_objection(&motion, homed);
    if (found.reason != 0 || !homed) {
        return found;
    }
    find_brake_ends(&motion);
    found = joint_objection(&motion);
    return found.reason != 0 ? found : workspace_objection(&motion, outside);
}
