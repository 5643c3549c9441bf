/* Single pins, as the board header names them: port and number in one. For start-up and for what is
 * not fast; not to be called from interrupts.
 */
#ifndef GPIO_H
#define GPIO_H

#include "io.h"
#include "peripherals.h"
#include "regs.h"

#include <stdbool.h>
#include <stdint.h>

enum gpio_mode { GPIO_INPUT = 0, GPIO_OUTPUT = 1, GPIO_FUNCTION = 2 };
enum gpio_pull { GPIO_FLOATING = 0, GPIO_PULL_UP = 1 };

static inline uint32_t pin_port(uint32_t pin)
{
    return pin >> 4;
}

static inline uint32_t pin_number(uint32_t pin)
{
    return pin & 15u;
}

static inline uint32_t gpio_field(uint32_t old, uint32_t number, uint32_t width, uint32_t value)
{
    uint32_t mask = (1u << width) - 1u;
    return (old & ~(mask << number * width)) | value << number * width;
}

static inline void pin_mode(uint32_t pin, enum gpio_mode mode)
{
    uint32_t port = pin_port(pin);
    GPIO_MODER(port) = gpio_field(GPIO_MODER(port), pin_number(pin), 2, (uint32_t)mode);
}

static inline void pin_pull(uint32_t pin, enum gpio_pull pull)
{
    uint32_t port = pin_port(pin);
    GPIO_PUPDR(port) = gpio_field(GPIO_PUPDR(port), pin_number(pin), 2, (uint32_t)pull);
}

/* One of the peripherals that can have this pin, by its number in the data sheet; pins 0 to 7. */
static inline void pin_function(uint32_t pin, uint32_t function)
{
    uint32_t port = pin_port(pin);
    GPIO_AFRL(port) = gpio_field(GPIO_AFRL(port), pin_number(pin), 4, function);
    pin_mode(pin, GPIO_FUNCTION);
}

static inline void pin_write(uint32_t pin, bool high)
{
    io_write(pin_port(pin), high ? 1u << pin_number(pin) : 1u << (pin_number(pin) + 16u));
}

static inline bool pin_read(uint32_t pin)
{
    return (io_read(pin_port(pin)) >> pin_number(pin) & 1u) != 0;
}

/* Ports A to E. */
static inline void gpio_start(void)
{
    peripheral_enable(&RCC_AHB1ENR, 31u * RCC_AHB1ENR_GPIOAEN);
}

#endif
