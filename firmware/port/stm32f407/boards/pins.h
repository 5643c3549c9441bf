/* The pins that both supported boards leave free, and what this firmware does with them. A pin is
 * its port's number and its own: PORT_E | 8 is PE8. docs/hardware.md takes its tables from here.
 */
#ifndef PINS_H
#define PINS_H

#define PORT_A (0u << 4)
#define PORT_B (1u << 4)
#define PORT_C (2u << 4)
#define PORT_D (3u << 4)
#define PORT_E (4u << 4)

/* STEP and DIR of joints 1 to 4: eight neighbours on one port, so that one write sets them all. */
#define PIN_STEP_1 (PORT_E | 8u)
#define PIN_STEP_2 (PORT_E | 9u)
#define PIN_STEP_3 (PORT_E | 10u)
#define PIN_STEP_4 (PORT_E | 11u)
#define PIN_DIR_1 (PORT_E | 12u)
#define PIN_DIR_2 (PORT_E | 13u)
#define PIN_DIR_3 (PORT_E | 14u)
#define PIN_DIR_4 (PORT_E | 15u)

/* Of all drivers together. It floats until a host has said which level enables them. */
#define PIN_ENABLE (PORT_D | 10u)

/* Inputs, each with a pull-up: an open circuit reads high. */
#define PIN_SWITCH_1 (PORT_D | 0u)
#define PIN_SWITCH_2 (PORT_D | 1u)
#define PIN_SWITCH_3 (PORT_D | 3u)
#define PIN_SWITCH_4 (PORT_D | 6u)
#define PIN_ESTOP (PORT_D | 7u)

/* The tool: on and off, and a hobby servo (TIM3's channel 1). */
#define PIN_TOOL (PORT_D | 11u)
#define PIN_SERVO (PORT_C | 6u)
#define PIN_SERVO_FUNCTION 2u /* TIM3 */

/* The link: USART2. */
#define PIN_SERIAL_TX (PORT_A | 2u)
#define PIN_SERIAL_RX (PORT_A | 3u)
#define PIN_SERIAL_FUNCTION 7u /* USART2 */

#endif
