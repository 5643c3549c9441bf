/* 168 MHz from the board's crystal. Numbers without another source are RM0090's, chapters 3.5 (wait
 * states), 5.1.4 (voltage scale) and 7 (RCC).
 */
#include "clock.h"

#include BOARD_HEADER
#include "peripherals.h"
#include "regs.h"

#include <stdbool.h>

#define HSI_HZ 16000000u
#define SYSTEM_HZ 168000000u
#define PLL_INPUT_HZ 2000000u /* the least jitter; 1 MHz for a crystal of odd megahertz */
#define PLL_P 2u              /* PLL output over system clock */
#define PLL_Q 7u              /* PLL output over the random numbers' 48 MHz */
#define WAIT_STATES 5u        /* at 168 MHz and 2.7 to 3.6 V */
#define APB1_BY_4 FIELD(RCC_CFGR_PPRE1, 5u)
#define APB2_BY_2 FIELD(RCC_CFGR_PPRE2, 4u)
#define APB1_DIVISOR 4u
#define TRIES 200000u /* some 100 ms at 16 MHz; a crystal starts in about 2, the PLL in 0.3 */

static bool reads(volatile const uint32_t *where, uint32_t mask, uint32_t value)
{
    for (uint32_t tries = TRIES; tries > 0; tries--) {
        if ((*where & mask) == value) {
            return true;
        }
    }
    return false;
}

static bool start_crystal(void)
{
    RCC_CR |= RCC_CR_HSEON;
    if (reads(&RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY)) {
        return true;
    }
    RCC_CR &= ~RCC_CR_HSEON;
    return false;
}

static bool start_pll(bool crystal)
{
    uint32_t source_hz = crystal ? BOARD_HSE_HZ : HSI_HZ;
    uint32_t input_hz = source_hz % PLL_INPUT_HZ == 0 ? PLL_INPUT_HZ : PLL_INPUT_HZ / 2u;
    uint32_t divisor = source_hz / input_hz, factor = SYSTEM_HZ * PLL_P / input_hz;
    RCC_PLLCFGR = divisor * RCC_PLLCFGR_PLLM0 | factor * RCC_PLLCFGR_PLLN0
        | (PLL_P / 2u - 1u) * RCC_PLLCFGR_PLLP0 | PLL_Q * RCC_PLLCFGR_PLLQ0
        | (crystal ? RCC_PLLCFGR_PLLSRC : 0u);
    RCC_CR |= RCC_CR_PLLON;
    return reads(&RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY);
}

/* The flash is slower than the new clock, so it is told before the switch. */
static bool switch_to_pll(void)
{
    FLASH_ACR = FIELD(FLASH_ACR_LATENCY, WAIT_STATES) | FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    if (!reads(&FLASH_ACR, FLASH_ACR_LATENCY, WAIT_STATES)) {
        return false;
    }
    RCC_CFGR = APB1_BY_4 | APB2_BY_2;
    RCC_CFGR = APB1_BY_4 | APB2_BY_2 | RCC_CFGR_SW1;
    if (reads(&RCC_CFGR, RCC_CFGR_SWS0 | RCC_CFGR_SWS1, RCC_CFGR_SWS1)) {
        return true;
    }
    RCC_CFGR = 0;
    return false;
}

static struct clock slow(enum clock_error error)
{
    return (struct clock){error, HSI_HZ, HSI_HZ, TICK_HZ_SLOW};
}

struct clock clock_start(void)
{
    peripheral_enable(&RCC_APB1ENR, RCC_APB1ENR_PWREN);
    PWR_CR |= PWR_CR_VOS; /* scale 1, which 168 MHz needs */
    bool crystal = start_crystal();
    if (!start_pll(crystal)) {
        return slow(CLOCK_NO_PLL);
    }
    if (!switch_to_pll()) {
        return slow(CLOCK_NO_SWITCH);
    }
    uint32_t apb1_hz = SYSTEM_HZ / APB1_DIVISOR;
    return (struct clock){
        .error = crystal ? CLOCK_FINE : CLOCK_NO_CRYSTAL,
        .serial_hz = apb1_hz,
        .timer_hz = 2u * apb1_hz, /* twice a bus clock that is divided */
        .tick_hz = TICK_HZ,
    };
}
