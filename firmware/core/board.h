/* A board: what it does with messages and with time. Everything that it knows is in its struct.
 *
 * dv_board_piece    the control interrupt, once for each piece: looks at the inputs, judges the lease,
 *                   notices rest, goes on with homing, plans the piece after the one that begins.
 *                   Budget: 1 ms less what the step interrupt takes; late, the drivers go off.
 * dv_board_poll     the main loop: takes bytes, carries out what is whole, sends what there is to say.
 *                   Control is kept out while one message is carried out.
 * dv_stepper_tick   on `stepper`: the step interrupt.
 */
#ifndef DV_BOARD_H
#define DV_BOARD_H

#include "hal.h"
#include "messages.h"
#include "stepper.h"

#define DV_OUTBOX_FRAME_MAX 96 /* bytes of the longest frame that a board sends */

struct dv_board {
    const struct dv_hal *hal;
    struct dv_stepper stepper;
    /* The rest is the core's own. */
};

/* As at power-up: disabled, unhomed, not configured. `hal` has to outlive the board. */
void dv_board_init(struct dv_board *board, const struct dv_hal *hal);

void dv_board_piece(struct dv_board *board);

void dv_board_poll(struct dv_board *board);

#endif
