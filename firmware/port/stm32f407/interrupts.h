/* What interrupts what: the lower the number, the sooner. The processor has 16 levels, in the top
 * four bits of a byte.
 */
#ifndef INTERRUPTS_H
#define INTERRUPTS_H

#include "regs.h"

#define PRIORITY_SERIAL (0u << 4)  /* a byte comes every 11 us, and the hardware holds one */
#define PRIORITY_STEP (1u << 4)    /* each tick; a few us late is only jitter */
#define PRIORITY_CONTROL (2u << 4) /* each ms, with a ms of time */
#define PRIORITY_BENCH (3u << 4)   /* in the emulator */

static inline void interrupt_enable(uint32_t irq, uint32_t priority)
{
    NVIC_IPR(irq) = (uint8_t)priority;
    NVIC_ISER(irq) = NVIC_IRQ_BIT(irq);
}

/* Holds back all interrupts of this priority and below, until `interrupts_release` is given what
 * this returned. May be nested.
 */
static inline uint32_t interrupts_hold(uint32_t priority)
{
    uint32_t before;
    __asm volatile("mrs %0, basepri" : "=r"(before)::"memory");
    __asm volatile("msr basepri_max, %0" ::"r"(priority) : "memory");
    return before;
}

static inline void interrupts_release(uint32_t before)
{
    __asm volatile("msr basepri, %0" ::"r"(before) : "memory");
}

#endif
