#include "tool.h"

#include BOARD_HEADER
#include "gpio.h"
#include "peripherals.h"

#define COUNT_HZ 1000000u /* the timer counts microseconds */
#define PERIOD_US 20000u
/* What most hobby servos take: 500 to 2500 us for half a turn. */
#define MIDDLE_US 1500.0f
#define LEAST_US 500.0f
#define MOST_US 2500.0f
#define US_PER_RAD 636.62f
#define PWM_1 FIELD(TIM3_CCMR1_OC1M, 6u) /* high from the period's start to the comparison */

void tool_start(const struct clock *clock)
{
    tool_off();
    pin_mode(PIN_TOOL, GPIO_OUTPUT);
    peripheral_enable(&RCC_APB1ENR, RCC_APB1ENR_TIM3EN);
    TIM3_PSC = clock->timer_hz / COUNT_HZ - 1u;
    TIM3_ARR = PERIOD_US - 1u;
    TIM3_CCR1 = 0; /* no pulse */
    TIM3_CCMR1 = PWM_1 | TIM3_CCMR1_OC1PE;
    TIM3_CCER = TIM3_CCER_CC1E;
    TIM3_EGR = TIM3_EGR_UG; /* takes the prescaler */
    TIM3_CR1 = TIM3_CR1_CEN | TIM3_CR1_ARPE;
    pin_function(PIN_SERVO, PIN_SERVO_FUNCTION);
}

void tool_write(bool on, float angle)
{
    float us = MIDDLE_US + angle * US_PER_RAD;
    us = us < LEAST_US ? LEAST_US : us > MOST_US ? MOST_US : us;
    pin_write(PIN_TOOL, on);
    TIM3_CCR1 = (uint32_t)us;
}

void tool_off(void)
{
    pin_write(PIN_TOOL, false);
}
