/* The link's serial port, USART2: 8 bits, no parity, one stop bit. Received bytes are taken from
 * the hardware by an interrupt above all others, so that reception never waits for work.
 */
#ifndef SERIAL_H
#define SERIAL_H

#include "clock.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void serial_start(const struct clock *clock);

/* Up to `room` received bytes; how many. */
size_t serial_read(uint8_t *bytes, size_t room);

/* All of them on their way, or false, and none. */
bool serial_write(const uint8_t *bytes, size_t count);

#endif
