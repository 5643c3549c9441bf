/* Made from deltaviz/link/wire/protocol.toml by `python -m deltaviz.link.wire.generate`. */
#include "messages.h"

#include "bytes.h"

#include <float.h>

_Static_assert(sizeof(float) == 4 && FLT_MANT_DIG == 24 && FLT_MAX_EXP == 128, "not IEEE 754");
_Static_assert(DV_TEXT_MAX < UINT8_MAX && DV_JOINTS_MAX <= 8, "too much for a byte");
_Static_assert(DV_HELLO_SIZE_MAX <= DV_PAYLOAD_MAX, "Hello is too long");
_Static_assert(DV_CONFIGURE_SIZE_MAX <= DV_PAYLOAD_MAX, "Configure is too long");
_Static_assert(DV_ENABLE_SIZE_MAX <= DV_PAYLOAD_MAX, "Enable is too long");
_Static_assert(DV_ARM_SIZE_MAX <= DV_PAYLOAD_MAX, "Arm is too long");
_Static_assert(DV_SEGMENT_SIZE_MAX <= DV_PAYLOAD_MAX, "Segment is too long");
_Static_assert(DV_CARTESIAN_SEGMENT_SIZE_MAX <= DV_PAYLOAD_MAX, "CartesianSegment is too long");
_Static_assert(DV_KEEP_SIZE_MAX <= DV_PAYLOAD_MAX, "Keep is too long");
_Static_assert(DV_TOOL_SIZE_MAX <= DV_PAYLOAD_MAX, "Tool is too long");
_Static_assert(DV_HELLO_REPLY_SIZE_MAX <= DV_PAYLOAD_MAX, "HelloReply is too long");
_Static_assert(DV_CONFIGURED_SIZE_MAX <= DV_PAYLOAD_MAX, "Configured is too long");
_Static_assert(DV_REFUSED_SIZE_MAX <= DV_PAYLOAD_MAX, "Refused is too long");
_Static_assert(DV_DONE_SIZE_MAX <= DV_PAYLOAD_MAX, "Done is too long");
_Static_assert(DV_TELEMETRY_SIZE_MAX <= DV_PAYLOAD_MAX, "Telemetry is too long");
_Static_assert(DV_STOPPED_SIZE_MAX <= DV_PAYLOAD_MAX, "Stopped is too long");

static bool is_type(uint8_t value)
{
    switch (value) {
    case DV_HELLO:
    case DV_CONFIGURE:
    case DV_ENABLE:
    case DV_HOME:
    case DV_ARM:
    case DV_SEGMENT:
    case DV_CARTESIAN_SEGMENT:
    case DV_KEEP:
    case DV_STOP:
    case DV_ESTOP:
    case DV_RESET:
    case DV_TOOL:
    case DV_HELLO_REPLY:
    case DV_CONFIGURED:
    case DV_REFUSED:
    case DV_DONE:
    case DV_TELEMETRY:
    case DV_STOPPED:
        return true;
    default:
        return false;
    }
}

static bool is_board_state(uint8_t value)
{
    switch (value) {
    case DV_STATE_DISABLED:
    case DV_STATE_HALTED:
    case DV_STATE_ARMED:
    case DV_STATE_BRAKING:
    case DV_STATE_HOMING:
    case DV_STATE_ESTOP:
    case DV_STATE_FAULT:
        return true;
    default:
        return false;
    }
}

static bool is_stop_cause(uint8_t value)
{
    switch (value) {
    case DV_CAUSE_NONE:
    case DV_CAUSE_HOST_STOP:
    case DV_CAUSE_UNDERRUN:
    case DV_CAUSE_LEASE:
    case DV_CAUSE_BAD_SEGMENT:
    case DV_CAUSE_LIMIT_SWITCH:
    case DV_CAUSE_ESTOP:
    case DV_CAUSE_DISABLED:
    case DV_CAUSE_HOMED:
    case DV_CAUSE_HOMING_FAILED:
    case DV_CAUSE_BOOT:
        return true;
    default:
        return false;
    }
}

static bool is_fault(uint8_t value)
{
    switch (value) {
    case DV_FAULT_NONE:
    case DV_FAULT_LIMIT_SWITCH:
    case DV_FAULT_HOMING_NO_SWITCH:
    case DV_FAULT_HOMING_SWITCH_STUCK:
    case DV_FAULT_ESTOP_INPUT:
    case DV_FAULT_CONFIGURATION:
    case DV_FAULT_LATE:
        return true;
    default:
        return false;
    }
}

static bool is_refusal(uint8_t value)
{
    switch (value) {
    case DV_REFUSAL_STATE:
    case DV_REFUSAL_EPOCH:
    case DV_REFUSAL_COUNTS:
    case DV_REFUSAL_MOVING:
    case DV_REFUSAL_INDEX:
    case DV_REFUSAL_TIME:
    case DV_REFUSAL_QUEUE_FULL:
    case DV_REFUSAL_JOINT_LIMIT:
    case DV_REFUSAL_VELOCITY:
    case DV_REFUSAL_ACCELERATION:
    case DV_REFUSAL_BRAKE:
    case DV_REFUSAL_WORKSPACE:
    case DV_REFUSAL_CONFIGURATION:
    case DV_REFUSAL_VERSION:
    case DV_REFUSAL_UNHOMED_SPEED:
    case DV_REFUSAL_LEASE:
    case DV_REFUSAL_INPUT:
    case DV_REFUSAL_KIND:
        return true;
    default:
        return false;
    }
}

static bool is_robot_kind(uint8_t value)
{
    switch (value) {
    case DV_KIND_JOINTS_ONLY:
    case DV_KIND_ROTARY_DELTA:
    case DV_KIND_FIVE_BAR:
        return true;
    default:
        return false;
    }
}

bool dv_decode_hello(const uint8_t *payload, size_t size, struct dv_hello *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->version = dv_read_u16(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_hello(const struct dv_hello *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->version);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_configure(const uint8_t *payload, size_t size, struct dv_configure *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->joints = dv_read_count(&reader, DV_JOINTS_MAX);
    message->kind = dv_read_u8(&reader);
    reader.good = reader.good && is_robot_kind(message->kind);
    message->options = dv_read_u8(&reader);
    message->homing_direction = dv_read_i8(&reader);
    for (size_t i = 0; i < message->joints; i++) {
        message->joint_min[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->joint_max[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->velocity[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->acceleration[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->unhomed_velocity[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->microsteps_per_rad[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->inverted[i] = dv_read_bool(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->homing_switch[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->homing_fast[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->homing_slow[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->homing_backoff[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->homing_max_travel[i] = dv_read_u32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->ready[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->base_radius[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->effector_radius[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->upper_arm[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->forearm[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->azimuth[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < 3; i++) {
        message->tool_offset[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < 2; i++) {
        message->workspace_x[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < 2; i++) {
        message->workspace_y[i] = dv_read_f32(&reader);
    }
    for (size_t i = 0; i < 2; i++) {
        message->workspace_z[i] = dv_read_f32(&reader);
    }
    message->workspace_radius = dv_read_f32(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_configure(const struct dv_configure *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    size_t joints = dv_write_count(&writer, message->joints, DV_JOINTS_MAX);
    writer.good = writer.good && is_robot_kind(message->kind);
    dv_write_u8(&writer, message->kind);
    dv_write_u8(&writer, message->options);
    dv_write_i8(&writer, message->homing_direction);
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->joint_min[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->joint_max[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->velocity[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->acceleration[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->unhomed_velocity[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->microsteps_per_rad[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_bool(&writer, message->inverted[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->homing_switch[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->homing_fast[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->homing_slow[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->homing_backoff[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_u32(&writer, message->homing_max_travel[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->ready[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->base_radius[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->effector_radius[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->upper_arm[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->forearm[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_f32(&writer, message->azimuth[i]);
    }
    for (size_t i = 0; i < 3; i++) {
        dv_write_f32(&writer, message->tool_offset[i]);
    }
    for (size_t i = 0; i < 2; i++) {
        dv_write_f32(&writer, message->workspace_x[i]);
    }
    for (size_t i = 0; i < 2; i++) {
        dv_write_f32(&writer, message->workspace_y[i]);
    }
    for (size_t i = 0; i < 2; i++) {
        dv_write_f32(&writer, message->workspace_z[i]);
    }
    dv_write_f32(&writer, message->workspace_radius);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_enable(const uint8_t *payload, size_t size, struct dv_enable *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->on = dv_read_bool(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_enable(const struct dv_enable *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_bool(&writer, message->on);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_home(const uint8_t *payload, size_t size)
{
    (void)payload;
    return size == 0;
}

bool dv_decode_arm(const uint8_t *payload, size_t size, struct dv_arm *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->epoch = dv_read_u16(&reader);
    message->t_start = dv_read_u32(&reader);
    message->joints = dv_read_count(&reader, DV_JOINTS_MAX);
    for (size_t i = 0; i < message->joints; i++) {
        message->counts[i] = dv_read_i32(&reader);
    }
    return dv_read_all(&reader);
}

size_t dv_encode_arm(const struct dv_arm *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->epoch);
    dv_write_u32(&writer, message->t_start);
    size_t joints = dv_write_count(&writer, message->joints, DV_JOINTS_MAX);
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->counts[i]);
    }
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_segment(const uint8_t *payload, size_t size, struct dv_segment *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->epoch = dv_read_u16(&reader);
    message->index = dv_read_u16(&reader);
    message->t_end = dv_read_u32(&reader);
    message->duration = dv_read_u32(&reader);
    message->seen = dv_read_u32(&reader);
    message->joints = dv_read_count(&reader, DV_JOINTS_MAX);
    for (size_t i = 0; i < message->joints; i++) {
        message->p[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < message->joints; i++) {
        message->v[i] = dv_read_i32(&reader);
    }
    return dv_read_all(&reader);
}

size_t dv_encode_segment(const struct dv_segment *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->epoch);
    dv_write_u16(&writer, message->index);
    dv_write_u32(&writer, message->t_end);
    dv_write_u32(&writer, message->duration);
    dv_write_u32(&writer, message->seen);
    size_t joints = dv_write_count(&writer, message->joints, DV_JOINTS_MAX);
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->p[i]);
    }
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->v[i]);
    }
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_cartesian_segment(const uint8_t *payload, size_t size, struct dv_cartesian_segment *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->epoch = dv_read_u16(&reader);
    message->index = dv_read_u16(&reader);
    message->t_end = dv_read_u32(&reader);
    message->duration = dv_read_u32(&reader);
    message->seen = dv_read_u32(&reader);
    for (size_t i = 0; i < 3; i++) {
        message->p[i] = dv_read_i32(&reader);
    }
    for (size_t i = 0; i < 3; i++) {
        message->v[i] = dv_read_i32(&reader);
    }
    return dv_read_all(&reader);
}

size_t dv_encode_cartesian_segment(const struct dv_cartesian_segment *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->epoch);
    dv_write_u16(&writer, message->index);
    dv_write_u32(&writer, message->t_end);
    dv_write_u32(&writer, message->duration);
    dv_write_u32(&writer, message->seen);
    for (size_t i = 0; i < 3; i++) {
        dv_write_i32(&writer, message->p[i]);
    }
    for (size_t i = 0; i < 3; i++) {
        dv_write_i32(&writer, message->v[i]);
    }
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_keep(const uint8_t *payload, size_t size, struct dv_keep *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->seen = dv_read_u32(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_keep(const struct dv_keep *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u32(&writer, message->seen);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_stop(const uint8_t *payload, size_t size)
{
    (void)payload;
    return size == 0;
}

bool dv_decode_estop(const uint8_t *payload, size_t size)
{
    (void)payload;
    return size == 0;
}

bool dv_decode_reset(const uint8_t *payload, size_t size)
{
    (void)payload;
    return size == 0;
}

bool dv_decode_tool(const uint8_t *payload, size_t size, struct dv_tool *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->on = dv_read_bool(&reader);
    message->servo_angle = dv_read_f32(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_tool(const struct dv_tool *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_bool(&writer, message->on);
    dv_write_f32(&writer, message->servo_angle);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_hello_reply(const uint8_t *payload, size_t size, struct dv_hello_reply *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->version = dv_read_u16(&reader);
    dv_read_text(&reader, message->board, sizeof message->board);
    dv_read_text(&reader, message->build, sizeof message->build);
    message->joints = dv_read_u8(&reader);
    message->tick_hz = dv_read_u32(&reader);
    message->queue_places = dv_read_u16(&reader);
    message->boot = dv_read_u32(&reader);
    message->last_epoch = dv_read_u16(&reader);
    message->homed = dv_read_bool(&reader);
    message->configuration = dv_read_u32(&reader);
    message->last_stop = dv_read_u8(&reader);
    reader.good = reader.good && is_stop_cause(message->last_stop);
    return dv_read_all(&reader);
}

size_t dv_encode_hello_reply(const struct dv_hello_reply *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->version);
    dv_write_text(&writer, message->board, sizeof message->board);
    dv_write_text(&writer, message->build, sizeof message->build);
    dv_write_u8(&writer, message->joints);
    dv_write_u32(&writer, message->tick_hz);
    dv_write_u16(&writer, message->queue_places);
    dv_write_u32(&writer, message->boot);
    dv_write_u16(&writer, message->last_epoch);
    dv_write_bool(&writer, message->homed);
    dv_write_u32(&writer, message->configuration);
    writer.good = writer.good && is_stop_cause(message->last_stop);
    dv_write_u8(&writer, message->last_stop);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_configured(const uint8_t *payload, size_t size, struct dv_configured *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->configuration = dv_read_u32(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_configured(const struct dv_configured *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u32(&writer, message->configuration);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_refused(const uint8_t *payload, size_t size, struct dv_refused *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->command = dv_read_u8(&reader);
    reader.good = reader.good && is_type(message->command);
    message->reason = dv_read_u8(&reader);
    reader.good = reader.good && is_refusal(message->reason);
    message->joint = dv_read_optional_u8(&reader);
    message->index = dv_read_optional_u16(&reader);
    return dv_read_all(&reader);
}

size_t dv_encode_refused(const struct dv_refused *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    writer.good = writer.good && is_type(message->command);
    dv_write_u8(&writer, message->command);
    writer.good = writer.good && is_refusal(message->reason);
    dv_write_u8(&writer, message->reason);
    dv_write_optional_u8(&writer, message->joint);
    dv_write_optional_u16(&writer, message->index);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_done(const uint8_t *payload, size_t size, struct dv_done *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->command = dv_read_u8(&reader);
    reader.good = reader.good && is_type(message->command);
    return dv_read_all(&reader);
}

size_t dv_encode_done(const struct dv_done *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    writer.good = writer.good && is_type(message->command);
    dv_write_u8(&writer, message->command);
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_telemetry(const uint8_t *payload, size_t size, struct dv_telemetry *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->now = dv_read_u32(&reader);
    message->state = dv_read_u8(&reader);
    reader.good = reader.good && is_board_state(message->state);
    message->fault = dv_read_u8(&reader);
    reader.good = reader.good && is_fault(message->fault);
    message->epoch = dv_read_u16(&reader);
    message->last_index = dv_read_u16(&reader);
    message->t_queue_end = dv_read_u32(&reader);
    message->free = dv_read_u16(&reader);
    message->inputs = dv_read_u8(&reader);
    message->flags = dv_read_u8(&reader);
    message->joints = dv_read_count(&reader, DV_JOINTS_MAX);
    for (size_t i = 0; i < message->joints; i++) {
        message->counts[i] = dv_read_i32(&reader);
    }
    return dv_read_all(&reader);
}

size_t dv_encode_telemetry(const struct dv_telemetry *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u32(&writer, message->now);
    writer.good = writer.good && is_board_state(message->state);
    dv_write_u8(&writer, message->state);
    writer.good = writer.good && is_fault(message->fault);
    dv_write_u8(&writer, message->fault);
    dv_write_u16(&writer, message->epoch);
    dv_write_u16(&writer, message->last_index);
    dv_write_u32(&writer, message->t_queue_end);
    dv_write_u16(&writer, message->free);
    dv_write_u8(&writer, message->inputs);
    dv_write_u8(&writer, message->flags);
    size_t joints = dv_write_count(&writer, message->joints, DV_JOINTS_MAX);
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->counts[i]);
    }
    return writer.good ? room - writer.left : 0;
}

bool dv_decode_stopped(const uint8_t *payload, size_t size, struct dv_stopped *message)
{
    struct dv_reader reader = {payload, size, true};
    memset(message, 0, sizeof *message);
    message->epoch = dv_read_u16(&reader);
    message->cause = dv_read_u8(&reader);
    reader.good = reader.good && is_stop_cause(message->cause);
    message->now = dv_read_u32(&reader);
    message->joints = dv_read_count(&reader, DV_JOINTS_MAX);
    for (size_t i = 0; i < message->joints; i++) {
        message->counts[i] = dv_read_i32(&reader);
    }
    return dv_read_all(&reader);
}

size_t dv_encode_stopped(const struct dv_stopped *message, uint8_t *payload, size_t room)
{
    struct dv_writer writer = {payload, room, true};
    dv_write_u16(&writer, message->epoch);
    writer.good = writer.good && is_stop_cause(message->cause);
    dv_write_u8(&writer, message->cause);
    dv_write_u32(&writer, message->now);
    size_t joints = dv_write_count(&writer, message->joints, DV_JOINTS_MAX);
    for (size_t i = 0; i < joints; i++) {
        dv_write_i32(&writer, message->counts[i]);
    }
    return writer.good ? room - writer.left : 0;
}
