#include "plant.h"

#include BOARD_HEADER

#define BIT(pin) (1u << ((pin)&15u))
#define PORT(pin) ((pin) >> 4)
#define PORTS 5

static const uint32_t SWITCHES[PLANT_ARMS] = {PIN_SWITCH_1, PIN_SWITCH_2, PIN_SWITCH_3,
                                              PIN_SWITCH_4};
static const uint32_t STEPS[PLANT_ARMS] = {PIN_STEP_1, PIN_STEP_2, PIN_STEP_3, PIN_STEP_4};
static const uint32_t DIRS[PLANT_ARMS] = {PIN_DIR_1, PIN_DIR_2, PIN_DIR_3, PIN_DIR_4};

struct plant plant;

static uint32_t levels[PORTS];
static bool enable_driven; /* until it is, a resistor keeps the drivers off */

bool plant_drivers_on(void)
{
    bool high = (levels[PORT(PIN_ENABLE)] & BIT(PIN_ENABLE)) != 0;
    return enable_driven && high == plant.enabled_by_high;
}

bool plant_tool_on(void)
{
    return (levels[PORT(PIN_TOOL)] & BIT(PIN_TOOL)) != 0;
}

static void step(struct plant_arm *arm, bool dir_high)
{
    int32_t next = arm->at + (dir_high != arm->inverted ? 1 : -1);
    if (arm->low <= next && next <= arm->high) {
        arm->at = next;
    }
}

void plant_write(uint32_t port, uint32_t set_and_clear)
{
    uint32_t before = levels[port], set = set_and_clear & 0xFFFFu;
    uint32_t now = (before & ~(set_and_clear >> 16)) | set;
    levels[port] = now;
    if (((set | set_and_clear >> 16) & BIT(PIN_ENABLE)) != 0 && port == PORT(PIN_ENABLE)) {
        enable_driven = true;
    }
    uint32_t rising = now & ~before;
    if (port != PORT(PIN_STEP_1) || rising == 0 || !plant_drivers_on()) {
        return;
    }
    for (int i = 0; i < plant.arms; i++) {
        if ((rising & BIT(STEPS[i])) != 0) {
            step(&plant.arm[i], (now & BIT(DIRS[i])) != 0);
        }
    }
}

static bool switch_is_open(int i)
{
    if (plant.input[i] != PLANT_FREE) {
        return plant.input[i] == PLANT_OPEN;
    }
    const struct plant_arm *arm = &plant.arm[i];
    bool pressed = (arm->at - arm->switch_at) * arm->direction >= 0;
    return i < plant.arms && pressed == arm->switch_open;
}

uint32_t plant_read(uint32_t port)
{
    uint32_t read = 0;
    for (int i = 0; i < PLANT_ARMS; i++) {
        if (PORT(SWITCHES[i]) == port && switch_is_open(i)) {
            read |= BIT(SWITCHES[i]);
        }
    }
    if (PORT(PIN_ESTOP) == port && plant.input[PLANT_ARMS] == PLANT_OPEN) {
        read |= BIT(PIN_ESTOP);
    }
    return read;
}
