#include "pace.h"

#include BOARD_HEADER
#include "interrupts.h"

#include <stdbool.h>

/* What is not used by then is forgotten: after a wait the board does not hurry. */
#define MOST_MS 20u

static uint32_t granted; /* ms */
static bool stands;

void pace_start(void)
{
    USART3_CR1 = USART3_CR1_UE | USART3_CR1_RE | USART3_CR1_RXNEIE;
    interrupt_enable(IRQ_USART3, PRIORITY_CONTROL); /* as `pace_piece` is called */
}

void pace_piece(void)
{
    if (granted > 0) {
        granted--;
    } else {
        TIM2_CR1 = 0;
        stands = true;
    }
}

void USART3_IRQHandler(void);
void USART3_IRQHandler(void)
{
    if ((USART3_SR & USART3_SR_RXNE) == 0) {
        return;
    }
    granted += USART3_DR & 0xFFu;
    granted = granted < MOST_MS ? granted : MOST_MS;
    if (stands && granted > 0) {
        granted--;
        stands = false;
        TIM2_CR1 = TIM2_CR1_CEN;
        TIM2_ARR = TICK_RELOAD(QEMU_TIMER_HZ, TICK_HZ);
    }
}
