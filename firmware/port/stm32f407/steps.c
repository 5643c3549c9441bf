#include "steps.h"

#include BOARD_HEADER
#include "gpio.h"
#include "interrupts.h"
#include "led.h"
#include "peripherals.h"
#include "step_timing.h"

#define STEP_PORT (PIN_STEP_1 >> 4)
#define STEP_SHIFT (PIN_STEP_1 & 15u)
#define PINS 8u
#define PINS_MASK ((1u << PINS) - 1u)

/* As dv_stepper_tick gives them, so that a shift puts them in their place. */
_Static_assert(PIN_STEP_2 == PIN_STEP_1 + 1 && PIN_STEP_3 == PIN_STEP_1 + 2
                   && PIN_STEP_4 == PIN_STEP_1 + 3 && DV_PINS_STEP == 0x0Fu,
               "STEP pins are neighbours");
_Static_assert(PIN_DIR_1 == PIN_STEP_1 + 4 && PIN_DIR_2 == PIN_STEP_1 + 5
                   && PIN_DIR_3 == PIN_STEP_1 + 6 && PIN_DIR_4 == PIN_STEP_1 + 7
                   && STEP_SHIFT + PINS <= 16 && DV_PINS_DIR == 0xF0u,
               "DIR pins stand behind them");
_Static_assert(TICK_HZ % 1000u == 0, "a piece is a millisecond of whole ticks");

static struct dv_board *stepped;

void steps_prepare(void)
{
    io_write(STEP_PORT, PINS_MASK << (STEP_SHIFT + 16u));
    for (uint32_t pin = PIN_STEP_1; pin < PIN_STEP_1 + PINS; pin++) {
        pin_mode(pin, GPIO_OUTPUT);
    }
}

/* In this order QEMU's timer has the right period, and it suits silicon. */
void steps_start(struct dv_board *board, const struct clock *clock)
{
    stepped = board;
    SCB_SHPR3 = FIELD(SCB_SHPR3_PRI_14, PRIORITY_CONTROL);
    interrupt_enable(IRQ_TIM2, PRIORITY_STEP);
    peripheral_enable(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN);
    TIM2_DIER = TIM2_DIER_UIE;
    TIM2_CR1 = TIM2_CR1_CEN;
    TIM2_ARR = TICK_RELOAD(clock->timer_hz, clock->tick_hz);
}

void TIM2_IRQHandler(void);
void TIM2_IRQHandler(void)
{
    TIM2_SR = ~TIM2_SR_UIF; /* first: a flag that is cleared late interrupts again */
    uint32_t pins = dv_stepper_tick(&stepped->stepper);
    uint32_t high = pins & PINS_MASK, low = ~pins & PINS_MASK;
    io_write(STEP_PORT, high << STEP_SHIFT | low << (STEP_SHIFT + 16u));
    if ((pins & DV_PINS_BOUNDARY) != 0) {
        SCB_ICSR = SCB_ICSR_PENDSVSET;
    }
}

void PendSV_Handler(void);
void PendSV_Handler(void)
{
    io_piece();
    led_piece();
    dv_board_piece(stepped);
}
