/* Waits for what the clock's hardware has to do. Each of them ends. */
#ifndef WAIT_H
#define WAIT_H

#include <stdbool.h>
#include <stdint.h>

#define WAIT_TRIES 200000u /* some 100 ms at 16 MHz; a crystal starts in about 2, the PLL in 0.3 */

/* Whether `mask` of it read `value` in time. */
static inline bool wait_for(volatile const uint32_t *where, uint32_t mask, uint32_t value)
{
    for (uint32_t tries = WAIT_TRIES; tries > 0; tries--) {
        if ((*where & mask) == value) {
            return true;
        }
    }
    return false;
}

#endif
