/* The black STM32F407VET6 board ("F407VET6 mini", with sockets for a flash chip, an SD card and a
 * display). STEP, DIR and the inputs use pins of its display socket, which stays empty.
 */
#ifndef BOARD_H
#define BOARD_H

#include "silicon.h"

#define BOARD_NAME "F407VET6"

/* D2: lit by a low level. */
#define PIN_LED (PORT_A | 6u)
#define LED_LIT_BY 0u

#endif
