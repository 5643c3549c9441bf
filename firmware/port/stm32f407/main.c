/* Starts everything; then the main loop goes round, once between any two interrupts at most. */
#include "board.h"
#include "clock.h"
#include "gpio.h"
#include "hal_stm32f407.h"
#include "inputs.h"
#include "led.h"
#include "serial.h"
#include "steps.h"
#include "tool.h"
#include "watchdog.h"

static struct dv_board board;

int main(void)
{
    struct clock clock = clock_start();
    gpio_start();
    steps_prepare();
    inputs_start();
    tool_start(&clock);
    led_start(&clock);
    dv_board_init(&board, hal_start(&clock), 0);
    serial_start(&clock);
    steps_start(&board, &clock);
    watchdog_start();
    for (;;) {
        dv_board_poll(&board);
        io_idle();
    }
}
