#include "five_bar.h"

#include <math.h>

/* Elbows closer than this, in squared forearms, are all rounding. */
static const float UNDETERMINED = 1e-6f;

/* Where two circles about the elbow centres meet, below the line from the left one to the right:
 * with d = D2 - D1, n = (-d_z, d_x), w = (d² + l1² - l2²) / 2 d²: P = D1 + w d - n √(l1² / d² - w²).
 */
bool dv_five_bar_meet(const struct dv_parameters *parameters, const struct dv_vector *elbows,
                      struct dv_vector *centre)
{
    float l1 = parameters->limb[0].forearm, l2 = parameters->limb[1].forearm;
    struct dv_vector d = dv_minus(elbows[1], elbows[0]);
    float square = dv_dot(d, d);
    if (!(square > UNDETERMINED * l1 * l1)) {
        return false;
    }
    float w = (square + dv_square_less(l1, l2)) / (2.0f * square);
    float height_square = l1 * l1 / square - w * w;
    if (!(height_square >= 0.0f)) {
        return false;
    }
    struct dv_vector below = {d.z, 0.0f, -d.x};
    struct dv_vector from_first = dv_combined(w, d, sqrtf(height_square), below);
    *centre = dv_combined(1.0f, elbows[0], 1.0f, from_first);
    return true;
}

bool dv_five_bar_works(const struct dv_vector *forearms)
{
    return forearms[0].x * forearms[1].z - forearms[0].z * forearms[1].x < 0.0f;
}
