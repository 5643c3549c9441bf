/* The board guards itself: what it thinks of a segment, whatever the host thought.
 *
 * Judged are exactly the motions that would run: the cubic (its end accelerations, its velocity and
 * position extrema), the brake from its end, and the tool tip at the middle and the end of both.
 * Single precision adds 2e-6 to speeds and accelerations, the rest of its slack is in limits.h.
 * Where an epoch began outside a limit, it may not lead further out.
 */
#ifndef DV_CHECKS_H
#define DV_CHECKS_H

#include "limits.h"
#include "parameters.h"
#include "paths.h"

#include <stdbool.h>
#include <stdint.h>

/* What is wrong with the way of `ticks` (4 to 50 ms) between two knots of the joints, if anything.
 * `outside` (mm): how far outside its workspace the tip may be (struct dv_leeway).
 */
struct dv_objection dv_check_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                     const struct dv_knot *start, const struct dv_knot *end,
                                     uint32_t ticks, bool homed, float outside);

#endif
