#include "rotary_delta.h"

#include <math.h>

/* Elbow centres whose triangle is smaller than this, in squared forearms, are all rounding. */
static const float UNDETERMINED = 1e-6f;

/* Where three spheres about the elbow centres D meet, on the side of the working assembly. With
 * a = D2 - D1, b = D3 - D1, n = a × b: P = D1 + w - n √((l1² - w²) / n²),
 * w = ((|a|² + l1² - l2²) b × n + (|b|² + l1² - l3²) n × a) / 2 n².
 */
bool dv_rotary_delta_meet(const struct dv_parameters *parameters, const struct dv_vector *elbows,
                          struct dv_vector *centre)
{
    const struct dv_limb *limb = parameters->limb;
    float l1 = limb[0].forearm;
    struct dv_vector a = dv_minus(elbows[1], elbows[0]);
    struct dv_vector b = dv_minus(elbows[2], elbows[0]);
    struct dv_vector n = dv_cross(a, b);
    float square = dv_dot(n, n);
    float least = UNDETERMINED * l1 * l1;
    if (!(square > least * least)) {
        return false;
    }
    float along_a = (dv_dot(a, a) + dv_square_less(l1, limb[1].forearm)) / (2.0f * square);
    float along_b = (dv_dot(b, b) + dv_square_less(l1, limb[2].forearm)) / (2.0f * square);
    struct dv_vector w = dv_combined(along_a, dv_cross(b, n), along_b, dv_cross(n, a));
    float height_square = l1 * l1 - dv_dot(w, w);
    if (!(height_square >= 0.0f)) {
        return false;
    }
    float below = -parameters->handedness * sqrtf(height_square / square);
    struct dv_vector from_first = dv_combined(1.0f, w, below, n);
    *centre = dv_combined(1.0f, elbows[0], 1.0f, from_first);
    return true;
}

bool dv_rotary_delta_works(const struct dv_parameters *parameters,
                           const struct dv_vector *forearms)
{
    float volume = dv_dot(dv_cross(forearms[0], forearms[1]), forearms[2]);
    return parameters->handedness * volume < 0.0f;
}
