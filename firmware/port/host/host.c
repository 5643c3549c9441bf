#include "host.h"

#include "integers.h"

#include <stdlib.h>
#include <string.h>

#define SENT_MAX 16384 /* bytes between two calls of dv_host_take */

struct dv_host {
    struct dv_hal hal;
    struct dv_board board;
    const uint8_t *arrived; /* what is being fed */
    size_t arrived_size;
    uint8_t sent[SENT_MAX];
    size_t sent_size, write_room;
    uint8_t levels;
    bool locked, held;
    uint32_t meanwhile; /* pieces */
    bool drivers_known, drivers_on, drivers_active_high;
    bool tool_on;
    float servo_angle;
    uint32_t fed;
    int64_t travelled[DV_JOINTS_MAX];
};

static void require(bool condition)
{
    if (!condition) {
        abort();
    }
}

static size_t read_bytes(void *context, uint8_t *bytes, size_t most)
{
    struct dv_host *host = context;
    size_t size = host->arrived_size < most ? host->arrived_size : most;
    if (size > 0) {
        memcpy(bytes, host->arrived, size);
        host->arrived += size;
        host->arrived_size -= size;
    }
    return size;
}

static bool write_frame(void *context, const uint8_t *frame, size_t size)
{
    struct dv_host *host = context;
    size_t room = host->write_room < SENT_MAX ? host->write_room : SENT_MAX;
    if (host->sent_size + size > room) {
        return false;
    }
    memcpy(host->sent + host->sent_size, frame, size);
    host->sent_size += size;
    return true;
}

static void put_drivers(void *context, bool on, bool active_high)
{
    struct dv_host *host = context;
    host->drivers_known = true;
    host->drivers_on = on;
    host->drivers_active_high = active_high;
}

static uint8_t read_inputs(void *context)
{
    const struct dv_host *host = context;
    return host->levels;
}

static void put_tool(void *context, bool on, float servo_angle)
{
    struct dv_host *host = context;
    host->tool_on = on;
    host->servo_angle = servo_angle;
}

static void lock_control(void *context)
{
    struct dv_host *host = context;
    require(!host->locked);
    host->locked = true;
}

static void unlock_control(void *context)
{
    struct dv_host *host = context;
    require(host->locked);
    host->locked = false;
    for (; host->meanwhile > 0; host->meanwhile--) {
        dv_host_run(host, UINT32_MAX, NULL);
        dv_board_piece(&host->board);
    }
}

static void hold_steps(void *context)
{
    struct dv_host *host = context;
    require(!host->held);
    host->held = true;
}

static void release_steps(void *context)
{
    struct dv_host *host = context;
    require(host->held);
    host->held = false;
}

static void feed_watchdog(void *context)
{
    struct dv_host *host = context;
    host->fed++;
}

struct dv_host *dv_host_new(uint32_t tick_hz, uint32_t now, uint16_t last_epoch, uint32_t boot)
{
    struct dv_host *host = calloc(1, sizeof *host);
    if (host == NULL) {
        return NULL;
    }
    host->write_room = SENT_MAX;
    host->hal = (struct dv_hal){
        .context = host,
        .board = "host",
        .build = "native",
        .boot = boot,
        .tick_hz = tick_hz,
        .read = read_bytes,
        .write = write_frame,
        .drivers = put_drivers,
        .inputs = read_inputs,
        .tool = put_tool,
        .lock_control = lock_control,
        .unlock_control = unlock_control,
        .hold_steps = hold_steps,
        .release_steps = release_steps,
        .feed_watchdog = feed_watchdog,
    };
    dv_board_init(&host->board, &host->hal, now);
    host->board.control.epoch = last_epoch;
    return host;
}

void dv_host_free(struct dv_host *host)
{
    free(host);
}

void dv_host_assume_homed(struct dv_host *host)
{
    struct dv_control *control = &host->board.control;
    int64_t ready[DV_JOINTS_MAX] = {0};
    for (int i = 0; i < control->parameters.configure.joints; i++) {
        ready[i] = dv_whole(control->parameters.configure.ready[i]);
    }
    lock_control(host);
    dv_drive_place(&control->drive, ready);
    control->homed = true;
    dv_control_change(control, DV_EVENT_ENABLE);
    dv_control_report(control);
    unlock_control(host);
    dv_board_poll(&host->board);
}

void dv_host_feed(struct dv_host *host, const uint8_t *bytes, size_t size)
{
    host->arrived = bytes;
    host->arrived_size = size;
    do {
        dv_board_poll(&host->board);
    } while (host->arrived_size > 0);
}

size_t dv_host_take(struct dv_host *host, uint8_t *bytes, size_t room)
{
    dv_board_poll(&host->board); /* what found no room before */
    size_t size = host->sent_size < room ? host->sent_size : room;
    memcpy(bytes, host->sent, size);
    memmove(host->sent, host->sent + size, host->sent_size - size);
    host->sent_size -= size;
    return size;
}

void dv_host_set_write_room(struct dv_host *host, size_t room)
{
    host->write_room = room;
}

uint32_t dv_host_run(struct dv_host *host, uint32_t ticks, uint16_t *pins)
{
    struct dv_stepper *stepper = &host->board.stepper;
    uint32_t passed = 0, now = 0;
    while (passed < ticks && (now & DV_PINS_BOUNDARY) == 0) {
        int32_t before[DV_JOINTS_MAX];
        for (uint32_t i = 0; i < stepper->joints; i++) {
            before[i] = dv_nearest(dv_stepper_position(stepper, i));
        }
        now = dv_stepper_tick(stepper);
        for (uint32_t i = 0; i < stepper->joints; i++) {
            host->travelled[i] += dv_nearest(dv_stepper_position(stepper, i)) - before[i];
        }
        if (pins != NULL) {
            pins[passed] = (uint16_t)now;
        }
        passed++;
    }
    return passed;
}

void dv_host_set_inputs(struct dv_host *host, uint8_t levels)
{
    host->levels = levels;
}

void dv_host_set_meanwhile(struct dv_host *host, uint32_t pieces)
{
    host->meanwhile = pieces;
}

void dv_host_control(struct dv_host *host)
{
    require(!host->locked);
    dv_board_piece(&host->board);
    dv_board_poll(&host->board);
}

void dv_host_look(const struct dv_host *host, struct dv_host_view *view)
{
    const struct dv_control *control = &host->board.control;
    const struct dv_stepper *stepper = &host->board.stepper;
    *view = (struct dv_host_view){
        .now = stepper->now,
        .configuration = control->configuration,
        .state = control->state,
        .fault = control->fault,
        .cause = control->cause,
        .joints = control->parameters.configure.joints,
        .homed = control->homed,
        .moving = dv_control_moves(control),
        .drivers_known = host->drivers_known,
        .drivers_on = host->drivers_on,
        .drivers_active_high = host->drivers_active_high,
        .tool_on = host->tool_on,
        .servo_angle = host->servo_angle,
        .fed = host->fed,
    };
    memcpy(view->travelled, host->travelled, sizeof view->travelled);
    for (uint32_t i = 0; i < stepper->joints; i++) {
        view->positions[i] = dv_stepper_position(stepper, i);
        view->counts[i] = dv_nearest(view->positions[i]);
        view->emitted[i] = stepper->axis[i].emitted;
    }
}
