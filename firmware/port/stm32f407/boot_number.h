/* A number that names this power-up, so that a host sees that the board was away. */
#ifndef BOOT_NUMBER_H
#define BOOT_NUMBER_H

#include <stdint.h>

/* In the emulator its bench says it, together with what hangs on the board. */
uint32_t boot_number(void);

#endif
