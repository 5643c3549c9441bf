#include "drive.h"

#include "brake.h"
#include "integers.h"

#include <string.h>

void dv_drive_init(struct dv_drive *drive, const struct dv_hal *hal, struct dv_stepper *stepper)
{
    memset(drive, 0, sizeof *drive);
    drive->hal = hal;
    drive->stepper = stepper;
    drive->ticks_per_ms = hal->tick_hz / 1000;
}

static uint32_t inverted_pins(const struct dv_configure *configure)
{
    uint32_t pins = 0;
    for (uint32_t i = 0; i < configure->joints; i++) {
        pins |= configure->inverted[i] ? 1u << i : 0;
    }
    return pins;
}

/* The plan ends at `positions`. */
static void take(struct dv_drive *drive, const int64_t *positions)
{
    for (uint32_t i = 0; i < drive->stepper->joints; i++) {
        drive->planned[i] = positions[i];
    }
}

/* In this piece and the next it stands at `positions`. */
static void stand_at(struct dv_drive *drive, const int64_t *positions)
{
    memcpy(drive->planned, positions, sizeof drive->planned);
    memcpy(drive->target, positions, sizeof drive->target);
    memcpy(drive->boundary, positions, sizeof drive->boundary);
    drive->piece_moves = drive->next_moves = false;
}

void dv_drive_use(struct dv_drive *drive, const struct dv_parameters *parameters)
{
    static const int64_t ZERO[DV_JOINTS_MAX] = {0};
    const struct dv_configure *configure = &parameters->configure;
    drive->parameters = parameters;
    drive->path.kind = DV_PATH_NONE;
    stand_at(drive, ZERO);
    drive->hal->hold_steps(drive->hal->context);
    dv_stepper_use(drive->stepper, configure->joints, inverted_pins(configure));
    drive->hal->release_steps(drive->hal->context);
}

bool dv_drive_follows(const struct dv_drive *drive)
{
    return drive->path.kind != DV_PATH_NONE;
}

bool dv_drive_moves(const struct dv_drive *drive)
{
    return dv_drive_follows(drive) || drive->piece_moves || drive->next_moves;
}

uint32_t dv_drive_counts(const struct dv_drive *drive, int32_t *counts)
{
    drive->hal->hold_steps(drive->hal->context);
    uint32_t now = drive->stepper->now;
    for (uint32_t i = 0; i < drive->stepper->joints; i++) {
        counts[i] = dv_nearest(dv_stepper_position(drive->stepper, i));
    }
    drive->hal->release_steps(drive->hal->context);
    return now;
}

void dv_drive_place(struct dv_drive *drive, const int64_t *positions)
{
    drive->hal->hold_steps(drive->hal->context);
    dv_stepper_place(drive->stepper, positions);
    drive->hal->release_steps(drive->hal->context);
    stand_at(drive, positions);
}

void dv_drive_cut(struct dv_drive *drive)
{
    int64_t positions[DV_JOINTS_MAX] = {0};
    drive->hal->hold_steps(drive->hal->context);
    dv_stepper_cut(drive->stepper);
    for (uint32_t i = 0; i < drive->stepper->joints; i++) {
        positions[i] = dv_stepper_position(drive->stepper, i);
    }
    drive->hal->release_steps(drive->hal->context);
    drive->path.kind = DV_PATH_NONE;
    stand_at(drive, positions);
}

void dv_drive_follow(struct dv_drive *drive, uint32_t start)
{
    drive->start = start;
    drive->end = start + drive->path.ticks;
}

void dv_drive_brake(struct dv_drive *drive, uint32_t tick)
{
    int64_t positions[DV_JOINTS_MAX];
    int32_t velocities[DV_JOINTS_MAX];
    if (!dv_drive_follows(drive)) {
        return;
    }
    uint32_t at = dv_since(tick, drive->start) > 0 ? tick - drive->start : 0;
    if (!dv_path_positions(&drive->path, at, positions)
        || !dv_path_velocities(&drive->path, at, velocities)) {
        drive->path.kind = DV_PATH_NONE;
        return;
    }
    dv_brake(&drive->path, drive->parameters, positions, velocities, drive->ticks_per_ms);
    dv_drive_follow(drive, drive->start + at);
}

void dv_drive_rest(struct dv_drive *drive)
{
    int64_t positions[DV_JOINTS_MAX];
    if (dv_path_positions(&drive->path, drive->path.ticks, positions)) {
        take(drive, positions);
    }
    drive->path.kind = DV_PATH_NONE;
}

void dv_drive_begin_piece(struct dv_drive *drive)
{
    memcpy(drive->boundary, drive->target, sizeof drive->boundary);
    memcpy(drive->target, drive->planned, sizeof drive->target);
    drive->piece_moves = drive->next_moves;
    drive->next_moves = false;
}

bool dv_drive_leads_into(const struct dv_drive *drive, uint32_t pressed)
{
    const struct dv_configure *configure = &drive->parameters->configure;
    for (int joint = 0; joint < configure->joints; joint++) {
        int64_t way = drive->target[joint] - drive->boundary[joint];
        bool inwards = configure->homing_direction > 0 ? way > 0 : way < 0;
        if (((pressed >> joint) & 1u) != 0 && inwards) {
            return true;
        }
    }
    return false;
}

bool dv_drive_plan(struct dv_drive *drive, uint32_t tick)
{
    int64_t positions[DV_JOINTS_MAX], increments[DV_JOINTS_MAX] = {0};
    if (dv_drive_follows(drive)) {
        if (!dv_path_positions(&drive->path, tick - drive->start, positions)) {
            return false;
        }
        take(drive, positions);
    }
    for (uint32_t i = 0; i < drive->stepper->joints; i++) {
        int64_t way = drive->planned[i] - drive->target[i];
        increments[i] = dv_floor_divide(way, drive->ticks_per_ms);
        drive->next_moves = drive->next_moves || way != 0;
    }
    drive->hal->hold_steps(drive->hal->context);
    dv_stepper_plan(drive->stepper, drive->planned, increments);
    drive->hal->release_steps(drive->hal->context);
    return true;
}
