/* The guard of Cartesian segments: what the board thinks of the joints' motion that follows.
 *
 * The tip's cubic is looked at where it begins, where it ends, and at even times between, at most
 * DV_APART_MS apart: there the joints' positions, speeds and accelerations are exact, between them
 * they may be a little beyond. The brake from the end is judged as for joint segments. Slack: as
 * there (limits.h), what rounding to the units of the messages adds being a matter of the pose;
 * single precision adds a ten thousandth to speeds and accelerations.
 */
#ifndef DV_TIP_CHECKS_H
#define DV_TIP_CHECKS_H

#include "limits.h"
#include "parameters.h"
#include "paths.h"

#include <stdint.h>

#define DV_APART_MS 2u

/* What is wrong with the way of `ticks` (4 to 50 ms) between two Cartesian knots, if anything; of a
 * homed robot with arms, in an epoch that has this leeway.
 */
struct dv_objection dv_check_tip_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                         const struct dv_knot *start, const struct dv_knot *end,
                                         uint32_t ticks, const struct dv_leeway *leeway);

#endif
