#include "board.h"

#include "commands.h"

#include <string.h>

#define READ_AT_ONCE 64 /* bytes */

void dv_board_init(struct dv_board *board, const struct dv_hal *hal, uint32_t now)
{
    memset(board, 0, sizeof *board);
    board->hal = hal;
    board->speaks = true;
    dv_stepper_init(&board->stepper, hal->tick_hz, now);
    dv_endpoint_init(&board->endpoint);
    dv_reports_init(&board->reports, &board->endpoint);
    dv_control_init(&board->control, hal, &board->stepper, &board->reports);
}

void dv_board_piece(struct dv_board *board)
{
    board->pieces++;
    dv_control_piece(&board->control);
}

static void receive(struct dv_board *board)
{
    uint8_t bytes[READ_AT_ONCE];
    size_t count = board->hal->read(board->hal->context, bytes, sizeof bytes);
    for (size_t i = 0; i < count; i++) {
        struct dv_frame frame;
        if (dv_frame_read(&board->endpoint.reader, bytes[i], &frame)) {
            board->hal->lock_control(board->hal->context);
            dv_carry_out(board, &frame);
            board->hal->unlock_control(board->hal->context);
        }
    }
}

/* Whether a frame was sent, so that there may be another. */
static bool send_first(struct dv_board *board)
{
    const struct dv_hal *hal = board->hal;
    struct dv_outbox *outbox = &board->endpoint.outbox;
    hal->lock_control(hal->context);
    const struct dv_out_frame *frame = dv_outbox_first(outbox);
    bool sent = frame != NULL && hal->write(hal->context, frame->bytes, frame->size);
    if (sent) {
        dv_outbox_remove_first(outbox);
    }
    hal->unlock_control(hal->context);
    return sent;
}

void dv_board_poll(struct dv_board *board)
{
    receive(board);
    while (send_first(board)) {
    }
    if (board->pieces != board->fed) {
        board->fed = board->pieces;
        board->hal->feed_watchdog(board->hal->context);
    }
}
