#include "queue.h"

#include "integers.h"

#include <stddef.h>
#include <string.h>

void dv_queue_open(struct dv_queue *queue, uint8_t joints, const int32_t *counts,
                   uint32_t t_start, uint32_t planned)
{
    dv_queue_clear(queue);
    queue->end = planned;
    queue->nominal_end = t_start;
    queue->next_index = 0;
    memset(&queue->knot, 0, sizeof queue->knot);
    for (int i = 0; i < joints; i++) {
        queue->knot.p[i] = counts[i] * 1024;
    }
}

static uint32_t start_from_rest(const struct dv_queue *queue, const struct dv_span *span,
                                uint32_t planned, bool idle)
{
    uint32_t nominal = span->t_end - span->duration;
    uint32_t earliest = idle || dv_since(planned, queue->end) > 0 ? planned : queue->end;
    return dv_since(nominal, earliest) > 0 ? nominal : earliest;
}

void dv_queue_push(struct dv_queue *queue, const struct dv_span *span,
                   const struct dv_knot *origin, uint32_t planned, bool idle)
{
    struct dv_entry *entry = &queue->entries[(queue->first + queue->count) % DV_QUEUE_PLACES];
    bool from_rest = dv_knot_rests(origin);
    *entry = (struct dv_entry){
        .origin = *origin,
        .knot = span->knot,
        .start = from_rest ? start_from_rest(queue, span, planned, idle) : queue->end,
        .duration = span->duration,
    };
    queue->count++;
    queue->end = entry->start + span->duration;
    queue->nominal_end = span->t_end;
    queue->next_index = (uint16_t)(span->index + 1);
    queue->knot = entry->knot;
}

const struct dv_entry *dv_queue_head(const struct dv_queue *queue)
{
    return queue->count == 0 ? NULL : &queue->entries[queue->first];
}

void dv_queue_pop(struct dv_queue *queue)
{
    queue->first = (uint8_t)((queue->first + 1) % DV_QUEUE_PLACES);
    queue->count--;
}

void dv_queue_clear(struct dv_queue *queue)
{
    queue->first = 0;
    queue->count = 0;
}

bool dv_knot_rests(const struct dv_knot *knot)
{
    for (int i = 0; i < DV_JOINTS_MAX; i++) {
        if (knot->v[i] != 0) {
            return false;
        }
    }
    return true;
}
