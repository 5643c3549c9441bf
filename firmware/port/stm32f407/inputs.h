/* The end stops and the e-stop input. */
#ifndef INPUTS_H
#define INPUTS_H

#include <stdint.h>

void inputs_start(void);

/* As enum dv_level. */
uint8_t inputs_read(void);

#endif
