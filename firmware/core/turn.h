/* Whether it is a message's turn: epochs, indices, times. The motion itself is judged in checks. */
#ifndef DV_TURN_H
#define DV_TURN_H

#include "messages.h"
#include "queue.h"

#include <stdbool.h>
#include <stdint.h>

/* Beyond, a count is no int32_t of 2^-10 microsteps. */
#define DV_KNOT_COUNTS ((int32_t)1 << 21)
/* So far, the longest homing is within the integers of its arithmetic. */
#define DV_HOMING_COUNTS ((int32_t)1 << 30)

/* What the board is at when a message comes. */
struct dv_situation {
    uint8_t state; /* enum dv_board_state */
    uint8_t joints;
    bool idle;      /* nothing moves and nothing waits to */
    uint16_t epoch; /* the last one */
    uint32_t now;   /* tick */
    uint32_t ticks_per_ms;
    int32_t counts[DV_JOINTS_MAX];
};

/* Each from -most to most - 1. */
bool dv_within(const int32_t *counts, uint8_t joints, int32_t most);

/* Why it is refused (enum dv_refusal); 0: it is not. */
uint8_t dv_arm_refusal(const struct dv_arm *arm, const struct dv_situation *at);

/* Why a segment is passed over, without harm to what runs. */
uint8_t dv_segment_refusal(const struct dv_span *span, const struct dv_situation *at,
                           const struct dv_queue *queue);

bool dv_is_well_timed(const struct dv_span *span, const struct dv_situation *at,
                      const struct dv_queue *queue);

#endif
