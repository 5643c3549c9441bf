/* What the board says, as messages, and when telemetry is due. */
#ifndef DV_REPORTS_H
#define DV_REPORTS_H

#include "endpoint.h"
#include "messages.h"

#include <stdbool.h>
#include <stdint.h>

struct dv_reports {
    struct dv_endpoint *endpoint;
    uint8_t pieces; /* those until the next telemetry */
    bool changed;   /* something that telemetry tells at once */
};

void dv_reports_init(struct dv_reports *reports, struct dv_endpoint *endpoint);

void dv_say_hello_reply(struct dv_reports *reports, const struct dv_hello_reply *reply);
void dv_say_configured(struct dv_reports *reports, uint32_t configuration);
void dv_say_done(struct dv_reports *reports, uint8_t command);
void dv_say_stopped(struct dv_reports *reports, const struct dv_stopped *stopped);

/* `joint` and `index` as in the message: -1 for none. */
void dv_say_refused(struct dv_reports *reports, uint8_t command, uint8_t reason, int16_t joint,
                    int32_t index);

bool dv_telemetry_is_due(const struct dv_reports *reports);
void dv_say_telemetry(struct dv_reports *reports, const struct dv_telemetry *telemetry);

#endif
