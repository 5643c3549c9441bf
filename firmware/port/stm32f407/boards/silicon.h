/* What all boards with a real STM32F407 have in common. */
#ifndef SILICON_H
#define SILICON_H

#include "pins.h"

#define TICK_HZ 200000u      /* step ticks: 100 kHz of steps, 840 cycles each at 168 MHz */
#define TICK_HZ_SLOW 10000u  /* at 16 MHz, to speak and not to move: 1600 cycles */
#define BAUD 921600u         /* 42 MHz / 46: 0.93 % slow, of the 2 % or so that a byte bears */

/* The timer counts from 0 to what it is given here. */
#define TICK_RELOAD(timer_hz, tick_hz) ((timer_hz) / (tick_hz) - 1u)

#endif
