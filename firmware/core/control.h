/* What the board does with time, and what stops it. What it is told is the concern of board.c.
 *
 * Time is cut into pieces of 1 ms, counted from power-up. Where one begins, control looks at the
 * inputs, judges the lease, notices rest, goes on with homing, and plans the piece after it.
 */
#ifndef DV_CONTROL_H
#define DV_CONTROL_H

#include "drive.h"
#include "hal.h"
#include "homing.h"
#include "lease.h"
#include "limits.h"
#include "messages.h"
#include "parameters.h"
#include "queue.h"
#include "reports.h"
#include "states.h"

#include <stdbool.h>
#include <stdint.h>

struct dv_control {
    const struct dv_hal *hal;
    struct dv_reports *reports;
    struct dv_drive drive;
    struct dv_queue queue;
    struct dv_leeway leeway; /* of the epoch */
    struct dv_lease lease;
    struct dv_homing homing;
    struct dv_parameters parameters; /* once it is configured */
    uint32_t configuration;          /* their hash; 0: it is not configured */
    uint32_t ticks_per_ms;
    uint32_t now;     /* the tick of the message or of the boundary */
    uint32_t planned; /* the tick until which motion is planned, and nothing changes it any more */
    uint8_t state;    /* enum dv_board_state */
    uint8_t fault;    /* enum dv_fault */
    uint8_t cause;    /* enum dv_stop_cause */
    bool homed;
    uint16_t epoch; /* the last one */
    struct dv_tool tool;
    bool estop_input; /* as it read at the last boundary */
    bool disable_pending;
    bool seeks;        /* homing has not found all the switches yet */
    bool looked;       /* the switches were looked at since it is configured */
    uint32_t switches; /* bit i: that of joint i was pressed at the last boundary */
};

void dv_control_init(struct dv_control *control, const struct dv_hal *hal,
                     struct dv_stepper *stepper, struct dv_reports *reports);

/* A piece has begun. */
void dv_control_piece(struct dv_control *control);

bool dv_control_is_configured(const struct dv_control *control);
bool dv_control_moves(const struct dv_control *control);
bool dv_control_is_idle(const struct dv_control *control); /* nothing waits to move, either */

/* The event must be possible in the present state. */
void dv_control_change(struct dv_control *control, enum dv_event event);

/* What commands begin; each checked before. */
void dv_control_configure(struct dv_control *control, uint32_t hash); /* `parameters` are new */
void dv_control_begin_homing(struct dv_control *control);
void dv_control_open_epoch(struct dv_control *control, const struct dv_arm *arm);
void dv_control_enqueue(struct dv_control *control, const struct dv_span *span,
                        const struct dv_knot *origin);
void dv_control_use_tool(struct dv_control *control, const struct dv_tool *tool);

/* Ends what the host had begun: by the brake if it moves. Without effect at rest. */
void dv_control_halt(struct dv_control *control, enum dv_stop_cause cause);

/* The e-stop. */
void dv_control_drivers_off(struct dv_control *control, enum dv_fault fault);

void dv_control_say_stopped(struct dv_control *control);
void dv_control_report(struct dv_control *control); /* telemetry, if it is due */

#endif
