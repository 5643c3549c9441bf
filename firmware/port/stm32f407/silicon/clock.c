/* 168 MHz from the board's crystal. Numbers without another source are RM0090's, chapters 3.5 (wait
 * states), 5.1.4 (voltage scale) and 7 (RCC).
 */
#include "clock.h"

#include BOARD_HEADER
#include "crystal.h"
#include "peripherals.h"
#include "regs.h"
#include "rules.h"
#include "wait.h"

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

_Static_assert(TICK_HZ >= DV_TICK_HZ_MIN && TICK_HZ_SLOW < DV_TICK_HZ_MIN,
               "without the PLL the processor is too slow for motion, and the core has to know");

/* Crystals that boards have, and how far off one may be measured: HSI itself is 4 % off at worst
 * between -10 and 85 °C (DS8626).
 */
static const uint32_t CRYSTALS_KHZ[] = {8000u, 25000u};
#define OFF_PERCENT 5u

static bool is_near(uint32_t measured_khz, uint32_t khz)
{
    uint32_t off = measured_khz > khz ? measured_khz - khz : khz - measured_khz;
    return off * 100u <= khz * OFF_PERCENT;
}

static uint32_t known_hz(uint32_t measured_khz)
{
    for (unsigned i = 0; i < sizeof CRYSTALS_KHZ / sizeof CRYSTALS_KHZ[0]; i++) {
        if (is_near(measured_khz, CRYSTALS_KHZ[i])) {
            return CRYSTALS_KHZ[i] * 1000u;
        }
    }
    return 0;
}

/* What the PLL is to be fed with: the crystal, or HSI if it cannot be. */
struct source {
    enum clock_error error;
    uint32_t hz;
};

static struct source start_source(void)
{
    enum clock_error error = CLOCK_NO_CRYSTAL;
    if (crystal_start()) {
        uint32_t hz = known_hz(crystal_khz());
        if (hz != 0) {
            return (struct source){CLOCK_FINE, hz};
        }
        error = CLOCK_ODD_CRYSTAL;
    }
    crystal_stop();
    return (struct source){error, HSI_HZ};
}

static bool start_pll(const struct source *source)
{
    uint32_t input_hz = source->hz % PLL_INPUT_HZ == 0 ? PLL_INPUT_HZ : PLL_INPUT_HZ / 2u;
    uint32_t divisor = source->hz / input_hz, factor = SYSTEM_HZ * PLL_P / input_hz;
    RCC_PLLCFGR = divisor * RCC_PLLCFGR_PLLM0 | factor * RCC_PLLCFGR_PLLN0
        | (PLL_P / 2u - 1u) * RCC_PLLCFGR_PLLP0 | PLL_Q * RCC_PLLCFGR_PLLQ0
        | (source->error == CLOCK_FINE ? RCC_PLLCFGR_PLLSRC : 0u);
    RCC_CR |= RCC_CR_PLLON;
    return wait_for(&RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY);
}

/* The flash is slower than the new clock, so it is told before the switch. */
static bool switch_to_pll(void)
{
    FLASH_ACR = FIELD(FLASH_ACR_LATENCY, WAIT_STATES) | FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN;
    if (!wait_for(&FLASH_ACR, FLASH_ACR_LATENCY, WAIT_STATES)) {
        return false;
    }
    RCC_CFGR = APB1_BY_4 | APB2_BY_2;
    RCC_CFGR = APB1_BY_4 | APB2_BY_2 | RCC_CFGR_SW1;
    if (wait_for(&RCC_CFGR, RCC_CFGR_SWS0 | RCC_CFGR_SWS1, RCC_CFGR_SWS1)) {
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
    struct source source = start_source();
    if (!start_pll(&source)) {
        return slow(CLOCK_NO_PLL);
    }
    if (!switch_to_pll()) {
        return slow(CLOCK_NO_SWITCH);
    }
    uint32_t apb1_hz = SYSTEM_HZ / APB1_DIVISOR;
    return (struct clock){
        .error = source.error,
        .serial_hz = apb1_hz,
        .timer_hz = 2u * apb1_hz, /* twice a bus clock that is divided */
        .tick_hz = TICK_HZ,
    };
}
