/* hal.h for this port. */
#ifndef HAL_STM32F407_H
#define HAL_STM32F407_H

#include "clock.h"
#include "hal.h"

/* Valid for ever. */
const struct dv_hal *hal_start(const struct clock *clock);

#endif
