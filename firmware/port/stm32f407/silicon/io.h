/* Pins as the hardware has them. */
#ifndef IO_H
#define IO_H

#include "regs.h"

/* As GPIO_BSRR: bits 0 to 15 set pins, 16 to 31 clear them. */
static inline void io_write(uint32_t port, uint32_t set_and_clear)
{
    GPIO_BSRR(port) = set_and_clear;
}

static inline uint32_t io_read(uint32_t port)
{
    return GPIO_IDR(port);
}

/* Between two rounds of the main loop: until the next interrupt, a tick at the latest. */
static inline void io_idle(void)
{
    __asm volatile("wfi" ::: "memory");
}

/* A millisecond has passed. */
static inline void io_piece(void)
{
}

#endif
