#include "tip_checks.h"

#include "kinematics.h"
#include "tip.h"

#include <math.h>

static const float V_STEP = 1.0f / 65536.0f; /* mm/s: the unit of its velocity */
static const float ROOT_3 = 1.7320508f; /* of three coordinates that are each rounded */

/* What single precision can add to speeds and accelerations, with room to spare:
 * tests/firmware/test_tip_checks_c.py.
 */
static const float RELATIVE_ERROR = 1e-4f;

struct judgement {
    const struct dv_parameters *parameters;
    struct dv_tip_motion motion;
    float a_rounding, v_rounding; /* mm/s², mm/s: of the tip */
    float allowed;                /* mm outside the workspace */
    const int32_t *began;         /* 2^-10 microsteps: where the epoch did */
    struct dv_joint_motion last[DV_ARMS_MAX];
};

static float microsteps(const struct judgement *judgement, int joint, float angle)
{
    return angle * judgement->parameters->configure.microsteps_per_rad[joint];
}

static bool within(float value, float limit, float slack)
{
    return fabsf(value) <= limit * (1.0f + DV_RELATIVE_SLACK + RELATIVE_ERROR) + slack;
}

/* In its limits, or no further out than the epoch began; with a microstep of slack. */
static bool in_range(const struct judgement *judgement, int joint, float position)
{
    const struct dv_configure *configure = &judgement->parameters->configure;
    float began = (float)judgement->began[joint] / 1024.0f;
    float low = (float)configure->joint_min[joint] / 1024.0f - 1.0f;
    float high = (float)configure->joint_max[joint] / 1024.0f + 1.0f;
    return fminf(low, began - 1.0f) - DV_POSITION_ERROR <= position
        && position <= fmaxf(high, began + 1.0f) + DV_POSITION_ERROR;
}

static struct dv_objection joint_objection(const struct judgement *judgement)
{
    const struct dv_parameters *parameters = judgement->parameters;
    for (int joint = 0; joint < parameters->arms; joint++) {
        const struct dv_joint_motion *motion = &judgement->last[joint];
        if (!within(microsteps(judgement, joint, motion->acceleration),
                    parameters->acceleration[joint],
                    microsteps(judgement, joint, motion->gain) * judgement->a_rounding)) {
            return dv_object(DV_REFUSAL_ACCELERATION, joint);
        }
        if (!within(microsteps(judgement, joint, motion->rate), parameters->velocity[joint],
                    microsteps(judgement, joint, motion->gain) * judgement->v_rounding)) {
            return dv_object(DV_REFUSAL_VELOCITY, joint);
        }
        if (!in_range(judgement, joint, microsteps(judgement, joint, motion->angle))) {
            return dv_object(DV_REFUSAL_JOINT_LIMIT, joint);
        }
    }
    return dv_no_objection();
}

/* After the part `u` of the time. */
static struct dv_objection look(struct judgement *judgement, float u)
{
    float position[3], velocity[3], acceleration[3];
    dv_tip_state(&judgement->motion, u, position, velocity, acceleration);
    if (!dv_joint_motions(judgement->parameters, position, velocity, acceleration,
                          judgement->last)) {
        return dv_object(DV_REFUSAL_WORKSPACE, -1);
    }
    struct dv_objection found = joint_objection(judgement);
    if (found.reason == 0
        && dv_tip_outside(judgement->parameters, position) > judgement->allowed) {
        return dv_object(DV_REFUSAL_WORKSPACE, -1);
    }
    return found;
}

static struct dv_objection brake_objection(const struct judgement *judgement)
{
    const struct dv_parameters *parameters = judgement->parameters;
    float end[DV_ARMS_MAX], speed[DV_ARMS_MAX], brake[DV_ARMS_MAX], halfway[DV_ARMS_MAX];
    for (int i = 0; i < parameters->arms; i++) {
        end[i] = microsteps(judgement, i, judgement->last[i].angle);
        speed[i] = microsteps(judgement, i, judgement->last[i].rate);
    }
    dv_brake_ends(parameters, parameters->arms, end, speed, brake);
    for (int i = 0; i < parameters->arms; i++) {
        if (!in_range(judgement, i, brake[i])) {
            return dv_object(DV_REFUSAL_BRAKE, i);
        }
        halfway[i] = end[i] + (brake[i] - end[i]) * 0.75f; /* of the brake's time */
    }
    float far = fmaxf(dv_arms_outside(parameters, halfway), dv_arms_outside(parameters, brake));
    return far > judgement->allowed ? dv_object(DV_REFUSAL_BRAKE, -1) : dv_no_objection();
}

struct dv_objection dv_check_tip_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                         const struct dv_knot *start, const struct dv_knot *end,
                                         uint32_t ticks, const struct dv_leeway *leeway)
{
    float h = (float)ticks / (float)tick_hz;
    struct judgement judgement = {
        .parameters = parameters,
        .a_rounding = ROOT_3 * (6.0f * DV_TIP_STEP / (h * h) + 3.0f * V_STEP / h),
        .v_rounding = ROOT_3 * (1.5f * DV_TIP_STEP / h + V_STEP),
        .allowed = leeway->outside + DV_TIP_SLACK + DV_TIP_ERROR,
        .began = leeway->began,
    };
    uint32_t apart = DV_APART_MS * (tick_hz / 1000);
    uint32_t looks = (ticks + apart - 1) / apart;
    dv_tip_motion(&judgement.motion, start, end, ticks, tick_hz);
    for (uint32_t i = 0; i <= looks; i++) {
        struct dv_objection found = look(&judgement, (float)i / (float)looks);
        if (found.reason != 0) {
            return found;
        }
    }
    return brake_objection(&judgement);
}
