#include "hal_stm32f407.h"

#include "board_name.h"
#include "boot_number.h"
#include "build_name.h"
#include "drivers.h"
#include "inputs.h"
#include "interrupts.h"
#include "serial.h"
#include "tool.h"
#include "watchdog.h"

static char name[DV_TEXT_MAX + 1];
static uint32_t before_lock, before_hold; /* what to release to */

static size_t read_serial(void *context, uint8_t *bytes, size_t most)
{
    (void)context;
    return serial_read(bytes, most);
}

static bool write_serial(void *context, const uint8_t *frame, size_t size)
{
    (void)context;
    return serial_write(frame, size);
}

static void switch_drivers(void *context, bool on, bool active_high)
{
    (void)context;
    drivers_switch(on, active_high);
}

static uint8_t read_inputs(void *context)
{
    (void)context;
    return inputs_read();
}

static void write_tool(void *context, bool on, float servo_angle)
{
    (void)context;
    tool_write(on, servo_angle);
}

static void lock_control(void *context)
{
    (void)context;
    before_lock = interrupts_hold(PRIORITY_CONTROL);
}

static void unlock_control(void *context)
{
    (void)context;
    interrupts_release(before_lock);
}

static void hold_steps(void *context)
{
    (void)context;
    before_hold = interrupts_hold(PRIORITY_STEP);
}

static void release_steps(void *context)
{
    (void)context;
    interrupts_release(before_hold);
}

static void feed_watchdog(void *context)
{
    (void)context;
    watchdog_feed();
}

static struct dv_hal hal = {
    .board = name,
    .build = BUILD_NAME,
    .read = read_serial,
    .write = write_serial,
    .drivers = switch_drivers,
    .inputs = read_inputs,
    .tool = write_tool,
    .lock_control = lock_control,
    .unlock_control = unlock_control,
    .hold_steps = hold_steps,
    .release_steps = release_steps,
    .feed_watchdog = feed_watchdog,
};

const struct dv_hal *hal_start(const struct clock *clock)
{
    board_name(name, clock->error);
    hal.boot = boot_number();
    hal.tick_hz = clock->tick_hz;
    return &hal;
}
