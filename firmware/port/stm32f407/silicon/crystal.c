/* RM0090, 7.2.11: HSE, divided by the RTC's prescaler, is an input of TIM11, which counts HSI. */
#include "crystal.h"

#include "peripherals.h"
#include "regs.h"
#include "wait.h"

#define HSI_KHZ 16000u
#define DIVISOR 31u  /* the largest: 806 kHz of 25 MHz, of which TIM11 sees every edge */
#define EDGES 8u     /* a capture: one every 159 cycles of HSI for 25 MHz, and a look takes some 20 */
#define CAPTURES 16u /* 2540 counts for 25 MHz, 15872 for 4 MHz, the slowest that HSE can have */
#define TURN 65536u  /* counts */
#define HSE_RTC FIELD(TIM11_OR_TI1_RMP, 2u)
#define ITS_OWN_INPUT FIELD(TIM11_CCMR1_CC1S, 1u)
#define EVERY_8TH FIELD(TIM11_CCMR1_IC1PSC, 3u)

bool crystal_start(void)
{
    RCC_CR |= RCC_CR_HSEON;
    return wait_for(&RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY);
}

void crystal_stop(void)
{
    RCC_CR &= ~RCC_CR_HSEON;
}

static void start_captures(void)
{
    RCC_CFGR |= FIELD(RCC_CFGR_RTCPRE, DIVISOR);
    peripheral_enable(&RCC_APB2ENR, RCC_APB2ENR_TIM11EN);
    TIM11_ARR = TURN - 1u;
    TIM11_OR = HSE_RTC;
    TIM11_CCMR1 = ITS_OWN_INPUT | EVERY_8TH;
    TIM11_CCER = TIM11_CCER_CC1E;
    TIM11_CR1 = TIM11_CR1_CEN;
}

static void stop_captures(void)
{
    TIM11_CR1 = 0;
    RCC_APB2ENR &= ~RCC_APB2ENR_TIM11EN;
    RCC_CFGR &= ~RCC_CFGR_RTCPRE;
}

/* Reading the count clears the flag. */
static bool captured(uint32_t *count)
{
    bool came = wait_for(&TIM11_SR, TIM11_SR_CC1IF, TIM11_SR_CC1IF);
    *count = TIM11_CCR1;
    return came;
}

static uint32_t counts_of_captures(void)
{
    uint32_t first, last;
    if (!captured(&last) || !captured(&first)) { /* the very first may have come too soon */
        return 0;
    }
    for (uint32_t i = 0; i < CAPTURES; i++) {
        if (!captured(&last)) {
            return 0;
        }
    }
    return (last - first) % TURN;
}

uint32_t crystal_khz(void)
{
    start_captures();
    uint32_t counts = counts_of_captures();
    stop_captures();
    return counts == 0 ? 0 : HSI_KHZ * DIVISOR * EDGES * CAPTURES / counts;
}
