/* The bounded queue of segments, and when each of them really starts. */
#ifndef DV_QUEUE_H
#define DV_QUEUE_H

#include "paths.h"
#include "rules.h"

#include <stdbool.h>
#include <stdint.h>

/* A segment of either kind. */
struct dv_span {
    uint8_t type; /* enum dv_type */
    uint16_t epoch, index;
    uint32_t t_end, duration, seen; /* ticks */
    struct dv_knot knot; /* where it leads */
};

struct dv_entry {
    struct dv_knot origin, knot; /* where it begins and where it leads */
    uint32_t start;              /* board tick */
    uint32_t duration;           /* ticks */
};

/* Segments of one epoch in order. */
struct dv_queue {
    uint32_t end;         /* the tick at which the last one is really reached */
    uint32_t nominal_end; /* the host's own time for it */
    uint16_t next_index;
    struct dv_knot knot; /* where the last one leads */
    uint8_t first, count;
    struct dv_entry entries[DV_QUEUE_PLACES];
};

/* A new epoch at rest at these counts; `planned` as below. */
void dv_queue_open(struct dv_queue *queue, uint8_t joints, const int32_t *counts,
                   uint32_t t_start, uint32_t planned);

/* Only while it has room. `origin` is the queue's knot as the span speaks of it. Nothing begins before
 * `planned`, the tick until which motion is planned. `idle`: nothing moves and nothing waits to,
 * maybe since long ago.
 */
void dv_queue_push(struct dv_queue *queue, const struct dv_span *span,
                   const struct dv_knot *origin, uint32_t planned, bool idle);

/* NULL when it is empty. Valid until the next push. */
const struct dv_entry *dv_queue_head(const struct dv_queue *queue);

void dv_queue_pop(struct dv_queue *queue);

void dv_queue_clear(struct dv_queue *queue);

bool dv_knot_rests(const struct dv_knot *knot);

#endif
