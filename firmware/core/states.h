/* The states of a board (enum dv_board_state) and what leads from one to another, as data.
 *
 * What is not in the table does not happen: a command is refused with STATE.
 */
#ifndef DV_STATES_H
#define DV_STATES_H

#include <stdbool.h>
#include <stdint.h>

enum dv_event {
    DV_EVENT_ENABLE,
    DV_EVENT_DISABLE, /* at rest */
    DV_EVENT_ARM,     /* at rest */
    DV_EVENT_HALT,    /* stop, at rest */
    DV_EVENT_BRAKE,   /* stop, underrun, lease, bad segment or limit switch, while it moves */
    DV_EVENT_HOME,    /* at rest */
    DV_EVENT_HOMED,   /* at the ready pose */
    DV_EVENT_RESTED,
    DV_EVENT_RESTED_DISABLE, /* was disabled meanwhile */
    DV_EVENT_RESTED_FAULT,   /* with a fault */
    DV_EVENT_ESTOP,
    DV_EVENT_RESET,
    DV_EVENTS,
};

/* The state that an event leads to; -1: it does not happen in this one. */
int dv_state_after(uint8_t state, enum dv_event event);

/* Whether the drivers are on. */
bool dv_state_is_powered(uint8_t state);

#endif
