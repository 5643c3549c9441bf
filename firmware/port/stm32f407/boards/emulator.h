/* QEMU 7.2's netduinoplus2 (an STM32F405), with arms on its pins: emulator/. */
#ifndef BOARD_H
#define BOARD_H

#include "pins.h"

#define BOARD_NAME "emulated F407"

/* QEMU needs 0.4 s for a second of 40 kHz ticks, and more than ten for one of 200 kHz. */
#ifndef TICK_HZ
#define TICK_HZ 40000u
#endif
#define BAUD 921600u /* QEMU does not care */

/* Its TIM2 counts nanoseconds, and takes as many for a period as it is given here. */
#define QEMU_TIMER_HZ 1000000000u
#define TICK_RELOAD(timer_hz, tick_hz) ((timer_hz) / (tick_hz))

#define PIN_LED (PORT_D | 15u)
#define LED_LIT_BY 1u

#endif
