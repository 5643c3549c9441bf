/* How the board calls itself in its answer to a hello. */
#ifndef BOARD_NAME_H
#define BOARD_NAME_H

#include BOARD_HEADER
#include "clock.h"
#include "messages.h"

#include <stddef.h>
#include <string.h>

#define CLOCK_ERROR ", clock error "

_Static_assert(sizeof BOARD_NAME CLOCK_ERROR <= DV_TEXT_MAX, "room for the number and the NUL");

/* With the error of its clock behind, if there is one. */
static inline void board_name(char name[DV_TEXT_MAX + 1], enum clock_error error)
{
    memset(name, 0, DV_TEXT_MAX + 1);
    if (error == CLOCK_FINE) {
        memcpy(name, BOARD_NAME, sizeof BOARD_NAME);
        return;
    }
    memcpy(name, BOARD_NAME CLOCK_ERROR, sizeof BOARD_NAME CLOCK_ERROR);
    name[sizeof BOARD_NAME CLOCK_ERROR - 1] = (char)('0' + error);
}

#endif
