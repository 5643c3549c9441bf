/* What the board needs of the hardware it runs on: one struct of functions with their context.
 *
 * Three contexts run, and none of them ever waits:
 *
 *   step interrupt      each tick: dv_stepper_tick, and nothing else. It calls nothing of this.
 *   control interrupt   lower, pended by the step interrupt where a piece (1 ms) begins:
 *                       dv_board_piece.
 *   main loop           over and over: dv_board_poll.
 *
 * Reception fills a ring in an interrupt of its own above them all; nothing here delays it.
 */
#ifndef DV_HAL_H
#define DV_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the input pins read: 1 is high, and high is an open circuit (a pull-up holds the pin). The
 * e-stop input is closed to ground while it is not pressed, so that a broken wire reads as pressed.
 */
enum dv_level {
    DV_LEVEL_SWITCH_0 = 1 << 0, /* and those of the other joints behind it */
    DV_LEVEL_SWITCHES = 0xF,
    DV_LEVEL_ESTOP = 1 << 4,
};

struct dv_hal {
    void *context; /* handed to every function */

    const char *board; /* names, of printable ASCII, at most DV_TEXT_MAX characters each */
    const char *build;
    uint32_t boot;    /* names this power-up: another than that of the last ones */
    uint32_t tick_hz; /* of the step interrupt: whole kHz, to DV_TICK_HZ_MAX; below DV_TICK_HZ_MIN the
                         board speaks, but does not move */

    /* Main loop. Takes up to `most` bytes that have arrived; how many. */
    size_t (*read)(void *context, uint8_t *bytes, size_t most);

    /* Main loop. Takes the whole frame (at most DV_OUTBOX_FRAME_MAX bytes) or, for want of room,
     * nothing: false.
     */
    bool (*write)(void *context, const uint8_t *frame, size_t size);

    /* Control interrupt and main loop. The enable pins of all drivers, which are active at the high
     * or at the low level. Never called before the board is configured: until then that level is
     * unknown, so the port leaves the pins floating, for a resistor to switch the drivers off.
     */
    void (*drivers)(void *context, bool on, bool active_high);

    /* Control interrupt. The levels of enum dv_level, as they are now. */
    uint8_t (*inputs)(void *context);

    /* Control interrupt and main loop. `servo_angle` in rad, finite; the port keeps it within what
     * its servo can do.
     */
    void (*tool)(void *context, bool on, float servo_angle);

    /* Main loop. Keeps the control interrupt waiting, at most for the 0.3 ms that the longest
     * message takes; a segment's motion, which takes longer, is judged unlocked. Never nested.
     */
    void (*lock_control)(void *context);
    void (*unlock_control)(void *context);

    /* Control interrupt and main loop. Keeps the step interrupt waiting, for some fifty
     * instructions. Never nested.
     */
    void (*hold_steps)(void *context);
    void (*release_steps)(void *context);

    /* Main loop, only while the control interrupt runs. May be called at any rate above 1 kHz. */
    void (*feed_watchdog)(void *context);
};

#endif
