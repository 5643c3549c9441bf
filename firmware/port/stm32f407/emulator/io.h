/* Pins as the arms of the emulator have them: QEMU drops what is written to a pin, and reads 0. */
#ifndef IO_H
#define IO_H

#include "bench.h"
#include "pace.h"
#include "plant.h"
#include "regs.h"

static inline void io_write(uint32_t port, uint32_t set_and_clear)
{
    GPIO_BSRR(port) = set_and_clear; /* for who watches from outside */
    plant_write(port, set_and_clear);
}

static inline uint32_t io_read(uint32_t port)
{
    return plant_read(port);
}

/* QEMU never interrupts for room in the transmitter (TXE), so it is made to look for some. */
static inline void io_idle(void)
{
    bench_poll();
    if ((USART2_CR1 & USART2_CR1_TXEIE) != 0) {
        NVIC_ISPR(IRQ_USART2) = NVIC_IRQ_BIT(IRQ_USART2);
    }
    __asm volatile("wfi" ::: "memory");
}

/* A millisecond has passed. */
static inline void io_piece(void)
{
    pace_piece();
}

#endif
