/* The one brake: all joints along the tangent, to rest, in one common time. */
#ifndef DV_BRAKE_H
#define DV_BRAKE_H

#include "parameters.h"
#include "paths.h"

/* The brake from here: T = max |v_i| / a_i, at least 1 ms. */
void dv_brake(struct dv_path *path, const struct dv_parameters *parameters,
              const int64_t *positions, const int32_t *velocities, uint32_t ticks_per_ms);

#endif
