#include "led.h"

#include BOARD_HEADER
#include "gpio.h"

#define MS 500u
#define ERROR_MS 100u

static uint32_t period, left; /* ms */
static bool lit;

static void show(void)
{
    pin_write(PIN_LED, lit == (LED_LIT_BY == 1u));
}

void led_start(const struct clock *clock)
{
    period = left = clock->error == CLOCK_FINE ? MS : ERROR_MS;
    show();
    pin_mode(PIN_LED, GPIO_OUTPUT);
}

void led_piece(void)
{
    left--;
    if (left == 0) {
        left = period;
        lit = !lit;
        show();
    }
}
