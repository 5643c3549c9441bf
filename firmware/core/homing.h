/* Homing: fast to the switch, back off, slow to the switch, then to the ready pose.
 *
 * One joint after another or all together. Where the slow approach met the switch is the switch's
 * angle; the counts follow from it. Velocities change by no more than the joint's acceleration.
 */
#ifndef DV_HOMING_H
#define DV_HOMING_H

#include "parameters.h"
#include "paths.h"

#include <stdbool.h>
#include <stdint.h>

enum dv_homing_phase {
    DV_HOMING_BEGIN,
    DV_HOMING_FAST, /* to the switch */
    DV_HOMING_BACK,
    DV_HOMING_SLOW, /* to the switch */
    DV_HOMING_STOP, /* at the switch */
    DV_HOMING_DONE,
};

/* Positions in Q32, velocities in 2^-16 microsteps/ms. */
struct dv_joint_homing {
    uint8_t phase; /* enum dv_homing_phase */
    uint8_t fault; /* enum dv_fault */
    bool released; /* the switch is, since `released_at` */
    int32_t velocity; /* where the plan ends */
    int64_t mark;     /* where the phase began */
    int64_t released_at;
    int64_t trigger; /* where the slow approach met the switch */
};

struct dv_homing {
    const struct dv_parameters *parameters;
    uint32_t ticks_per_ms;
    struct dv_joint_homing joint[DV_JOINTS_MAX];
};

void dv_homing_begin(struct dv_homing *homing, const struct dv_parameters *parameters,
                     uint32_t ticks_per_ms);

/* Every joint stands at its reference, or will where the plan ends. */
bool dv_homing_is_done(const struct dv_homing *homing);

/* The first one's (enum dv_fault). */
uint8_t dv_homing_fault(const struct dv_homing *homing);

/* The millisecond after the plan, which ends at `planned`; `positions` are those at which the
 * switches were looked at, bit i of `pressed` is joint i's.
 */
void dv_homing_next_path(struct dv_homing *homing, struct dv_path *path, const int64_t *positions,
                         uint32_t pressed, const int64_t *planned);

/* What the positions are, now that the switches' angles are known; in whole microsteps. */
void dv_homing_refer(const struct dv_homing *homing, int64_t *positions);

/* From there: all joints in one time, none faster than its fast homing speed. */
void dv_homing_way_to_ready(const struct dv_homing *homing, struct dv_path *path,
                            const int64_t *positions);

#endif
