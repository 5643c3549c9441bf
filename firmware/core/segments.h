/* What the board does with a segment, of joints or Cartesian: whether it is its turn, whether it is
 * well, and a place in the queue. What is wrong with one brakes; what is out of turn is passed over.
 */
#ifndef DV_SEGMENTS_H
#define DV_SEGMENTS_H

#include "board.h"
#include "messages.h"
#include "turn.h"

/* What the board is at, for those who judge. */
struct dv_situation dv_situation_of(const struct dv_board *board);

void dv_run_segment(struct dv_board *board, const struct dv_segment *message);
void dv_run_cartesian_segment(struct dv_board *board, const struct dv_cartesian_segment *message);

#endif
