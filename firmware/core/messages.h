/* Made from deltaviz/link/wire/protocol.toml by `python -m deltaviz.link.wire.generate`. */
#ifndef DV_MESSAGES_H
#define DV_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DV_PROTOCOL_VERSION 1
#define DV_JOINTS_MAX 4
#define DV_PAYLOAD_MAX 512 /* bytes */
#define DV_COMMAND_REPEAT_MS 50
#define DV_TEXT_MAX 31 /* characters, without the NUL */

enum dv_type {
    DV_HELLO = 0x01,
    DV_CONFIGURE = 0x02,
    DV_ENABLE = 0x03,
    DV_HOME = 0x04,
    DV_ARM = 0x05,
    DV_SEGMENT = 0x06,
    DV_CARTESIAN_SEGMENT = 0x0C,
    DV_KEEP = 0x07,
    DV_STOP = 0x08,
    DV_ESTOP = 0x09,
    DV_RESET = 0x0A,
    DV_TOOL = 0x0B,
    DV_HELLO_REPLY = 0x81,
    DV_CONFIGURED = 0x82,
    DV_REFUSED = 0x83,
    DV_DONE = 0x84,
    DV_TELEMETRY = 0x85,
    DV_STOPPED = 0x86,
};

enum dv_board_state {
    DV_STATE_DISABLED = 0,
    DV_STATE_HALTED = 1,
    DV_STATE_ARMED = 2,
    DV_STATE_BRAKING = 3,
    DV_STATE_HOMING = 4,
    DV_STATE_ESTOP = 5,
    DV_STATE_FAULT = 6,
};

enum dv_stop_cause {
    DV_CAUSE_NONE = 0,
    DV_CAUSE_HOST_STOP = 1,
    DV_CAUSE_UNDERRUN = 2,
    DV_CAUSE_LEASE = 3,
    DV_CAUSE_BAD_SEGMENT = 4,
    DV_CAUSE_LIMIT_SWITCH = 5,
    DV_CAUSE_ESTOP = 6,
    DV_CAUSE_DISABLED = 7,
    DV_CAUSE_HOMED = 8,
    DV_CAUSE_HOMING_FAILED = 9,
    DV_CAUSE_BOOT = 10,
};

enum dv_fault {
    DV_FAULT_NONE = 0,
    DV_FAULT_LIMIT_SWITCH = 1,
    DV_FAULT_HOMING_NO_SWITCH = 2,
    DV_FAULT_HOMING_SWITCH_STUCK = 3,
    DV_FAULT_ESTOP_INPUT = 4,
    DV_FAULT_CONFIGURATION = 5,
    DV_FAULT_LATE = 6,
};

enum dv_refusal {
    DV_REFUSAL_STATE = 1,
    DV_REFUSAL_EPOCH = 2,
    DV_REFUSAL_COUNTS = 3,
    DV_REFUSAL_MOVING = 4,
    DV_REFUSAL_INDEX = 5,
    DV_REFUSAL_TIME = 6,
    DV_REFUSAL_QUEUE_FULL = 7,
    DV_REFUSAL_JOINT_LIMIT = 8,
    DV_REFUSAL_VELOCITY = 9,
    DV_REFUSAL_ACCELERATION = 10,
    DV_REFUSAL_BRAKE = 11,
    DV_REFUSAL_WORKSPACE = 12,
    DV_REFUSAL_CONFIGURATION = 13,
    DV_REFUSAL_VERSION = 14,
    DV_REFUSAL_UNHOMED_SPEED = 15,
    DV_REFUSAL_LEASE = 16,
    DV_REFUSAL_INPUT = 17,
    DV_REFUSAL_KIND = 18,
};

enum dv_inputs {
    DV_INPUT_NONE = 0,
    DV_INPUT_ESTOP = 1,
    DV_INPUT_SWITCH_0 = 16,
    DV_INPUT_SWITCH_1 = 32,
    DV_INPUT_SWITCH_2 = 64,
    DV_INPUT_SWITCH_3 = 128,
};

enum dv_telemetry_flags {
    DV_FLAG_NONE = 0,
    DV_FLAG_HOMED = 1,
    DV_FLAG_MOVING = 2,
    DV_FLAG_LEASE_ALIVE = 4,
    DV_FLAG_CONFIGURED = 8,
};

enum dv_robot_kind {
    DV_KIND_JOINTS_ONLY = 0,
    DV_KIND_ROTARY_DELTA = 1,
    DV_KIND_FIVE_BAR = 2,
};

enum dv_options {
    DV_OPTION_NONE = 0,
    DV_OPTION_HOMING_TOGETHER = 1,
    DV_OPTION_SWITCH_ACTIVE_OPEN = 2,
    DV_OPTION_ENABLE_ACTIVE_HIGH = 4,
};

/* The longest payloads, in bytes. */
#define DV_HELLO_SIZE_MAX 2
#define DV_CONFIGURE_SIZE_MAX 320
#define DV_ENABLE_SIZE_MAX 1
#define DV_ARM_SIZE_MAX 23
#define DV_SEGMENT_SIZE_MAX 49
#define DV_CARTESIAN_SEGMENT_SIZE_MAX 40
#define DV_KEEP_SIZE_MAX 4
#define DV_TOOL_SIZE_MAX 5
#define DV_HELLO_REPLY_SIZE_MAX 85
#define DV_CONFIGURED_SIZE_MAX 4
#define DV_REFUSED_SIZE_MAX 5
#define DV_DONE_SIZE_MAX 1
#define DV_TELEMETRY_SIZE_MAX 35
#define DV_STOPPED_SIZE_MAX 24

struct dv_hello {
    uint16_t version;
};

struct dv_configure {
    uint8_t joints;
    uint8_t kind; /* enum dv_robot_kind */
    uint8_t options; /* enum dv_options */
    int8_t homing_direction; /* +1 towards positive angles, -1 towards negative */
    int32_t joint_min[DV_JOINTS_MAX]; /* 2^-10 microsteps */
    int32_t joint_max[DV_JOINTS_MAX]; /* 2^-10 microsteps */
    uint32_t velocity[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
    uint32_t acceleration[DV_JOINTS_MAX]; /* 2^-24 microsteps/ms² */
    uint32_t unhomed_velocity[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
    float microsteps_per_rad[DV_JOINTS_MAX];
    bool inverted[DV_JOINTS_MAX]; /* positive angles at the low level of DIR */
    int32_t homing_switch[DV_JOINTS_MAX]; /* microsteps */
    uint32_t homing_fast[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
    uint32_t homing_slow[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
    uint32_t homing_backoff[DV_JOINTS_MAX]; /* microsteps */
    uint32_t homing_max_travel[DV_JOINTS_MAX]; /* microsteps */
    int32_t ready[DV_JOINTS_MAX]; /* microsteps */
    float base_radius[DV_JOINTS_MAX]; /* mm; centre to motor axis; of a five-bar, half its base */
    /* mm; centre to the forearm's joint; of a five-bar, half its platform */
    float effector_radius[DV_JOINTS_MAX];
    float upper_arm[DV_JOINTS_MAX]; /* mm */
    float forearm[DV_JOINTS_MAX]; /* mm */
    float azimuth[DV_JOINTS_MAX]; /* rad; of a five-bar: 0 */
    float tool_offset[3]; /* mm */
    float workspace_x[2]; /* mm; infinite: unbounded */
    float workspace_y[2]; /* mm */
    float workspace_z[2]; /* mm */
    float workspace_radius; /* mm */
};

struct dv_enable {
    bool on;
};

struct dv_arm {
    uint16_t epoch;
    uint32_t t_start; /* ticks */
    uint8_t joints;
    int32_t counts[DV_JOINTS_MAX]; /* microsteps */
};

struct dv_segment {
    uint16_t epoch;
    uint16_t index;
    uint32_t t_end; /* ticks */
    uint32_t duration; /* ticks */
    uint32_t seen; /* ticks */
    uint8_t joints;
    int32_t p[DV_JOINTS_MAX]; /* 2^-10 microsteps */
    int32_t v[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
};

struct dv_cartesian_segment {
    uint16_t epoch;
    uint16_t index;
    uint32_t t_end; /* ticks */
    uint32_t duration; /* ticks */
    uint32_t seen; /* ticks */
    int32_t p[3]; /* 2^-8 um */
    int32_t v[3]; /* 2^-16 um/ms */
};

struct dv_keep {
    uint32_t seen; /* ticks */
};

struct dv_tool {
    bool on;
    float servo_angle; /* rad */
};

struct dv_hello_reply {
    uint16_t version;
    char board[DV_TEXT_MAX + 1];
    char build[DV_TEXT_MAX + 1];
    uint8_t joints; /* 0 until it is configured */
    uint32_t tick_hz; /* Hz */
    uint16_t queue_places;
    uint32_t boot; /* names this power-up */
    uint16_t last_epoch;
    bool homed;
    uint32_t configuration; /* CRC-32 of the payload of Configure, 0 until then */
    uint8_t last_stop; /* enum dv_stop_cause */
};

struct dv_configured {
    uint32_t configuration;
};

struct dv_refused {
    uint8_t command;
    uint8_t reason; /* enum dv_refusal */
    int16_t joint;
    int32_t index; /* of a segment */
};

struct dv_done {
    uint8_t command;
};

struct dv_telemetry {
    uint32_t now; /* ticks */
    uint8_t state; /* enum dv_board_state */
    uint8_t fault; /* enum dv_fault */
    uint16_t epoch;
    uint16_t last_index;
    uint32_t t_queue_end; /* ticks */
    uint16_t free; /* free places in the queue */
    uint8_t inputs; /* enum dv_inputs */
    uint8_t flags; /* enum dv_telemetry_flags */
    uint8_t joints;
    int32_t counts[DV_JOINTS_MAX]; /* microsteps */
};

struct dv_stopped {
    uint16_t epoch;
    uint8_t cause; /* enum dv_stop_cause */
    uint32_t now; /* ticks */
    uint8_t joints;
    int32_t counts[DV_JOINTS_MAX]; /* microsteps */
};

/* False: malformed. Entries beyond `joints` are zero. What is -1 stands for "none". */
bool dv_decode_hello(const uint8_t *payload, size_t size, struct dv_hello *message);
bool dv_decode_configure(const uint8_t *payload, size_t size, struct dv_configure *message);
bool dv_decode_enable(const uint8_t *payload, size_t size, struct dv_enable *message);
bool dv_decode_home(const uint8_t *payload, size_t size);
bool dv_decode_arm(const uint8_t *payload, size_t size, struct dv_arm *message);
bool dv_decode_segment(const uint8_t *payload, size_t size, struct dv_segment *message);
bool dv_decode_cartesian_segment(const uint8_t *payload, size_t size, struct dv_cartesian_segment *message);
bool dv_decode_keep(const uint8_t *payload, size_t size, struct dv_keep *message);
bool dv_decode_stop(const uint8_t *payload, size_t size);
bool dv_decode_estop(const uint8_t *payload, size_t size);
bool dv_decode_reset(const uint8_t *payload, size_t size);
bool dv_decode_tool(const uint8_t *payload, size_t size, struct dv_tool *message);
bool dv_decode_hello_reply(const uint8_t *payload, size_t size, struct dv_hello_reply *message);
bool dv_decode_configured(const uint8_t *payload, size_t size, struct dv_configured *message);
bool dv_decode_refused(const uint8_t *payload, size_t size, struct dv_refused *message);
bool dv_decode_done(const uint8_t *payload, size_t size, struct dv_done *message);
bool dv_decode_telemetry(const uint8_t *payload, size_t size, struct dv_telemetry *message);
bool dv_decode_stopped(const uint8_t *payload, size_t size, struct dv_stopped *message);

/* The length of the payload; 0: no room, or values that the message cannot carry. */
size_t dv_encode_hello(const struct dv_hello *message, uint8_t *payload, size_t room);
size_t dv_encode_configure(const struct dv_configure *message, uint8_t *payload, size_t room);
size_t dv_encode_enable(const struct dv_enable *message, uint8_t *payload, size_t room);
size_t dv_encode_arm(const struct dv_arm *message, uint8_t *payload, size_t room);
size_t dv_encode_segment(const struct dv_segment *message, uint8_t *payload, size_t room);
size_t dv_encode_cartesian_segment(const struct dv_cartesian_segment *message, uint8_t *payload, size_t room);
size_t dv_encode_keep(const struct dv_keep *message, uint8_t *payload, size_t room);
size_t dv_encode_tool(const struct dv_tool *message, uint8_t *payload, size_t room);
size_t dv_encode_hello_reply(const struct dv_hello_reply *message, uint8_t *payload, size_t room);
size_t dv_encode_configured(const struct dv_configured *message, uint8_t *payload, size_t room);
size_t dv_encode_refused(const struct dv_refused *message, uint8_t *payload, size_t room);
size_t dv_encode_done(const struct dv_done *message, uint8_t *payload, size_t room);
size_t dv_encode_telemetry(const struct dv_telemetry *message, uint8_t *payload, size_t room);
size_t dv_encode_stopped(const struct dv_stopped *message, uint8_t *payload, size_t room);

#endif
