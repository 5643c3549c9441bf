#include "homing.h"

#include "integers.h"

#include <string.h>

void dv_homing_begin(struct dv_homing *homing, const struct dv_parameters *parameters,
                     uint32_t ticks_per_ms)
{
    memset(homing, 0, sizeof *homing);
    homing->parameters = parameters;
    homing->ticks_per_ms = ticks_per_ms;
}

bool dv_homing_is_done(const struct dv_homing *homing)
{
    for (int i = 0; i < homing->parameters->configure.joints; i++) {
        if (homing->joint[i].phase != DV_HOMING_DONE) {
            return false;
        }
    }
    return true;
}

uint8_t dv_homing_fault(const struct dv_homing *homing)
{
    for (int i = 0; i < homing->parameters->configure.joints; i++) {
        if (homing->joint[i].fault != DV_FAULT_NONE) {
            return homing->joint[i].fault;
        }
    }
    return DV_FAULT_NONE;
}

/* One joint, with what its configuration says. */
struct approach {
    struct dv_joint_homing *joint;
    int32_t direction;
    int32_t fast, slow; /* towards the switch */
    int64_t backoff, max_travel; /* Q32 */
    int32_t most_change; /* of the velocity, in 1 ms */
    int64_t position;
    bool pressed;
};

static void enter(struct approach *approach, enum dv_homing_phase phase)
{
    approach->joint->phase = (uint8_t)phase;
    approach->joint->mark = approach->position;
    approach->joint->released = false;
}

static int32_t go_fast(struct approach *approach, int64_t travelled)
{
    if (approach->pressed) {
        enter(approach, DV_HOMING_BACK);
        return -approach->fast;
    }
    if (travelled > approach->max_travel) {
        approach->joint->fault = DV_FAULT_HOMING_NO_SWITCH;
    }
    return approach->fast;
}

static int32_t back_off(struct approach *approach, int64_t travelled)
{
    struct dv_joint_homing *joint = approach->joint;
    if (approach->pressed) {
        joint->released = false;
        if (-travelled > 2 * approach->backoff) {
            joint->fault = DV_FAULT_HOMING_SWITCH_STUCK;
        }
    } else if (!joint->released) {
        joint->released = true;
        joint->released_at = approach->position;
    } else if ((joint->released_at - approach->position) * approach->direction
               >= approach->backoff) {
        enter(approach, DV_HOMING_SLOW);
        return approach->slow;
    }
    return -approach->fast;
}

static int32_t go_slowly(struct approach *approach, int64_t travelled)
{
    if (approach->pressed) {
        approach->joint->trigger = approach->position;
        approach->joint->phase = DV_HOMING_STOP;
        return 0;
    }
    if (travelled > approach->max_travel) {
        approach->joint->fault = DV_FAULT_HOMING_NO_SWITCH;
    }
    return approach->slow;
}

/* The velocity to head for. */
static int32_t aim(struct approach *approach)
{
    struct dv_joint_homing *joint = approach->joint;
    int64_t travelled = (approach->position - joint->mark) * approach->direction;
    if (joint->phase == DV_HOMING_FAST) {
        return go_fast(approach, travelled);
    }
    if (joint->phase == DV_HOMING_BACK) {
        return back_off(approach, travelled);
    }
    int32_t velocity = 0;
    if (joint->phase == DV_HOMING_SLOW) {
        velocity = go_slowly(approach, travelled);
    }
    if (joint->phase == DV_HOMING_STOP && joint->velocity == 0) {
        joint->phase = DV_HOMING_DONE;
    }
    return velocity;
}

static void go_on(struct approach *approach)
{
    struct dv_joint_homing *joint = approach->joint;
    if (joint->phase == DV_HOMING_BEGIN) {
        enter(approach, approach->pressed ? DV_HOMING_BACK : DV_HOMING_FAST);
    }
    int32_t change = aim(approach) - joint->velocity;
    int32_t most = approach->most_change;
    change = change > most ? most : change;
    joint->velocity += change < -most ? -most : change;
}

static struct approach approach_of(struct dv_homing *homing, int i, int64_t position, bool pressed)
{
    const struct dv_configure *configure = &homing->parameters->configure;
    int32_t direction = configure->homing_direction;
    return (struct approach){
        .joint = &homing->joint[i],
        .direction = direction,
        .fast = (int32_t)configure->homing_fast[i] * direction,
        .slow = (int32_t)configure->homing_slow[i] * direction,
        .backoff = dv_whole((int32_t)configure->homing_backoff[i]),
        .max_travel = dv_whole((int32_t)configure->homing_max_travel[i]),
        .most_change = (int32_t)(homing->parameters->accelerations[i] >> 16),
        .position = position,
        .pressed = pressed,
    };
}

void dv_homing_next_path(struct dv_homing *homing, struct dv_path *path, const int64_t *positions,
                         uint32_t pressed, const int64_t *planned)
{
    const struct dv_configure *configure = &homing->parameters->configure;
    int32_t before[DV_JOINTS_MAX], after[DV_JOINTS_MAX];
    bool moves = true;
    for (int i = 0; i < configure->joints; i++) {
        before[i] = homing->joint[i].velocity;
        if (moves && homing->joint[i].phase != DV_HOMING_DONE) {
            struct approach approach =
                approach_of(homing, i, positions[i], (pressed >> i & 1) != 0);
            go_on(&approach);
            moves = (configure->options & DV_OPTION_HOMING_TOGETHER) != 0;
        }
        after[i] = homing->joint[i].velocity;
    }
    dv_path_ramp(path, configure->joints, planned, before, after, homing->ticks_per_ms,
                 homing->ticks_per_ms);
}

void dv_homing_refer(const struct dv_homing *homing, int64_t *positions)
{
    const struct dv_configure *configure = &homing->parameters->configure;
    for (int i = 0; i < configure->joints; i++) {
        int32_t beyond = dv_nearest(positions[i]) - dv_nearest(homing->joint[i].trigger);
        positions[i] = dv_whole(configure->homing_switch[i] + beyond);
    }
}

static int64_t root_of(int64_t square)
{
    int64_t root = 0;
    for (int64_t bit = (int64_t)1 << 31; bit > 0; bit >>= 1) {
        if ((root + bit) * (root + bit) <= square) {
            root += bit;
        }
    }
    return root;
}

/* From rest to rest the cubic's peaks are 3 d / (2 T) and 6 d / T². */
static uint32_t ms_to_ready(const struct dv_parameters *parameters, const int64_t *positions)
{
    int64_t ms = 4;
    for (int i = 0; i < parameters->configure.joints; i++) {
        int64_t distance =
            dv_size_of((int64_t)parameters->configure.ready[i] - dv_nearest(positions[i]));
        int64_t fast = parameters->configure.homing_fast[i];
        int64_t square = (6 * distance * ((int64_t)1 << 32)) / parameters->accelerations[i];
        ms = dv_larger(ms, (3 * distance * 65536) / (2 * fast) + 1);
        ms = dv_larger(ms, root_of(square) + 1);
    }
    return (uint32_t)ms;
}

void dv_homing_way_to_ready(const struct dv_homing *homing, struct dv_path *path,
                            const int64_t *positions)
{
    const struct dv_configure *configure = &homing->parameters->configure;
    struct dv_knot start = {.cartesian = false}, ready = {.cartesian = false};
    for (int i = 0; i < configure->joints; i++) {
        start.p[i] = dv_nearest(positions[i]) * 1024;
        ready.p[i] = configure->ready[i] * 1024;
    }
    uint32_t ms = ms_to_ready(homing->parameters, positions);
    dv_path_cubic(path, configure->joints, &start, &ready, ms * homing->ticks_per_ms,
                  homing->ticks_per_ms);
}
