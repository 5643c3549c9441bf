#include "control.h"

#include "integers.h"

#include <string.h>

void dv_control_init(struct dv_control *control, const struct dv_hal *hal,
                     struct dv_stepper *stepper, struct dv_reports *reports)
{
    memset(control, 0, sizeof *control);
    control->hal = hal;
    control->reports = reports;
    control->ticks_per_ms = hal->tick_hz / 1000;
    control->now = stepper->now;
    control->planned = stepper->now + 2 * control->ticks_per_ms;
    control->state = DV_STATE_DISABLED;
    control->cause = DV_CAUSE_BOOT;
    dv_drive_init(&control->drive, hal, stepper);
    dv_lease_init(&control->lease, DV_LEASE_MS * control->ticks_per_ms);
}

bool dv_control_is_configured(const struct dv_control *control)
{
    return control->configuration != 0;
}

bool dv_control_moves(const struct dv_control *control)
{
    return control->state == DV_STATE_BRAKING || control->state == DV_STATE_HOMING
        || dv_drive_moves(&control->drive);
}

bool dv_control_is_idle(const struct dv_control *control)
{
    return !dv_control_moves(control) && control->queue.count == 0;
}

static void put_drivers(struct dv_control *control)
{
    bool active_high = (control->parameters.configure.options & DV_OPTION_ENABLE_ACTIVE_HIGH) != 0;
    if (dv_control_is_configured(control)) {
        control->hal->drivers(control->hal->context, dv_state_is_powered(control->state),
                              active_high);
    }
}

void dv_control_use_tool(struct dv_control *control, const struct dv_tool *tool)
{
    control->tool = *tool;
    control->hal->tool(control->hal->context, tool->on, tool->servo_angle);
}

void dv_control_change(struct dv_control *control, enum dv_event event)
{
    control->state = (uint8_t)dv_state_after(control->state, event);
    control->reports->changed = true;
    put_drivers(control);
    if (!dv_state_is_powered(control->state) && control->tool.on) {
        struct dv_tool off = {false, control->tool.servo_angle};
        dv_control_use_tool(control, &off);
    }
}

/* What commands begin. */

void dv_control_configure(struct dv_control *control, uint32_t hash)
{
    control->configuration = hash;
    control->looked = false;
    control->switches = 0;
    control->reports->changed = true;
    dv_drive_use(&control->drive, &control->parameters);
    put_drivers(control);
}

void dv_control_begin_homing(struct dv_control *control)
{
    control->homed = false;
    control->cause = DV_CAUSE_NONE;
    control->seeks = true;
    dv_homing_begin(&control->homing, &control->parameters, control->ticks_per_ms);
    dv_control_change(control, DV_EVENT_HOME);
}

void dv_control_open_epoch(struct dv_control *control, const struct dv_arm *arm)
{
    int64_t positions[DV_JOINTS_MAX] = {0}; /* whole: host and board start from the same point */
    for (int i = 0; i < arm->joints; i++) {
        positions[i] = dv_whole(arm->counts[i]);
    }
    dv_drive_place(&control->drive, positions);
    control->epoch = arm->epoch;
    control->cause = DV_CAUSE_NONE;
    dv_queue_open(&control->queue, arm->joints, arm->counts, arm->t_start, control->planned);
    control->leeway = dv_leeway_at(&control->parameters, &control->queue.knot, control->homed);
    dv_control_change(control, DV_EVENT_ARM);
}

void dv_control_enqueue(struct dv_control *control, const struct dv_span *span,
                        const struct dv_knot *origin)
{
    dv_queue_push(&control->queue, span, origin, control->planned, dv_control_is_idle(control));
    dv_leeway_come_to(&control->leeway, &control->parameters, &control->queue.knot);
}

/* Stops. */

/* The first cause wins until the next Arm or Home. */
static void latch(struct dv_control *control, enum dv_stop_cause cause)
{
    if (control->cause == DV_CAUSE_NONE || control->cause == DV_CAUSE_BOOT
        || control->cause == DV_CAUSE_HOMED) {
        control->cause = (uint8_t)cause;
    }
}

static void brake(struct dv_control *control, enum dv_stop_cause cause)
{
    latch(control, cause);
    control->seeks = false;
    dv_control_change(control, DV_EVENT_BRAKE);
    dv_drive_brake(&control->drive, control->planned);
}

void dv_control_halt(struct dv_control *control, enum dv_stop_cause cause)
{
    dv_queue_clear(&control->queue);
    if (dv_control_moves(control)) {
        if (control->state != DV_STATE_BRAKING) {
            brake(control, cause);
        }
    } else if (control->state == DV_STATE_ARMED) {
        latch(control, cause);
        dv_control_change(control, DV_EVENT_HALT);
        dv_control_say_stopped(control);
    }
}

void dv_control_drivers_off(struct dv_control *control, enum dv_fault fault)
{
    dv_drive_cut(&control->drive);
    dv_queue_clear(&control->queue);
    control->seeks = false;
    control->disable_pending = false;
    control->homed = false;
    control->fault = (uint8_t)fault;
    control->cause = DV_CAUSE_ESTOP;
    dv_control_change(control, DV_EVENT_ESTOP);
    dv_control_say_stopped(control);
}

/* Brakes into FAULT. */
static void fail(struct dv_control *control, enum dv_fault fault, enum dv_stop_cause cause)
{
    if (control->fault == DV_FAULT_NONE) {
        control->fault = (uint8_t)fault;
    }
    if (control->state != DV_STATE_BRAKING) {
        dv_queue_clear(&control->queue);
        brake(control, cause);
    }
}

static void came_to_rest(struct dv_control *control)
{
    if (control->fault != DV_FAULT_NONE) {
        dv_control_change(control, DV_EVENT_RESTED_FAULT);
        if (control->disable_pending) {
            dv_say_refused(control->reports, DV_ENABLE, DV_REFUSAL_STATE, -1, -1);
        }
    } else if (control->disable_pending) {
        control->homed = false;
        dv_control_change(control, DV_EVENT_RESTED_DISABLE);
        dv_say_done(control->reports, DV_ENABLE);
    } else {
        dv_control_change(control, DV_EVENT_RESTED);
    }
    control->disable_pending = false;
    dv_control_say_stopped(control);
}

/* What happens where a piece begins, in this order. */

static void look_at_switches(struct dv_control *control, uint8_t levels)
{
    const struct dv_configure *configure = &control->parameters.configure;
    uint32_t all = (1u << configure->joints) - 1, high = levels & all;
    bool active_open = (configure->options & DV_OPTION_SWITCH_ACTIVE_OPEN) != 0;
    uint32_t pressed = active_open ? high : high ^ all;
    uint32_t newly = control->looked ? pressed & ~control->switches : 0;
    control->reports->changed = control->reports->changed || pressed != control->switches;
    control->switches = pressed;
    control->looked = true;
    if (control->seeks || dv_control_is_idle(control)) {
        return;
    }
    bool comes_from_one = control->state == DV_STATE_HOMING; /* on its way to the ready pose */
    bool goes_on = control->state != DV_STATE_BRAKING
        && dv_drive_leads_into(&control->drive, pressed);
    if ((newly != 0 && !comes_from_one) || goes_on) {
        fail(control, DV_FAULT_LIMIT_SWITCH, DV_CAUSE_LIMIT_SWITCH);
    }
}

static void look(struct dv_control *control)
{
    uint8_t levels = control->hal->inputs(control->hal->context);
    bool estop = (levels & DV_LEVEL_ESTOP) != 0;
    if (estop != control->estop_input) {
        control->estop_input = estop;
        control->reports->changed = true;
        if (estop) {
            dv_control_drivers_off(control, DV_FAULT_ESTOP_INPUT);
        }
    }
    if (dv_control_is_configured(control)) {
        look_at_switches(control, levels);
    }
}

/* Ends the lease at the last boundary from which the brake begins in time: a piece later. */
static void judge_lease(struct dv_control *control)
{
    if (control->lease.alive
        && dv_lease_remaining(&control->lease, control->now) < 2 * (int32_t)control->ticks_per_ms) {
        dv_lease_expire(&control->lease);
        if (!dv_control_is_idle(control)) {
            dv_control_halt(control, DV_CAUSE_LEASE);
        }
    }
}

static void notice_rest(struct dv_control *control)
{
    if (dv_drive_moves(&control->drive)) {
        return;
    }
    if (control->state == DV_STATE_BRAKING) {
        came_to_rest(control);
    } else if (control->state == DV_STATE_HOMING && !control->seeks) {
        control->homed = true;
        latch(control, DV_CAUSE_HOMED);
        dv_control_change(control, DV_EVENT_HOMED);
        dv_say_done(control->reports, DV_HOME);
        dv_control_say_stopped(control);
    }
}

static void go_on_homing(struct dv_control *control)
{
    struct dv_drive *drive = &control->drive;
    struct dv_homing *homing = &control->homing;
    if (!dv_homing_is_done(homing)) {
        struct dv_path path;
        dv_homing_next_path(homing, &path, drive->boundary, control->switches, drive->planned);
        uint8_t fault = dv_homing_fault(homing);
        if (fault != DV_FAULT_NONE) {
            fail(control, (enum dv_fault)fault, DV_CAUSE_HOMING_FAILED);
        } else {
            drive->path = path;
            dv_drive_follow(drive, control->planned);
        }
    } else if (!dv_drive_moves(drive)) {
        int64_t positions[DV_JOINTS_MAX];
        memcpy(positions, drive->planned, sizeof positions);
        dv_homing_refer(homing, positions);
        dv_drive_place(drive, positions);
        dv_homing_way_to_ready(homing, &drive->path, positions);
        dv_drive_follow(drive, control->planned);
        control->seeks = false;
    }
}

static void take_up(struct dv_control *control, const struct dv_entry *entry)
{
    struct dv_drive *drive = &control->drive;
    if (entry->knot.cartesian) {
        dv_path_tip(&drive->path, &control->parameters, &entry->origin, &entry->knot,
                    entry->duration, control->ticks_per_ms);
    } else {
        dv_path_cubic(&drive->path, control->parameters.configure.joints, &entry->origin,
                      &entry->knot, entry->duration, control->ticks_per_ms);
    }
    dv_drive_follow(drive, entry->start);
    dv_queue_pop(&control->queue);
}

/* Whether a path was left that ends before `until`, or taken up that begins before. */
static bool changes_path(struct dv_control *control, uint32_t until)
{
    struct dv_drive *drive = &control->drive;
    const struct dv_entry *head = dv_queue_head(&control->queue);
    if (!dv_drive_follows(drive)) {
        if (head == NULL || dv_since(head->start, until) >= 0) {
            return false;
        }
    } else if (dv_since(drive->end, until) > 0) {
        return false;
    } else if (drive->path.rests) {
        dv_drive_rest(drive);
        return true;
    } else if (drive->end == until) {
        return false;
    } else if (head == NULL) {
        latch(control, DV_CAUSE_UNDERRUN);
        dv_control_change(control, DV_EVENT_BRAKE);
        dv_drive_brake(drive, drive->end);
        return true;
    }
    take_up(control, head);
    return true;
}

static void plan(struct dv_control *control, uint32_t until)
{
    while (changes_path(control, until)) {
    }
    if (!dv_drive_plan(&control->drive, until)) {
        /* A tip's path that was judged by looks leads out of reach between them. */
        dv_queue_clear(&control->queue);
        brake(control, DV_CAUSE_BAD_SEGMENT);
        dv_drive_plan(&control->drive, until);
    }
}

static void begin_piece(struct dv_control *control)
{
    struct dv_stepper *stepper = control->drive.stepper;
    control->hal->hold_steps(control->hal->context);
    bool late = stepper->late;
    stepper->late = false;
    control->now = stepper->boundary;
    control->hal->release_steps(control->hal->context);
    control->planned = control->now + control->ticks_per_ms;
    dv_drive_begin_piece(&control->drive);
    if (late) {
        dv_control_drivers_off(control, DV_FAULT_LATE);
    }
}

void dv_control_piece(struct dv_control *control)
{
    begin_piece(control);
    look(control);
    judge_lease(control);
    notice_rest(control);
    if (control->seeks) {
        go_on_homing(control);
    }
    uint32_t until = control->planned + control->ticks_per_ms;
    plan(control, until);
    control->planned = until;
    control->reports->pieces--;
    dv_control_report(control);
}

/* Reports. */

void dv_control_say_stopped(struct dv_control *control)
{
    struct dv_stopped stopped = {
        .epoch = control->epoch,
        .cause = control->cause,
        .joints = control->parameters.configure.joints,
    };
    stopped.now = dv_drive_counts(&control->drive, stopped.counts);
    dv_say_stopped(control->reports, &stopped);
}

static uint8_t flags(const struct dv_control *control)
{
    return (uint8_t)((control->homed ? DV_FLAG_HOMED : 0)
                     | (dv_control_moves(control) ? DV_FLAG_MOVING : 0)
                     | (control->lease.alive ? DV_FLAG_LEASE_ALIVE : 0)
                     | (dv_control_is_configured(control) ? DV_FLAG_CONFIGURED : 0));
}

void dv_control_report(struct dv_control *control)
{
    if (!dv_telemetry_is_due(control->reports)) {
        return;
    }
    struct dv_telemetry telemetry = {
        .state = control->state,
        .fault = control->fault,
        .epoch = control->epoch,
        .last_index = (uint16_t)(control->queue.next_index - 1),
        .free = (uint16_t)(DV_QUEUE_PLACES - control->queue.count),
        .inputs = (uint8_t)((control->estop_input ? DV_INPUT_ESTOP : 0)
                            | control->switches * DV_INPUT_SWITCH_0),
        .flags = flags(control),
        .joints = control->parameters.configure.joints,
    };
    telemetry.now = dv_drive_counts(&control->drive, telemetry.counts);
    telemetry.t_queue_end =
        dv_control_is_idle(control) ? telemetry.now : control->queue.end;
    dv_say_telemetry(control->reports, &telemetry);
}
