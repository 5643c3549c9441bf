/* A board: what it does with messages and with time. Everything that it knows is in its struct.
 *
 * dv_board_piece    the control interrupt, once for each piece: looks at the inputs, judges the lease,
 *                   notices rest, goes on with homing, plans the piece after the one that begins.
 *                   Budget: 1 ms less what the step interrupt takes; late, the drivers go off.
 * dv_board_poll     the main loop: takes bytes, carries out what is whole, sends what there is to say.
 *                   Control is kept out while one message is carried out, but for the motion of a
 *                   segment, which is judged while control goes on.
 * dv_stepper_tick   on `stepper`: the step interrupt.
 */
#ifndef DV_BOARD_H
#define DV_BOARD_H

#include "control.h"
#include "endpoint.h"
#include "hal.h"
#include "messages.h"
#include "reports.h"
#include "stepper.h"

#include <stdbool.h>
#include <stdint.h>

struct dv_board {
    const struct dv_hal *hal;
    struct dv_stepper stepper;
    struct dv_endpoint endpoint;
    struct dv_reports reports;
    struct dv_control control;
    bool speaks;     /* the host's version */
    uint32_t pieces; /* that control has seen begin */
    uint32_t fed;    /* at which of them the watchdog was fed */
};

/* As at power-up, at tick `now`: disabled, unhomed, not configured. `hal` has to outlive the board. */
void dv_board_init(struct dv_board *board, const struct dv_hal *hal, uint32_t now);

void dv_board_piece(struct dv_board *board);

void dv_board_poll(struct dv_board *board);

#endif
