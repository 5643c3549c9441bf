/* The independent watchdog: without being fed it resets the processor, and the drivers are off. */
#ifndef WATCHDOG_H
#define WATCHDOG_H

#include "regs.h"

#define IWDG_UNLOCK 0x5555u
#define IWDG_FEED 0xAAAAu
#define IWDG_START 0xCCCCu
#define IWDG_BY_32 3u
/* 50 ms at the nominal 32 kHz; 34 to 94 ms, as the oscillator has 17 to 47 kHz (DS8626). */
#define IWDG_RELOAD 50u

static inline void watchdog_start(void)
{
    IWDG_KR = IWDG_START;
    IWDG_KR = IWDG_UNLOCK;
    IWDG_PR = IWDG_BY_32;
    IWDG_RLR = IWDG_RELOAD;
    IWDG_KR = IWDG_FEED;
}

static inline void watchdog_feed(void)
{
    IWDG_KR = IWDG_FEED;
}

#endif
