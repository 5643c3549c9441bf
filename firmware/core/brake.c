#include "brake.h"

#include "integers.h"

void dv_brake(struct dv_path *path, const struct dv_parameters *parameters,
              const int64_t *positions, const int32_t *velocities, uint32_t ticks_per_ms)
{
    static const int32_t REST[DV_JOINTS_MAX] = {0};
    uint8_t joints = parameters->configure.joints;
    int64_t ticks = ticks_per_ms;
    for (int i = 0; i < joints; i++) {
        int64_t acceleration = parameters->accelerations[i];
        int64_t speed = dv_size_of(velocities[i]) * 65536 * ticks_per_ms; /* 2^-32 microsteps/ms */
        ticks = dv_larger(ticks, (speed + acceleration - 1) / acceleration);
    }
    dv_path_ramp(path, joints, positions, velocities, REST, (uint32_t)ticks, ticks_per_ms);
}
