/* The board's light: it changes every half second, five times as often with a clock error. */
#ifndef LED_H
#define LED_H

#include "clock.h"

void led_start(const struct clock *clock);

/* A millisecond has passed. */
void led_piece(void);

#endif
