/* The tick: TIM2's interrupt steps, and pends control (PendSV) where a piece begins. The timer is
 * always on, and all of the board's time comes from it.
 */
#ifndef STEPS_H
#define STEPS_H

#include "board.h"
#include "clock.h"

/* STEP and DIR of all joints, low. */
void steps_prepare(void);

/* From now on `board` is stepped and its control runs. */
void steps_start(struct dv_board *board, const struct clock *clock);

#endif
