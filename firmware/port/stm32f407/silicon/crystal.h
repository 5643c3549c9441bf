/* The board's crystal (HSE). Boards of one kind are sold with different ones, so it is measured. */
#ifndef CRYSTAL_H
#define CRYSTAL_H

#include <stdbool.h>
#include <stdint.h>

bool crystal_start(void);
void crystal_stop(void);

/* In kHz, against the internal oscillator (HSI), which must be the system's clock: as near as that is
 * to its 16 MHz. 0: it could not be measured. Only while the crystal runs.
 */
uint32_t crystal_khz(void);

#endif
