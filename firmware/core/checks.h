/* The board guards itself: what it thinks of a segment, whatever the host thought.
 *
 * Judged are exactly the motions that would run: the cubic (its end accelerations, its velocity and
 * position extrema), the brake from its end, and the tool tip at the middle and the end of both.
 * Slack: what rounding to the units of the messages can add, a thousandth of each limit, one
 * microstep, and a tenth of a millimetre, as the simulated board has it; and what single precision
 * can add, so that what the simulated board accepts is never refused here: 2e-6 of speeds and
 * accelerations, 1/16 microstep, and 10 um. Where the motion starts outside a limit, it may not
 * lead further out.
 */
#ifndef DV_CHECKS_H
#define DV_CHECKS_H

#include "messages.h"
#include "parameters.h"

#include <stdbool.h>
#include <stdint.h>


struct dv_objection {
    uint8_t reason; /* enum dv_refusal; 0: none */
    int8_t joint; /* -1: no single one */
};

/* What is wrong with the cubic from the knot (p0, v0) to the segment's, if anything. The segment
 * has an entry for each joint of the configuration, and takes 4 to 50 ms.
 */
struct dv_objection dv_check_segment(const struct dv_parameters *parameters, uint32_t tick_hz,
                                     const int32_t *p0, const int32_t *v0,
                                     const struct dv_segment *segment, bool homed);

#endif
