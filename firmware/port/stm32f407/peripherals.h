/* The clocks of peripherals: none of their registers works without. */
#ifndef PERIPHERALS_H
#define PERIPHERALS_H

#include "regs.h"

#include <stdint.h>

/* `bits` of RCC's enable register `enable`. The peripheral hears what is written to it only after two
 * cycles of AHB, or one and APB's divisor, which is 4 at most (ES0182, "Delay after an RCC peripheral
 * clock enabling"): the two reads take four, behind the barrier.
 */
static inline void peripheral_enable(volatile uint32_t *enable, uint32_t bits)
{
    *enable |= bits;
    __asm volatile("dsb" ::: "memory");
    (void)*enable;
    (void)*enable;
}

#endif
