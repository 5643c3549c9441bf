/* What the board does with a message: decoded, judged, carried out or refused. */
#ifndef DV_COMMANDS_H
#define DV_COMMANDS_H

#include "board.h"
#include "frames.h"

/* What is no well-formed message from a host is passed over. Control is kept out meanwhile, but while
 * the motion of a segment is judged.
 */
void dv_carry_out(struct dv_board *board, const struct dv_frame *frame);

#endif
