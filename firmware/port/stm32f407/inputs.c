#include "inputs.h"

#include BOARD_HEADER
#include "gpio.h"
#include "hal.h"

static const struct {
    uint8_t pin;
    uint8_t level;
} INPUTS[] = {
    {PIN_SWITCH_1, DV_LEVEL_SWITCH_0},
    {PIN_SWITCH_2, DV_LEVEL_SWITCH_0 << 1},
    {PIN_SWITCH_3, DV_LEVEL_SWITCH_0 << 2},
    {PIN_SWITCH_4, DV_LEVEL_SWITCH_0 << 3},
    {PIN_ESTOP, DV_LEVEL_ESTOP},
};
#define COUNT (sizeof INPUTS / sizeof INPUTS[0])

void inputs_start(void)
{
    for (unsigned i = 0; i < COUNT; i++) {
        pin_pull(INPUTS[i].pin, GPIO_PULL_UP);
        pin_mode(INPUTS[i].pin, GPIO_INPUT);
    }
}

uint8_t inputs_read(void)
{
    uint8_t levels = 0;
    for (unsigned i = 0; i < COUNT; i++) {
        if (pin_read(INPUTS[i].pin)) {
            levels = (uint8_t)(levels | INPUTS[i].level);
        }
    }
    return levels;
}
