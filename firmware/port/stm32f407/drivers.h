/* The enable input of all drivers. Which level enables them is the robot's, so until it is known
 * the pin floats, and a resistor at the drivers keeps them off.
 */
#ifndef DRIVERS_H
#define DRIVERS_H

#include <stdbool.h>

void drivers_switch(bool on, bool active_high);

/* As at power-up. Also after a fault, so it relies on nothing. */
void drivers_float(void);

#endif
