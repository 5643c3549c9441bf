/* From the random number generator, mixed with a number that RAM keeps through a reset (and that
 * is whatever it is at power-up): where the generator has no clock, that alone.
 */
#include "boot_number.h"

#include "peripherals.h"
#include "regs.h"

#define TRIES 10000u /* a number takes 40 cycles of 48 MHz */

__attribute__((section(".kept"))) static uint32_t kept;

static uint32_t random_number(void)
{
    peripheral_enable(&RCC_AHB2ENR, RCC_AHB2ENR_RNGEN);
    RNG_CR = RNG_CR_RNGEN;
    for (uint32_t tries = TRIES; tries > 0; tries--) {
        if ((RNG_SR & RNG_SR_DRDY) != 0) {
            return RNG_DR;
        }
    }
    return 0;
}

uint32_t boot_number(void)
{
    kept = kept * 1664525u + 1013904223u; /* Numerical Recipes' generator */
    return kept ^ random_number();
}
