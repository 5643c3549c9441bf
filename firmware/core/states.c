#include "states.h"

#include "messages.h"

#define STATES (DV_STATE_FAULT + 1)
#define TO(state) (DV_STATE_##state + 1) /* what the table does not have is 0 */

static const uint8_t transitions[STATES][DV_EVENTS] = {
    [DV_STATE_DISABLED] = {
        [DV_EVENT_ENABLE] = TO(HALTED),
        [DV_EVENT_DISABLE] = TO(DISABLED),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_HALTED] = {
        [DV_EVENT_ENABLE] = TO(HALTED),
        [DV_EVENT_DISABLE] = TO(DISABLED),
        [DV_EVENT_ARM] = TO(ARMED),
        [DV_EVENT_HOME] = TO(HOMING),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_ARMED] = {
        [DV_EVENT_ENABLE] = TO(ARMED),
        [DV_EVENT_DISABLE] = TO(DISABLED),
        [DV_EVENT_ARM] = TO(ARMED),
        [DV_EVENT_HALT] = TO(HALTED),
        [DV_EVENT_HOME] = TO(HOMING),
        [DV_EVENT_BRAKE] = TO(BRAKING),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_BRAKING] = {
        [DV_EVENT_RESTED] = TO(HALTED),
        [DV_EVENT_RESTED_DISABLE] = TO(DISABLED),
        [DV_EVENT_RESTED_FAULT] = TO(FAULT),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_HOMING] = {
        [DV_EVENT_HOMED] = TO(HALTED),
        [DV_EVENT_BRAKE] = TO(BRAKING),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_ESTOP] = {
        [DV_EVENT_RESET] = TO(DISABLED),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
    [DV_STATE_FAULT] = {
        [DV_EVENT_RESET] = TO(DISABLED),
        [DV_EVENT_ESTOP] = TO(ESTOP),
    },
};

int dv_state_after(uint8_t state, enum dv_event event)
{
    return (int)transitions[state][event] - 1;
}

bool dv_state_is_powered(uint8_t state)
{
    return state != DV_STATE_DISABLED && state != DV_STATE_ESTOP;
}
