/* How the board judges motions: the slack that its limits have, and the workspace of its tip.
 *
 * Slack, as the simulated board has it: what rounding to the units of the messages can add, a
 * thousandth of speeds and accelerations, one microstep, a tenth of a millimetre. And what single
 * precision can add, so that what the simulated board accepts is never refused here.
 */
#ifndef DV_LIMITS_H
#define DV_LIMITS_H

#include "messages.h"
#include "parameters.h"
#include "paths.h"

#include <stdbool.h>
#include <stdint.h>

#define DV_RELATIVE_SLACK 1e-3f     /* of speeds and accelerations */
#define DV_JOINT_SLACK 1024         /* 2^-10 microsteps: one microstep */
#define DV_TIP_SLACK 0.1f           /* mm */
#define DV_POSITION_ERROR 0.0625f   /* microsteps, of single precision */
#define DV_TIP_ERROR 0.01f          /* mm, of single precision */

struct dv_objection {
    uint8_t reason; /* enum dv_refusal; 0: none */
    int8_t joint;   /* -1: no single one */
};

static inline struct dv_objection dv_object(enum dv_refusal reason, int joint)
{
    return (struct dv_objection){(uint8_t)reason, (int8_t)joint};
}

static inline struct dv_objection dv_no_objection(void)
{
    return (struct dv_objection){0, -1};
}

/* Where a joint may be that began at `start` (2^-10 microsteps): in its limits, or where that lies
 * outside, no further out. As integers, and in microsteps from there.
 */
struct dv_range {
    int64_t least, most;
    float low, high;
};

struct dv_range dv_joint_range(const struct dv_parameters *parameters, int joint, int32_t start);

/* Where the brake ends that begins at `positions` with `speeds` (microsteps, s). */
void dv_brake_ends(const struct dv_parameters *parameters, int joints, const float *positions,
                   const float *speeds, float *ends);

/* How far out an epoch may lead that began outside its limits: no further than it began, the tip no
 * further than it has come in since. It is kept for the whole epoch, so that no number of segments
 * can creep outwards by the slack of each.
 */
struct dv_leeway {
    int32_t began[DV_JOINTS_MAX]; /* 2^-10 microsteps */
    float outside;                /* mm, of the tip; 0 inside its workspace */
};

/* Of an epoch that begins at rest at `knot`, of the joints. Until it is homed, no tip is known. */
struct dv_leeway dv_leeway_at(const struct dv_parameters *parameters, const struct dv_knot *knot,
                              bool homed);

/* A segment leads to `knot`. */
void dv_leeway_come_to(struct dv_leeway *leeway, const struct dv_parameters *parameters,
                       const struct dv_knot *knot);

/* How far the tool tip is outside its workspace (mm). */
float dv_tip_outside(const struct dv_parameters *parameters, const float tip[3]);

/* The same where the arms are, in microsteps; infinite where there is no tip. */
float dv_arms_outside(const struct dv_parameters *parameters, const float *microsteps);

#endif
