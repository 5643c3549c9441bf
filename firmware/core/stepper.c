#include "stepper.h"

#include <string.h>

#define HALF ((int64_t)1 << 31)

/* The present piece has ended; what is not planned stands still. */
static void begin_piece(struct dv_stepper *stepper)
{
    stepper->boundary = stepper->now;
    stepper->left = stepper->piece_ticks;
    stepper->late = stepper->late || !stepper->ready;
    for (uint32_t i = 0; i < stepper->joints; i++) {
        struct dv_axis *axis = &stepper->axis[i];
        axis->position = axis->target;
        axis->increment = stepper->ready ? stepper->next.increment[i] : 0;
        axis->target = stepper->ready ? stepper->next.target[i] : axis->position;
    }
    stepper->ready = false;
}

uint32_t dv_stepper_tick(struct dv_stepper *stepper)
{
    uint32_t high = 0, boundary = 0;
    stepper->now++;
    stepper->left--;
    if (stepper->left == 0) {
        begin_piece(stepper);
        boundary = DV_PINS_BOUNDARY;
    } else {
        for (uint32_t i = 0; i < stepper->joints; i++) {
            stepper->axis[i].position += stepper->axis[i].increment;
        }
    }
    for (uint32_t i = 0; i < stepper->joints; i++) {
        struct dv_axis *axis = &stepper->axis[i];
        int32_t owed = (int32_t)(axis->position >> 32) - axis->emitted;
        if (owed == 0) {
            continue;
        }
        uint32_t pin = 1u << i;
        bool is_forward = (stepper->forward & pin) != 0;
        if (is_forward != (owed > 0)) {
            stepper->forward ^= pin;
        } else if ((stepper->high & pin) == 0) {
            high |= pin;
            axis->emitted += is_forward ? 1 : -1;
        }
    }
    stepper->high = high;
    return high | (stepper->forward ^ stepper->inverted) << DV_PINS_DIR_SHIFT | boundary;
}

void dv_stepper_init(struct dv_stepper *stepper, uint32_t tick_hz, uint32_t now)
{
    memset(stepper, 0, sizeof *stepper);
    stepper->now = now;
    stepper->boundary = now;
    stepper->piece_ticks = tick_hz / 1000;
    stepper->left = stepper->piece_ticks;
    stepper->ready = true;
}

void dv_stepper_use(struct dv_stepper *stepper, uint32_t joints, uint32_t inverted)
{
    const int64_t zero[DV_JOINTS_MAX] = {0};
    stepper->joints = joints;
    stepper->inverted = inverted;
    stepper->forward = 0;
    dv_stepper_place(stepper, zero);
}

void dv_stepper_plan(struct dv_stepper *stepper, const int64_t *target, const int64_t *increment)
{
    for (uint32_t i = 0; i < stepper->joints; i++) {
        stepper->next.target[i] = target[i] + HALF;
        stepper->next.increment[i] = increment[i];
    }
    stepper->ready = true;
}

/* This piece and, if it is planned, the next stand at `position`, which has its half. */
static void stand_at(struct dv_stepper *stepper, uint32_t joint, int64_t position)
{
    struct dv_axis *axis = &stepper->axis[joint];
    axis->position = axis->target = stepper->next.target[joint] = position;
    axis->increment = stepper->next.increment[joint] = 0;
}

void dv_stepper_place(struct dv_stepper *stepper, const int64_t *position)
{
    for (uint32_t i = 0; i < stepper->joints; i++) {
        stand_at(stepper, i, position[i] + HALF);
        stepper->axis[i].emitted = (int32_t)(stepper->axis[i].position >> 32);
    }
}

void dv_stepper_cut(struct dv_stepper *stepper)
{
    for (uint32_t i = 0; i < stepper->joints; i++) {
        stand_at(stepper, i, stepper->axis[i].position);
    }
}

int64_t dv_stepper_position(const struct dv_stepper *stepper, uint32_t joint)
{
    return stepper->axis[joint].position - HALF;
}
