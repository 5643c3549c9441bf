/* Three arms about a centre: where their forearms meet. The rest is the same for all arms. */
#ifndef DV_ROTARY_DELTA_H
#define DV_ROTARY_DELTA_H

#include "parameters.h"
#include "vectors.h"

#include <stdbool.h>

/* `elbows` are their centres, moved inward by the effector's radius. False where the forearms
 * cannot meet.
 */
bool dv_rotary_delta_meet(const struct dv_parameters *parameters, const struct dv_vector *elbows,
                          struct dv_vector *centre);

/* Whether forearms that meet do so below the elbows. */
bool dv_rotary_delta_works(const struct dv_parameters *parameters,
                           const struct dv_vector *forearms);

#endif
