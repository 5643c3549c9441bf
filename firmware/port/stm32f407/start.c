/* From reset to `main`, and where a fault ends. */
#include "drivers.h"
#include "interrupts.h"
#include "tool.h"

#include <stdint.h>

extern uint32_t stack_top, data_image, data_begin, data_end, bss_begin, bss_end;

int main(void);
void reset_handler(void);
void TIM2_IRQHandler(void);
void USART1_IRQHandler(void);
void USART2_IRQHandler(void);
void USART3_IRQHandler(void);
void PendSV_Handler(void);

/* Drivers and tool off, no step any more; then the watchdog resets the processor. */
static void fault_handler(void)
{
    interrupts_hold(PRIORITY_STEP);
    drivers_float();
    tool_off();
    for (;;) {
    }
}

/* Only the emulator has these. */
__attribute__((weak)) void USART1_IRQHandler(void)
{
    fault_handler();
}
__attribute__((weak)) void USART3_IRQHandler(void)
{
    fault_handler();
}

/* What is not named is never enabled; if it came all the same, address 0 would be a hard fault. */
struct vectors {
    uint32_t *stack;
    void (*exceptions[15])(void);
    void (*interrupts[IRQ_COUNT])(void);
};

__attribute__((section(".vectors"), used)) static const struct vectors VECTORS = {
    .stack = &stack_top,
    .exceptions =
        {
            reset_handler, /* 1 */
            fault_handler, /* 2: NMI */
            fault_handler, /* 3: hard fault, and what is not enabled: memory, bus, usage */
            fault_handler, fault_handler, fault_handler, 0, 0, 0, 0, fault_handler, /* 11: SVC */
            fault_handler, 0, PendSV_Handler, /* 14 */
            fault_handler, /* 15: SysTick */
        },
    .interrupts =
        {
            [IRQ_TIM2] = TIM2_IRQHandler,
            [IRQ_USART1] = USART1_IRQHandler,
            [IRQ_USART2] = USART2_IRQHandler,
            [IRQ_USART3] = USART3_IRQHandler,
        },
};

void reset_handler(void)
{
    SCB_CPACR |= SCB_CPACR_CP10 | SCB_CPACR_CP11;
    __asm volatile("dsb\n\tisb" ::: "memory");
    const uint32_t *from = &data_image;
    for (uint32_t *to = &data_begin; to < &data_end; to++) {
        *to = *from;
        from++;
    }
    for (uint32_t *to = &bss_begin; to < &bss_end; to++) {
        *to = 0;
    }
    main();
    fault_handler();
}
