#include "commands.h"

#include "segments.h"
#include "turn.h"

#include <math.h>

static void refuse(struct dv_board *board, uint8_t command, enum dv_refusal reason)
{
    dv_say_refused(&board->reports, command, (uint8_t)reason, -1, -1);
}

static bool allowed(struct dv_board *board, uint8_t command, enum dv_event event)
{
    uint8_t state = board->control.state;
    bool possible = dv_state_after(state, event) >= 0;
    if (!possible) {
        bool busy = state == DV_STATE_BRAKING || state == DV_STATE_HOMING;
        refuse(board, command, busy ? DV_REFUSAL_MOVING : DV_REFUSAL_STATE);
    }
    return possible;
}

/* Taken before the board is configured, too. */

static void copy_name(char name[DV_TEXT_MAX + 1], const char *from)
{
    for (int i = 0; i < DV_TEXT_MAX && from[i] != '\0'; i++) {
        name[i] = from[i];
    }
}

static void hello(struct dv_board *board, const struct dv_hello *message)
{
    struct dv_control *control = &board->control;
    board->speaks = message->version == DV_PROTOCOL_VERSION;
    dv_control_halt(control, DV_CAUSE_HOST_STOP);
    dv_lease_expire(&control->lease);
    struct dv_hello_reply reply = {
        .version = DV_PROTOCOL_VERSION,
        .joints = control->parameters.configure.joints,
        .tick_hz = board->hal->tick_hz,
        .queue_places = DV_QUEUE_PLACES,
        .boot = board->hal->boot,
        .last_epoch = control->epoch,
        .homed = control->homed,
        .configuration = control->configuration,
        .last_stop = control->cause,
    };
    copy_name(reply.board, board->hal->board);
    copy_name(reply.build, board->hal->build);
    dv_say_hello_reply(&board->reports, &reply);
}

static void configure(struct dv_board *board, const struct dv_configure *message, uint32_t hash)
{
    struct dv_control *control = &board->control;
    struct dv_parameters parameters;
    if (hash == control->configuration) {
        dv_say_configured(&board->reports, hash);
    } else if (!dv_parameters_from(&parameters, message, board->hal->tick_hz)) {
        refuse(board, DV_CONFIGURE, DV_REFUSAL_CONFIGURATION);
    } else if (control->state != DV_STATE_DISABLED) {
        refuse(board, DV_CONFIGURE, DV_REFUSAL_STATE);
    } else {
        control->parameters = parameters;
        dv_control_configure(control, hash);
        dv_say_configured(&board->reports, hash);
    }
}

static void keep(struct dv_board *board, const struct dv_keep *message)
{
    dv_lease_extend(&board->control.lease, message->seen, board->control.now);
}

static void stop(struct dv_board *board)
{
    struct dv_control *control = &board->control;
    if (dv_control_moves(control) || control->state == DV_STATE_ARMED) {
        dv_control_halt(control, DV_CAUSE_HOST_STOP);
    } else {
        dv_control_say_stopped(control);
    }
}

static void reset(struct dv_board *board)
{
    struct dv_control *control = &board->control;
    if (control->estop_input) {
        refuse(board, DV_RESET, DV_REFUSAL_INPUT);
    } else if (allowed(board, DV_RESET, DV_EVENT_RESET)) {
        control->fault = DV_FAULT_NONE;
        control->homed = false;
        dv_control_change(control, DV_EVENT_RESET);
        dv_say_done(&board->reports, DV_RESET);
    }
}

/* Need a configuration. */

static void enable(struct dv_board *board)
{
    if (board->control.estop_input) {
        refuse(board, DV_ENABLE, DV_REFUSAL_INPUT);
    } else if (allowed(board, DV_ENABLE, DV_EVENT_ENABLE)) {
        dv_control_change(&board->control, DV_EVENT_ENABLE);
        dv_say_done(&board->reports, DV_ENABLE);
    }
}

static void disable(struct dv_board *board)
{
    struct dv_control *control = &board->control;
    if (dv_control_moves(control)) {
        control->disable_pending = true;
        dv_control_halt(control, DV_CAUSE_DISABLED);
    } else if (allowed(board, DV_ENABLE, DV_EVENT_DISABLE)) {
        dv_control_halt(control, DV_CAUSE_DISABLED);
        dv_control_change(control, DV_EVENT_DISABLE);
        control->homed = false;
        dv_say_done(&board->reports, DV_ENABLE);
    }
}

static void home(struct dv_board *board)
{
    struct dv_control *control = &board->control;
    if (!allowed(board, DV_HOME, DV_EVENT_HOME)) {
        return;
    }
    struct dv_situation at = dv_situation_of(board);
    if (!at.idle) {
        refuse(board, DV_HOME, DV_REFUSAL_MOVING);
    } else if (!control->lease.alive) {
        refuse(board, DV_HOME, DV_REFUSAL_LEASE);
    } else if (!dv_within(at.counts, at.joints, DV_HOMING_COUNTS)) {
        refuse(board, DV_HOME, DV_REFUSAL_COUNTS);
    } else {
        dv_control_begin_homing(control);
    }
}

static void arm(struct dv_board *board, const struct dv_arm *message)
{
    if (!allowed(board, DV_ARM, DV_EVENT_ARM)) {
        return;
    }
    struct dv_situation at = dv_situation_of(board);
    uint8_t refusal = dv_arm_refusal(message, &at);
    if (refusal != 0) {
        refuse(board, DV_ARM, (enum dv_refusal)refusal);
    } else {
        dv_control_open_epoch(&board->control, message);
        dv_say_done(&board->reports, DV_ARM);
    }
}

static void tool(struct dv_board *board, const struct dv_tool *message)
{
    uint8_t state = board->control.state;
    if (!dv_state_is_powered(state) || state == DV_STATE_FAULT) {
        refuse(board, DV_TOOL, DV_REFUSAL_STATE);
    } else if (!isfinite(message->servo_angle)) {
        refuse(board, DV_TOOL, DV_REFUSAL_CONFIGURATION);
    } else {
        dv_control_use_tool(&board->control, message);
        dv_say_done(&board->reports, DV_TOOL);
    }
}

/* Of any type that a host sends. */
union message {
    struct dv_hello hello;
    struct dv_configure configure;
    struct dv_enable enable;
    struct dv_arm arm;
    struct dv_segment segment;
    struct dv_cartesian_segment cartesian_segment;
    struct dv_keep keep;
    struct dv_tool tool;
};

static bool decode(const struct dv_frame *frame, union message *message)
{
    switch (frame->type) {
    case DV_HELLO:
        return dv_decode_hello(frame->payload, frame->size, &message->hello);
    case DV_CONFIGURE:
        return dv_decode_configure(frame->payload, frame->size, &message->configure);
    case DV_ENABLE:
        return dv_decode_enable(frame->payload, frame->size, &message->enable);
    case DV_HOME:
        return dv_decode_home(frame->payload, frame->size);
    case DV_ARM:
        return dv_decode_arm(frame->payload, frame->size, &message->arm);
    case DV_SEGMENT:
        return dv_decode_segment(frame->payload, frame->size, &message->segment);
    case DV_CARTESIAN_SEGMENT:
        return dv_decode_cartesian_segment(frame->payload, frame->size,
                                           &message->cartesian_segment);
    case DV_KEEP:
        return dv_decode_keep(frame->payload, frame->size, &message->keep);
    case DV_STOP:
        return dv_decode_stop(frame->payload, frame->size);
    case DV_ESTOP:
        return dv_decode_estop(frame->payload, frame->size);
    case DV_RESET:
        return dv_decode_reset(frame->payload, frame->size);
    case DV_TOOL:
        return dv_decode_tool(frame->payload, frame->size, &message->tool);
    default:
        return false;
    }
}

/* Why a message of this type is refused whatever it says; 0: it is not. */
static uint8_t type_refusal(const struct dv_board *board, uint8_t type)
{
    bool stops = type == DV_HELLO || type == DV_STOP || type == DV_ESTOP;
    if (!board->speaks && !stops) {
        return DV_REFUSAL_VERSION;
    }
    bool before_robot = stops || type == DV_CONFIGURE || type == DV_KEEP || type == DV_RESET;
    bool possible = before_robot || dv_control_is_configured(&board->control);
    return possible ? 0 : DV_REFUSAL_CONFIGURATION;
}

/* Of a segment; -1 of what is none. */
static int32_t index_of(const struct dv_frame *frame, const union message *message)
{
    if (frame->type == DV_SEGMENT) {
        return message->segment.index;
    }
    return frame->type == DV_CARTESIAN_SEGMENT ? message->cartesian_segment.index : -1;
}

static void act(struct dv_board *board, const struct dv_frame *frame, const union message *message)
{
    switch (frame->type) {
    case DV_HELLO:
        hello(board, &message->hello);
        break;
    case DV_CONFIGURE: {
        uint32_t hash = dv_crc32(frame->payload, frame->size);
        configure(board, &message->configure, hash == 0 ? 1 : hash);
        break;
    }
    case DV_ENABLE:
        if (message->enable.on) {
            enable(board);
        } else {
            disable(board);
        }
        break;
    case DV_HOME:
        home(board);
        break;
    case DV_ARM:
        arm(board, &message->arm);
        break;
    case DV_SEGMENT:
        dv_run_segment(board, &message->segment);
        break;
    case DV_CARTESIAN_SEGMENT:
        dv_run_cartesian_segment(board, &message->cartesian_segment);
        break;
    case DV_KEEP:
        keep(board, &message->keep);
        break;
    case DV_STOP:
        stop(board);
        break;
    case DV_ESTOP:
        dv_control_drivers_off(&board->control, DV_FAULT_NONE);
        break;
    case DV_RESET:
        reset(board);
        break;
    case DV_TOOL:
        tool(board, &message->tool);
        break;
    default:
        break;
    }
}

void dv_carry_out(struct dv_board *board, const struct dv_frame *frame)
{
    union message message;
    if (!decode(frame, &message) || !dv_endpoint_admits(&board->endpoint, frame)) {
        return;
    }
    board->control.now = board->stepper.now;
    uint8_t refusal = type_refusal(board, frame->type);
    if (refusal != 0) {
        dv_say_refused(&board->reports, frame->type, refusal, -1, index_of(frame, &message));
    } else {
        act(board, frame, &message);
    }
    dv_control_report(&board->control);
}
