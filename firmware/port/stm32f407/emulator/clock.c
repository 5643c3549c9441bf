/* QEMU has no RCC: its clocks run as they are. */
#include "clock.h"

#include BOARD_HEADER

struct clock clock_start(void)
{
    return (struct clock){CLOCK_FINE, QEMU_TIMER_HZ, QEMU_TIMER_HZ, TICK_HZ};
}
