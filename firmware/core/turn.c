#include "turn.h"

#include "integers.h"

static int64_t ticks(const struct dv_situation *at, int32_t ms)
{
    return (int64_t)ms * at->ticks_per_ms;
}

static bool is_near(uint32_t start, const struct dv_situation *at)
{
    int64_t ahead = dv_since(start, at->now);
    return ticks(at, -DV_LATE_MS) <= ahead && ahead <= ticks(at, DV_AHEAD_MS);
}

bool dv_within(const int32_t *counts, uint8_t joints, int32_t most)
{
    for (int i = 0; i < joints; i++) {
        if (counts[i] < -most || counts[i] >= most) {
            return false;
        }
    }
    return true;
}

static bool are_ours(const struct dv_arm *arm, const struct dv_situation *at)
{
    for (int i = 0; i < at->joints; i++) {
        if (arm->counts[i] != at->counts[i]) {
            return false;
        }
    }
    return arm->joints == at->joints && dv_within(at->counts, at->joints, DV_KNOT_COUNTS);
}

uint8_t dv_arm_refusal(const struct dv_arm *arm, const struct dv_situation *at)
{
    if (!at->idle) {
        return DV_REFUSAL_MOVING;
    }
    if (dv_since16(arm->epoch, at->epoch) <= 0) {
        return DV_REFUSAL_EPOCH;
    }
    if (!are_ours(arm, at)) {
        return DV_REFUSAL_COUNTS;
    }
    return is_near(arm->t_start, at) ? 0 : DV_REFUSAL_TIME;
}

uint8_t dv_segment_refusal(const struct dv_span *span, const struct dv_situation *at,
                           const struct dv_queue *queue)
{
    if (at->state != DV_STATE_ARMED) {
        return DV_REFUSAL_STATE;
    }
    if (span->epoch != at->epoch) {
        return DV_REFUSAL_EPOCH;
    }
    if (span->index != queue->next_index) {
        return DV_REFUSAL_INDEX;
    }
    return queue->count == DV_QUEUE_PLACES ? DV_REFUSAL_QUEUE_FULL : 0;
}

bool dv_is_well_timed(const struct dv_span *span, const struct dv_situation *at,
                      const struct dv_queue *queue)
{
    uint32_t start = span->t_end - span->duration;
    if (span->duration < ticks(at, DV_SEGMENT_MIN_MS)
        || span->duration > ticks(at, DV_SEGMENT_MAX_MS)) {
        return false;
    }
    if (at->idle) {
        return is_near(start, at);
    }
    if (!dv_knot_rests(&queue->knot)) {
        return start == queue->nominal_end;
    }
    return dv_since(start, queue->nominal_end) >= 0
        && dv_since(start, queue->end) <= ticks(at, DV_AHEAD_MS);
}
