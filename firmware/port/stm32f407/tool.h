/* The tool: a pin that is on or off, and a servo's pulses, 50 a second, made by a timer. */
#ifndef TOOL_H
#define TOOL_H

#include "clock.h"

#include <stdbool.h>

/* The pin is low and the servo has no pulses, so that it does not move. */
void tool_start(const struct clock *clock);

/* `angle` in rad; beyond what a servo has, it goes to its end. */
void tool_write(bool on, float angle);

/* Off. Also after a fault, so it relies on nothing. */
void tool_off(void);

#endif
