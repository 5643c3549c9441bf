/* What the steppers follow: positions as functions of the tick, in integers.
 *
 * Positions are in Q32 (2^-32 microsteps), velocities in 2^-16 microsteps per millisecond. A path
 * begins at its tick 0 and ends at its tick `ticks`. Up to DV_TICK_HZ_MAX, within the speeds of a
 * configuration that was taken, every product fits 64 bits.
 */
#ifndef DV_PATHS_H
#define DV_PATHS_H

#include "messages.h"
#include "parameters.h"
#include "real_cubic.h"

#include <stdbool.h>
#include <stdint.h>

/* Where segments meet, in units of the messages: of the joints, or Cartesian (tip.h). */
struct dv_knot {
    int32_t p[DV_JOINTS_MAX]; /* 2^-10 microsteps */
    int32_t v[DV_JOINTS_MAX]; /* 2^-16 microsteps/ms */
    bool cartesian;
};

enum dv_path_kind {
    DV_PATH_NONE, /* nothing is followed */
    DV_PATH_CUBIC,
    DV_PATH_RAMP,
    DV_PATH_TIP,
};

/* The cubic between two knots, in Hermite form over u = tick / ticks (Q30):
 * p = p0 + d (3u² - 2u³) + m0 (u - 2u² + u³) + m1 (u³ - u²), where d = p1 - p0 and m = v · ticks.
 */
struct dv_cubic {
    int64_t p0;       /* Q32 */
    int64_t distance; /* d, 2^-10 microsteps */
    int64_t m0, m1;   /* 2^-16 microsteps */
    int32_t v_end;
};

/* From one velocity to another, evenly. */
struct dv_ramp {
    int64_t p0; /* Q32 */
    int32_t v_start, v_end;
};

/* The cubic between two Cartesian knots, in single precision: mm, s. */
struct dv_tip_motion {
    float start[3];
    struct dv_real_cubic axis[3];
};

struct dv_tip_path {
    const struct dv_parameters *parameters;
    struct dv_tip_motion motion;
    int64_t held[DV_JOINTS_MAX]; /* Q32: where the joints beyond the arms stand */
};

struct dv_path {
    uint8_t kind; /* enum dv_path_kind */
    uint8_t joints;
    bool rests; /* it ends at rest */
    uint32_t ticks;
    uint32_t ticks_per_ms;
    union {
        struct dv_cubic cubic[DV_JOINTS_MAX];
        struct dv_ramp ramp[DV_JOINTS_MAX];
        struct dv_tip_path tip;
    } by;
};

void dv_path_cubic(struct dv_path *path, uint8_t joints, const struct dv_knot *start,
                   const struct dv_knot *end, uint32_t ticks, uint32_t ticks_per_ms);

void dv_path_ramp(struct dv_path *path, uint8_t joints, const int64_t *start,
                  const int32_t *v_start, const int32_t *v_end, uint32_t ticks,
                  uint32_t ticks_per_ms);

/* Between Cartesian knots. */
void dv_path_tip(struct dv_path *path, const struct dv_parameters *parameters,
                 const struct dv_knot *start, const struct dv_knot *end, uint32_t ticks,
                 uint32_t ticks_per_ms);

/* Where the joints are at a tick of the path. False: they cannot be there. */
bool dv_path_positions(const struct dv_path *path, uint32_t tick, int64_t *positions);

bool dv_path_velocities(const struct dv_path *path, uint32_t tick, int32_t *velocities);

#endif
