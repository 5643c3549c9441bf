#include "drivers.h"

#include BOARD_HEADER
#include "gpio.h"

void drivers_switch(bool on, bool active_high)
{
    pin_write(PIN_ENABLE, on == active_high);
    pin_mode(PIN_ENABLE, GPIO_OUTPUT);
}

void drivers_float(void)
{
    pin_mode(PIN_ENABLE, GPIO_INPUT);
}
