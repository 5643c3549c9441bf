/* Judges cases from standard input, to the end; writes how many there were, how many
 * configurations were taken, and how many segments accepted.
 */
#include "checks.h"
#include "kinematics.h"
#include "rules.h"
#include "tip_checks.h"

#include <stdio.h>

struct test_case {
    struct dv_configure configure;
    uint32_t tick_hz;
    struct dv_knot start, end;
    uint32_t ticks;
    float pose[3];
};

int main(void)
{
    struct test_case now;
    unsigned judged = 0, taken = 0, accepted = 0;
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        struct dv_parameters parameters;
        float result[3];
        judged++;
        if (!dv_parameters_from(&parameters, &now.configure, now.tick_hz)) {
            continue;
        }
        taken++;
        uint64_t milliticks = (uint64_t)now.ticks * 1000;
        bool lasts = milliticks >= (uint64_t)now.tick_hz * DV_SEGMENT_MIN_MS
            && milliticks <= (uint64_t)now.tick_hz * DV_SEGMENT_MAX_MS;
        struct dv_leeway leeway = dv_leeway_at(&parameters, &now.start, true);
        dv_leeway_come_to(&leeway, &parameters, &now.end);
        dv_forward(&parameters, now.pose, result);
        dv_inverse(&parameters, now.pose, result);
        if (parameters.arms > 0 && lasts) {
            dv_check_tip_segment(&parameters, now.tick_hz, &now.start, &now.end, now.ticks,
                                 &leeway);
        }
        for (int homed = 0; homed < 2 && lasts; homed++) {
            struct dv_objection found = dv_check_segment(&parameters, now.tick_hz, &now.start,
                                                         &now.end, now.ticks, homed == 1,
                                                         leeway.outside);
            accepted += found.reason == 0;
        }
    }
    printf("%u %u %u\n", judged, taken, accepted);
    return 0;
}
