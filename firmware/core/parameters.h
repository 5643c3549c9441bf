/* A configuration as the board works with it: checked once, with all that follows from it. */
#ifndef DV_PARAMETERS_H
#define DV_PARAMETERS_H

#include "messages.h"

#include <stdbool.h>
#include <stdint.h>

#define DV_ARMS_MAX 3

#define DV_TICK_HZ_MAX 500000u /* up to here the arithmetic of paths and cubics fits 64 bits */

/* One arm (dv_arm is a message). */
struct dv_limb {
    float offset; /* base radius minus effector radius, mm */
    float upper_arm; /* mm */
    float forearm; /* mm */
    float cos_azimuth;
    float sin_azimuth;
};

struct dv_parameters {
    struct dv_configure configure; /* as accepted */
    int64_t accelerations[DV_JOINTS_MAX]; /* 2^-32 microsteps/ms² */
    float acceleration[DV_JOINTS_MAX]; /* microsteps/s² */
    float velocity[DV_JOINTS_MAX]; /* microsteps/s */
    float unhomed_velocity[DV_JOINTS_MAX]; /* microsteps/s, at most `velocity` */
    uint8_t arms; /* of the first joints; 0: guarded by its joints alone */
    float handedness; /* of a rotary delta, +1: counter-clockwise in their order, else -1 */
    struct dv_limb limb[DV_ARMS_MAX];
};

/* False for a configuration that makes no sense (messages.py says which do not), and for a tick out of
 * its bounds: DV_TICK_HZ_MIN to DV_TICK_HZ_MAX, whole kHz. `parameters` are then not to be used.
 */
bool dv_parameters_from(struct dv_parameters *parameters, const struct dv_configure *configure,
                        uint32_t tick_hz);

#endif
