/* Two arms in the plane of x and z, the left one first: where their forearms meet. */
#ifndef DV_FIVE_BAR_H
#define DV_FIVE_BAR_H

#include "parameters.h"
#include "vectors.h"

#include <stdbool.h>

/* As for the rotary delta. */
bool dv_five_bar_meet(const struct dv_parameters *parameters, const struct dv_vector *elbows,
                      struct dv_vector *centre);

bool dv_five_bar_works(const struct dv_vector *forearms);

#endif
