/* The lower tier: positions that advance evenly from tick to tick, and the pulses they give.
 *
 * Time is cut into pieces of 1 ms. In each, every position gains its increment each tick, and where
 * the piece ends it is the piece's target itself: what the division dropped does not add up. The
 * count is the whole number nearest to the position, and a step leaves when the steps that have
 * left differ from it. STEP is high for one tick, never in two successive ticks, and DIR changes a
 * tick before STEP rises; so what has left is the count of at most two ticks ago.
 *
 * Budget of dv_stepper_tick: 5 us at 200 kHz, 840 cycles at 168 MHz, of which it may use less than
 * half with three axes. Integers only, no division, no loop but that over the joints.
 *
 * The other functions are called with the step interrupt held. Positions there are in Q32: 2^-32
 * microsteps.
 */
#ifndef DV_STEPPER_H
#define DV_STEPPER_H

#include "messages.h"

#include <stdbool.h>
#include <stdint.h>

/* What dv_stepper_tick returns: a level for each joint's pins, and whether a piece has begun. */
#define DV_PINS_STEP 0x000Fu      /* bit i: joint i */
#define DV_PINS_DIR 0x00F0u       /* bit 4 + i */
#define DV_PINS_DIR_SHIFT 4
#define DV_PINS_BOUNDARY 0x0100u  /* the control interrupt has to run */

struct dv_axis {
    int64_t position;  /* Q32, plus one half: so its whole part is the count */
    int64_t increment; /* Q32 per tick */
    int64_t target;    /* as `position`: where it is when the piece ends */
    int32_t emitted;   /* microsteps that have left, those backward taken off */
};

struct dv_piece {
    int64_t target[DV_JOINTS_MAX];    /* as in dv_axis */
    int64_t increment[DV_JOINTS_MAX]; /* as in dv_axis */
};

struct dv_stepper {
    uint32_t now;         /* ticks since power-up, wrapping */
    uint32_t boundary;    /* the tick at which the present piece began */
    uint32_t left;        /* ticks until it ends */
    uint32_t piece_ticks; /* of every piece */
    uint32_t joints;      /* 0 until the board is configured */
    uint32_t high;        /* bit i: STEP of joint i is high */
    uint32_t forward;     /* bit i: joint i is set to turn forward */
    uint32_t inverted;    /* bit i: forward is the low level of joint i's DIR */
    struct dv_axis axis[DV_JOINTS_MAX];
    struct dv_piece next; /* the piece after this one */
    bool ready;           /* `next` is planned */
    bool late;            /* a piece began that was not planned: it stands still */
};

/* The step interrupt. What comes back is put on the pins at once: STEP low, DIR, STEP high. */
uint32_t dv_stepper_tick(struct dv_stepper *stepper);

/* No joints yet; the first piece begins at tick `now`. */
void dv_stepper_init(struct dv_stepper *stepper, uint32_t tick_hz, uint32_t now);

/* All positions are 0. `inverted` as in the struct. */
void dv_stepper_use(struct dv_stepper *stepper, uint32_t joints, uint32_t inverted);

/* The piece after the present one, from where that one ends. */
void dv_stepper_plan(struct dv_stepper *stepper, const int64_t *target, const int64_t *increment);

/* At rest: says where it is. No step leaves. */
void dv_stepper_place(struct dv_stepper *stepper, const int64_t *position);

/* It stays where it is, at once. */
void dv_stepper_cut(struct dv_stepper *stepper);

/* The position at this tick. */
int64_t dv_stepper_position(const struct dv_stepper *stepper, uint32_t joint);

#endif
