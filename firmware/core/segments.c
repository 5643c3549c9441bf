#include "segments.h"

#include "checks.h"
#include "tip.h"
#include "tip_checks.h"

#include <string.h>

struct dv_situation dv_situation_of(const struct dv_board *board)
{
    const struct dv_control *control = &board->control;
    struct dv_situation at = {
        .state = control->state,
        .joints = control->parameters.configure.joints,
        .idle = dv_control_is_idle(control),
        .epoch = control->epoch,
        .now = control->now,
        .ticks_per_ms = control->ticks_per_ms,
    };
    dv_drive_counts(&control->drive, at.counts);
    return at;
}

/* The queue's knot as a segment of the other kind speaks of it. False: not possible there. */
static bool find_origin(const struct dv_control *control, bool cartesian, struct dv_knot *origin)
{
    const struct dv_knot *knot = &control->queue.knot;
    *origin = *knot;
    if (cartesian && !control->homed) {
        return false;
    }
    if (cartesian == knot->cartesian) {
        return true;
    }
    return dv_knot_rests(knot)
        && (cartesian ? dv_tip_knot(&control->parameters, knot, origin)
                      : dv_joint_knot(&control->parameters, knot, origin));
}

/* What is wrong with it before its motion is judged, if anything. */
static struct dv_objection early_objection(const struct dv_control *control,
                                           const struct dv_span *span, bool fits,
                                           const struct dv_situation *at, struct dv_knot *origin)
{
    if (!fits) {
        return dv_object(DV_REFUSAL_CONFIGURATION, -1);
    }
    if (!dv_is_well_timed(span, at, &control->queue)) {
        return dv_object(DV_REFUSAL_TIME, -1);
    }
    bool possible = find_origin(control, span->knot.cartesian, origin);
    return possible ? dv_no_objection() : dv_object(DV_REFUSAL_KIND, -1);
}

static struct dv_objection motion_objection(const struct dv_board *board, struct dv_span *span,
                                            const struct dv_knot *origin, bool homed)
{
    const struct dv_parameters *parameters = &board->control.parameters;
    const struct dv_leeway *leeway = &board->control.leeway;
    uint32_t tick_hz = board->hal->tick_hz;
    if (!span->knot.cartesian) {
        return dv_check_segment(parameters, tick_hz, origin, &span->knot, span->duration, homed,
                                leeway->outside);
    }
    for (int i = 3; i < DV_JOINTS_MAX; i++) {
        span->knot.p[i] = origin->p[i];
    }
    return dv_check_tip_segment(parameters, tick_hz, origin, &span->knot, span->duration, leeway);
}

/* The same, while control goes on. What it takes from the board meanwhile, only messages change. */
static struct dv_objection motion_objection_unlocked(struct dv_board *board, struct dv_span *span,
                                                     const struct dv_knot *origin)
{
    const struct dv_hal *hal = board->hal;
    bool homed = board->control.homed;
    hal->unlock_control(hal->context);
    struct dv_objection found = motion_objection(board, span, origin, homed);
    hal->lock_control(hal->context);
    return found;
}

static bool is_passed_over(struct dv_board *board, const struct dv_span *span,
                           const struct dv_situation *at)
{
    uint8_t refusal = dv_segment_refusal(span, at, &board->control.queue);
    if (refusal != 0) {
        dv_say_refused(&board->reports, span->type, refusal, -1, span->index);
    }
    return refusal != 0;
}

static void take(struct dv_board *board, const struct dv_span *span, const struct dv_knot *origin,
                 bool idle)
{
    struct dv_control *control = &board->control;
    dv_lease_extend(&control->lease, span->seen, control->now);
    if (idle && !control->lease.alive) {
        dv_say_refused(&board->reports, span->type, DV_REFUSAL_LEASE, -1, span->index);
        dv_control_halt(control, DV_CAUSE_LEASE);
    } else {
        dv_control_enqueue(control, span, origin);
    }
}

/* `fits`: it has a number for each joint. */
static void run_span(struct dv_board *board, struct dv_span *span, bool fits)
{
    struct dv_control *control = &board->control;
    struct dv_situation at = dv_situation_of(board);
    struct dv_knot origin;
    if (is_passed_over(board, span, &at)) {
        return;
    }
    struct dv_objection found = early_objection(control, span, fits, &at, &origin);
    if (found.reason == 0) {
        found = motion_objection_unlocked(board, span, &origin);
        at = dv_situation_of(board);
        if (is_passed_over(board, span, &at)) { /* control has stopped, for a reason of its own */
            return;
        }
    }
    if (found.reason != 0) {
        dv_say_refused(&board->reports, span->type, found.reason, found.joint, span->index);
        dv_control_halt(control, DV_CAUSE_BAD_SEGMENT);
    } else {
        take(board, span, &origin, at.idle);
    }
}

void dv_run_segment(struct dv_board *board, const struct dv_segment *message)
{
    struct dv_span span = {
        .type = DV_SEGMENT,
        .epoch = message->epoch,
        .index = message->index,
        .t_end = message->t_end,
        .duration = message->duration,
        .seen = message->seen,
    };
    memcpy(span.knot.p, message->p, sizeof span.knot.p);
    memcpy(span.knot.v, message->v, sizeof span.knot.v);
    run_span(board, &span, message->joints == board->control.parameters.configure.joints);
}

void dv_run_cartesian_segment(struct dv_board *board, const struct dv_cartesian_segment *message)
{
    struct dv_span span = {
        .type = DV_CARTESIAN_SEGMENT,
        .epoch = message->epoch,
        .index = message->index,
        .t_end = message->t_end,
        .duration = message->duration,
        .seen = message->seen,
        .knot = {.cartesian = true},
    };
    memcpy(span.knot.p, message->p, sizeof message->p);
    memcpy(span.knot.v, message->v, sizeof message->v);
    run_span(board, &span, true);
}
