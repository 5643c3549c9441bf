#include "outbox.h"

void dv_outbox_init(struct dv_outbox *outbox)
{
    outbox->first = 0;
    outbox->count = 0;
}

void dv_outbox_put(struct dv_outbox *outbox, const struct dv_out_frame *frame, bool is_telemetry)
{
    int most = is_telemetry ? DV_OUTBOX_PLACES / 2 : DV_OUTBOX_PLACES;
    if (outbox->count < most) {
        outbox->frames[(outbox->first + outbox->count) % DV_OUTBOX_PLACES] = *frame;
        outbox->count++;
    }
}

const struct dv_out_frame *dv_outbox_first(const struct dv_outbox *outbox)
{
    return outbox->count == 0 ? NULL : &outbox->frames[outbox->first];
}

void dv_outbox_remove_first(struct dv_outbox *outbox)
{
    outbox->first = (uint8_t)((outbox->first + 1) % DV_OUTBOX_PLACES);
    outbox->count--;
}
