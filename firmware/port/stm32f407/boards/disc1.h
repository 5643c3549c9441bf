/* STM32F407G-DISC1, ST's discovery board (MB997). */
#ifndef BOARD_H
#define BOARD_H

#include "silicon.h"

#define BOARD_NAME "STM32F407G-DISC1"

/* LD6, blue: lit by a high level. */
#define PIN_LED (PORT_D | 15u)
#define LED_LIT_BY 1u

#endif
