#include "reports.h"

#include "rules.h"

/* So that each frame has its place in the outbox. */
_Static_assert(DV_FRAME_ROOM(DV_HELLO_REPLY_SIZE_MAX) <= DV_OUTBOX_FRAME_MAX, "HelloReply");
_Static_assert(DV_FRAME_ROOM(DV_TELEMETRY_SIZE_MAX) <= DV_OUTBOX_FRAME_MAX, "Telemetry");
_Static_assert(DV_FRAME_ROOM(DV_STOPPED_SIZE_MAX) <= DV_OUTBOX_FRAME_MAX, "Stopped");

void dv_reports_init(struct dv_reports *reports, struct dv_endpoint *endpoint)
{
    *reports = (struct dv_reports){.endpoint = endpoint, .pieces = DV_TELEMETRY_MS};
}

void dv_say_hello_reply(struct dv_reports *reports, const struct dv_hello_reply *reply)
{
    uint8_t payload[DV_HELLO_REPLY_SIZE_MAX];
    size_t size = dv_encode_hello_reply(reply, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_HELLO_REPLY, DV_HELLO, payload, size);
}

void dv_say_configured(struct dv_reports *reports, uint32_t configuration)
{
    uint8_t payload[DV_CONFIGURED_SIZE_MAX];
    struct dv_configured message = {configuration};
    size_t size = dv_encode_configured(&message, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_CONFIGURED, DV_CONFIGURE, payload, size);
}

void dv_say_done(struct dv_reports *reports, uint8_t command)
{
    uint8_t payload[DV_DONE_SIZE_MAX];
    struct dv_done message = {command};
    size_t size = dv_encode_done(&message, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_DONE, command, payload, size);
}

void dv_say_refused(struct dv_reports *reports, uint8_t command, uint8_t reason, int16_t joint,
                    int32_t index)
{
    uint8_t payload[DV_REFUSED_SIZE_MAX];
    struct dv_refused message = {command, reason, joint, index == UINT16_MAX ? -1 : index};
    size_t size = dv_encode_refused(&message, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_REFUSED, command, payload, size);
}

void dv_say_stopped(struct dv_reports *reports, const struct dv_stopped *stopped)
{
    uint8_t payload[DV_STOPPED_SIZE_MAX];
    size_t size = dv_encode_stopped(stopped, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_STOPPED, 0, payload, size);
}

bool dv_telemetry_is_due(const struct dv_reports *reports)
{
    return reports->changed || reports->pieces == 0;
}

void dv_say_telemetry(struct dv_reports *reports, const struct dv_telemetry *telemetry)
{
    uint8_t payload[DV_TELEMETRY_SIZE_MAX];
    size_t size = dv_encode_telemetry(telemetry, payload, sizeof payload);
    dv_endpoint_send(reports->endpoint, DV_TELEMETRY, 0, payload, size);
    reports->changed = false;
    if (reports->pieces == 0) {
        reports->pieces = DV_TELEMETRY_MS;
    }
}
