/* What the drivers' inputs need, in ns, and that a tick gives it: STEP is high and low for a tick at
 * least, and DIR is set a tick before STEP rises and held for one after.
 */
#ifndef STEP_TIMING_H
#define STEP_TIMING_H

#include BOARD_HEADER

/* TI, DRV8825 data sheet (SLVSA73F), 6.6 timing requirements. */
#define DRV8825_STEP_HIGH_NS 1900
#define DRV8825_STEP_LOW_NS 1900
#define DRV8825_DIR_SETUP_NS 650
#define DRV8825_DIR_HOLD_NS 650

/* Trinamic, TMC2209 data sheet, 13.1 timing: with its internal clock of 12 MHz. */
#define TMC2209_STEP_HIGH_NS 100
#define TMC2209_STEP_LOW_NS 100
#define TMC2209_DIR_SETUP_NS 20
#define TMC2209_DIR_HOLD_NS 20

#define TICK_NS (1000000000 / (int)TICK_HZ)

_Static_assert(TICK_NS >= DRV8825_STEP_HIGH_NS && TICK_NS >= TMC2209_STEP_HIGH_NS, "STEP high");
_Static_assert(TICK_NS >= DRV8825_STEP_LOW_NS && TICK_NS >= TMC2209_STEP_LOW_NS, "STEP low");
_Static_assert(TICK_NS >= DRV8825_DIR_SETUP_NS && TICK_NS >= TMC2209_DIR_SETUP_NS, "DIR set-up");
_Static_assert(TICK_NS >= DRV8825_DIR_HOLD_NS && TICK_NS >= TMC2209_DIR_HOLD_NS, "DIR hold");

#endif
