/* The upper tier: where the joints are to be, from boundary to boundary, along one path at a time.
 *
 * Ticks are the board's. What is planned is final: a path that is left is left where the plan ends.
 * Used by control, and by the main loop while control is kept out.
 */
#ifndef DV_DRIVE_H
#define DV_DRIVE_H

#include "hal.h"
#include "parameters.h"
#include "paths.h"
#include "stepper.h"

#include <stdbool.h>
#include <stdint.h>

/* Positions in Q32. */
struct dv_drive {
    const struct dv_hal *hal;
    struct dv_stepper *stepper;
    const struct dv_parameters *parameters;
    uint32_t ticks_per_ms;
    struct dv_path path; /* what is followed where the plan ends; of no kind: nothing moves there */
    uint32_t start, end; /* the ticks of the path, while there is one */
    int64_t planned[DV_JOINTS_MAX];  /* where the plan ends */
    int64_t target[DV_JOINTS_MAX];   /* where the present piece ends */
    int64_t boundary[DV_JOINTS_MAX]; /* where it began */
    bool piece_moves, next_moves;    /* the present piece does, and the planned one */
};

/* Not configured: without joints. */
void dv_drive_init(struct dv_drive *drive, const struct dv_hal *hal, struct dv_stepper *stepper);

/* At rest: for another robot. All positions are 0. */
void dv_drive_use(struct dv_drive *drive, const struct dv_parameters *parameters);

bool dv_drive_follows(const struct dv_drive *drive); /* a path */
bool dv_drive_moves(const struct dv_drive *drive);

/* The counts at this very tick, which is returned. */
uint32_t dv_drive_counts(const struct dv_drive *drive, int32_t *counts);

/* At rest: says what the position is. */
void dv_drive_place(struct dv_drive *drive, const int64_t *positions);

/* The drivers are off: it stays where it is. */
void dv_drive_cut(struct dv_drive *drive);

/* `drive->path` was just made: from tick `start` on, not before where the plan ends. */
void dv_drive_follow(struct dv_drive *drive, uint32_t start);

/* Leaves the path along its tangent at `tick`: where the plan ends, or the path does. One that has
 * not begun by then is left where it begins.
 */
void dv_drive_brake(struct dv_drive *drive, uint32_t tick);

/* The path has ended, and it ended at rest. */
void dv_drive_rest(struct dv_drive *drive);

/* The stepper has taken over the planned piece. */
void dv_drive_begin_piece(struct dv_drive *drive);

/* A joint whose switch is `pressed` (a bit each) goes on towards its mechanical end. Where a piece
 * begins.
 */
bool dv_drive_leads_into(const struct dv_drive *drive, uint32_t pressed);

/* Until `tick`, one piece beyond the plan. False: the path leads nowhere there. */
bool dv_drive_plan(struct dv_drive *drive, uint32_t tick);

#endif
