/* The processor's clock: brought up once, at the start. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdint.h>

/* What could not be done. The host sees the number behind the board's name. HSI has 16 MHz with an
 * error of 1 % at 25 °C, 4 % from -10 to 85 °C, -8 to +4.5 % from -40 to 105 °C (DS8626).
 */
enum clock_error {
    CLOCK_FINE = 0,
    CLOCK_NO_CRYSTAL = 1,  /* 168 MHz from the internal oscillator (HSI) */
    CLOCK_NO_PLL = 2,      /* 16 MHz from it, too slow for motion */
    CLOCK_NO_SWITCH = 3,   /* the same */
    CLOCK_ODD_CRYSTAL = 4, /* of none of the known frequencies, or not to be measured: as 1 */
};

struct clock {
    enum clock_error error;
    uint32_t serial_hz; /* what USART2 counts (APB1) */
    uint32_t timer_hz;  /* what TIM2 and TIM3 count */
    uint32_t tick_hz;   /* as many step ticks a second as this clock allows */
};

struct clock clock_start(void);

#endif
