#include "paths.h"

#include "floats.h"
#include "integers.h"
#include "kinematics.h"
#include "tip.h"

#include <string.h>

static const float V_UNIT = 65.536f; /* 2^-16 microsteps/ms in a microstep/s */
static const float SPEED_MOST = 1073741824.0f;

#define ONE ((int64_t)1 << 30) /* of u */

static void begin(struct dv_path *path, enum dv_path_kind kind, uint8_t joints, uint32_t ticks,
                  uint32_t ticks_per_ms)
{
    memset(path, 0, sizeof *path);
    path->kind = (uint8_t)kind;
    path->joints = joints;
    path->rests = true;
    path->ticks = ticks;
    path->ticks_per_ms = ticks_per_ms;
}

void dv_path_cubic(struct dv_path *path, uint8_t joints, const struct dv_knot *start,
                   const struct dv_knot *end, uint32_t ticks, uint32_t ticks_per_ms)
{
    begin(path, DV_PATH_CUBIC, joints, ticks, ticks_per_ms);
    for (int i = 0; i < joints; i++) {
        path->by.cubic[i] = (struct dv_cubic){
            .p0 = start->p[i] * ((int64_t)1 << 22),
            .distance = (int64_t)end->p[i] - start->p[i],
            .m0 = dv_floor_divide(start->v[i] * (int64_t)ticks, ticks_per_ms),
            .m1 = dv_floor_divide(end->v[i] * (int64_t)ticks, ticks_per_ms),
            .v_end = end->v[i],
        };
        path->rests = path->rests && end->v[i] == 0;
    }
}

void dv_path_ramp(struct dv_path *path, uint8_t joints, const int64_t *start,
                  const int32_t *v_start, const int32_t *v_end, uint32_t ticks,
                  uint32_t ticks_per_ms)
{
    begin(path, DV_PATH_RAMP, joints, ticks, ticks_per_ms);
    for (int i = 0; i < joints; i++) {
        path->by.ramp[i] = (struct dv_ramp){start[i], v_start[i], v_end[i]};
        path->rests = path->rests && v_end[i] == 0;
    }
}

void dv_path_tip(struct dv_path *path, const struct dv_parameters *parameters,
                 const struct dv_knot *start, const struct dv_knot *end, uint32_t ticks,
                 uint32_t ticks_per_ms)
{
    struct dv_tip_path *tip = &path->by.tip;
    begin(path, DV_PATH_TIP, parameters->configure.joints, ticks, ticks_per_ms);
    tip->parameters = parameters;
    dv_tip_motion(&tip->motion, start, end, ticks, ticks_per_ms * 1000);
    for (int i = 0; i < 3; i++) {
        path->rests = path->rests && end->v[i] == 0;
    }
    for (int i = 3, beyond = parameters->arms; beyond < path->joints; i++, beyond++) {
        tip->held[beyond] = start->p[i] * ((int64_t)1 << 22);
    }
}

/* u, u² and u³, in Q30. */
struct powers {
    int64_t u, u2, u3;
};

static struct powers powers_at(const struct dv_path *path, uint32_t tick)
{
    int64_t u = (int64_t)(((uint64_t)tick << 30) / path->ticks);
    int64_t u2 = (u * u) >> 30;
    return (struct powers){u, u2, (u2 * u) >> 30};
}

static void cubic_positions(const struct dv_path *path, uint32_t tick, int64_t *positions)
{
    struct powers at = powers_at(path, tick);
    int64_t h = 3 * at.u2 - 2 * at.u3;
    int64_t g0 = at.u - 2 * at.u2 + at.u3;
    int64_t g1 = at.u3 - at.u2;
    for (int i = 0; i < path->joints; i++) {
        const struct dv_cubic *cubic = &path->by.cubic[i];
        positions[i] = cubic->p0 + ((cubic->distance * h) >> 8)
            + ((cubic->m0 * g0 + cubic->m1 * g1) >> 14);
    }
}

static void cubic_velocities(const struct dv_path *path, uint32_t tick, int32_t *velocities)
{
    struct powers at = powers_at(path, tick);
    int64_t h = 6 * (at.u - at.u2);
    int64_t g0 = ONE - 4 * at.u + 3 * at.u2;
    int64_t g1 = 3 * at.u2 - 2 * at.u;
    for (int i = 0; i < path->joints; i++) {
        const struct dv_cubic *cubic = &path->by.cubic[i];
        int64_t m = ((cubic->distance * h) >> 24) + ((cubic->m0 * g0 + cubic->m1 * g1) >> 30);
        velocities[i] = tick == path->ticks /* without the rounding of m */
            ? cubic->v_end
            : (int32_t)dv_floor_divide(m * path->ticks_per_ms, path->ticks);
    }
}

static void ramp_positions(const struct dv_path *path, uint32_t tick, int64_t *positions)
{
    int64_t span = 2 * (int64_t)path->ticks, t = tick;
    for (int i = 0; i < path->joints; i++) {
        const struct dv_ramp *ramp = &path->by.ramp[i];
        int64_t faster = (int64_t)ramp->v_end - ramp->v_start;
        int64_t way = dv_floor_divide(t * (ramp->v_start * span + faster * t), span);
        positions[i] = ramp->p0 + dv_floor_divide(way * 65536, path->ticks_per_ms);
    }
}

static void ramp_velocities(const struct dv_path *path, uint32_t tick, int32_t *velocities)
{
    for (int i = 0; i < path->joints; i++) {
        const struct dv_ramp *ramp = &path->by.ramp[i];
        int64_t faster = (int64_t)ramp->v_end - ramp->v_start;
        velocities[i] = ramp->v_start + (int32_t)dv_floor_divide(faster * tick, path->ticks);
    }
}

static bool tip_positions(const struct dv_path *path, uint32_t tick, int64_t *positions)
{
    const struct dv_tip_path *tip = &path->by.tip;
    float point[3], theta[DV_ARMS_MAX];
    dv_tip_position(&tip->motion, (float)tick / (float)path->ticks, point);
    if (!dv_inverse(tip->parameters, point, theta)) {
        return false;
    }
    memcpy(positions, tip->held, sizeof tip->held);
    for (int i = 0; i < tip->parameters->arms; i++) {
        positions[i] = dv_to_q32(theta[i] * tip->parameters->configure.microsteps_per_rad[i]);
    }
    return true;
}

static bool tip_velocities(const struct dv_path *path, uint32_t tick, int32_t *velocities)
{
    const struct dv_tip_path *tip = &path->by.tip;
    float point[3], velocity[3], acceleration[3];
    struct dv_joint_motion motions[DV_ARMS_MAX];
    dv_tip_state(&tip->motion, (float)tick / (float)path->ticks, point, velocity, acceleration);
    if (!dv_joint_motions(tip->parameters, point, velocity, acceleration, motions)) {
        return false;
    }
    for (int i = 0; i < path->joints; i++) {
        velocities[i] = 0;
    }
    for (int i = 0; i < tip->parameters->arms; i++) {
        float rate = motions[i].rate * tip->parameters->configure.microsteps_per_rad[i];
        velocities[i] = dv_to_integer(rate * V_UNIT, SPEED_MOST);
    }
    return true;
}

bool dv_path_positions(const struct dv_path *path, uint32_t tick, int64_t *positions)
{
    if (path->kind == DV_PATH_TIP) {
        return tip_positions(path, tick, positions);
    }
    if (path->kind == DV_PATH_CUBIC) {
        cubic_positions(path, tick, positions);
    } else {
        ramp_positions(path, tick, positions);
    }
    return true;
}

bool dv_path_velocities(const struct dv_path *path, uint32_t tick, int32_t *velocities)
{
    if (path->kind == DV_PATH_TIP) {
        return tip_velocities(path, tick, velocities);
    }
    if (path->kind == DV_PATH_CUBIC) {
        cubic_velocities(path, tick, velocities);
    } else {
        ramp_velocities(path, tick, velocities);
    }
    return true;
}
