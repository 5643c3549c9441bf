/* The registers of the STM32F407 that this firmware uses, by the names of its reference manual
 * (RM0090): PERIPHERAL_REGISTER, and PERIPHERAL_REGISTER_FIELD for the bits of a field. The core's
 * are those of the Cortex-M4 (PM0214). Held to published data by tests/firmware/test_chip_data.py.
 */
#ifndef REGS_H
#define REGS_H

#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t *)(address))

/* A value in the place of a field. */
#define FIELD(mask, value) ((value) * ((mask) & -(mask)))

/* Reset and clock control. */
#define RCC_CR REGISTER(0x40023800u)
#define RCC_CR_HSEON (1u << 16)
#define RCC_CR_HSERDY (1u << 17)
#define RCC_CR_PLLON (1u << 24)
#define RCC_CR_PLLRDY (1u << 25)
#define RCC_PLLCFGR REGISTER(0x40023804u)
#define RCC_PLLCFGR_PLLM0 (1u << 0)
#define RCC_PLLCFGR_PLLN0 (1u << 6)
#define RCC_PLLCFGR_PLLP0 (1u << 16)
#define RCC_PLLCFGR_PLLSRC (1u << 22)
#define RCC_PLLCFGR_PLLQ0 (1u << 24)
#define RCC_CFGR REGISTER(0x40023808u)
#define RCC_CFGR_SW1 (1u << 1)
#define RCC_CFGR_SWS0 (1u << 2)
#define RCC_CFGR_SWS1 (1u << 3)
#define RCC_CFGR_PPRE1 (7u << 10)
#define RCC_CFGR_PPRE2 (7u << 13)
#define RCC_CFGR_RTCPRE (31u << 16)
#define RCC_AHB1ENR REGISTER(0x40023830u)
#define RCC_AHB1ENR_GPIOAEN (1u << 0)
#define RCC_AHB2ENR REGISTER(0x40023834u)
#define RCC_AHB2ENR_RNGEN (1u << 6)
#define RCC_APB1ENR REGISTER(0x40023840u)
#define RCC_APB1ENR_TIM2EN (1u << 0)
#define RCC_APB1ENR_TIM3EN (1u << 1)
#define RCC_APB1ENR_USART2EN (1u << 17)
#define RCC_APB1ENR_PWREN (1u << 28)
#define RCC_APB2ENR REGISTER(0x40023844u)
#define RCC_APB2ENR_TIM11EN (1u << 18)

/* Power and flash. */
#define PWR_CR REGISTER(0x40007000u)
#define PWR_CR_VOS (1u << 14)
#define FLASH_ACR REGISTER(0x40023C00u)
#define FLASH_ACR_LATENCY (7u << 0)
#define FLASH_ACR_PRFTEN (1u << 8)
#define FLASH_ACR_ICEN (1u << 9)
#define FLASH_ACR_DCEN (1u << 10)

/* Pins. A port is a number: 0 for A. */
#define GPIO_MODER(port) REGISTER(0x40020000u + 0x400u * (port))
#define GPIO_PUPDR(port) REGISTER(0x4002000Cu + 0x400u * (port))
#define GPIO_IDR(port) REGISTER(0x40020010u + 0x400u * (port))
#define GPIO_BSRR(port) REGISTER(0x40020018u + 0x400u * (port))
#define GPIO_AFRL(port) REGISTER(0x40020020u + 0x400u * (port))

/* Timers: TIM2 ticks, TIM3 moves the servo, TIM11 measures the crystal. */
#define TIM2_CR1 REGISTER(0x40000000u)
#define TIM2_CR1_CEN (1u << 0)
#define TIM2_DIER REGISTER(0x4000000Cu)
#define TIM2_DIER_UIE (1u << 0)
#define TIM2_SR REGISTER(0x40000010u)
#define TIM2_SR_UIF (1u << 0)
#define TIM2_ARR REGISTER(0x4000002Cu)
#define TIM3_CR1 REGISTER(0x40000400u)
#define TIM3_CR1_CEN (1u << 0)
#define TIM3_CR1_ARPE (1u << 7)
#define TIM3_EGR REGISTER(0x40000414u)
#define TIM3_EGR_UG (1u << 0)
#define TIM3_CCMR1 REGISTER(0x40000418u)
#define TIM3_CCMR1_OC1PE (1u << 3)
#define TIM3_CCMR1_OC1M (7u << 4)
#define TIM3_CCER REGISTER(0x40000420u)
#define TIM3_CCER_CC1E (1u << 0)
#define TIM3_PSC REGISTER(0x40000428u)
#define TIM3_ARR REGISTER(0x4000042Cu)
#define TIM3_CCR1 REGISTER(0x40000434u)
#define TIM11_CR1 REGISTER(0x40014800u)
#define TIM11_CR1_CEN (1u << 0)
#define TIM11_SR REGISTER(0x40014810u)
#define TIM11_SR_CC1IF (1u << 1)
#define TIM11_CCMR1 REGISTER(0x40014818u)
#define TIM11_CCMR1_CC1S (3u << 0)
#define TIM11_CCMR1_IC1PSC (3u << 2)
#define TIM11_CCER REGISTER(0x40014820u)
#define TIM11_CCER_CC1E (1u << 0)
#define TIM11_ARR REGISTER(0x4001482Cu)
#define TIM11_CCR1 REGISTER(0x40014834u)
#define TIM11_OR REGISTER(0x40014850u)
#define TIM11_OR_TI1_RMP (3u << 0)

/* Serial ports: USART2 is the link; in the emulator USART1 is its bench, USART3 its pace. */
#define USART1_SR REGISTER(0x40011000u)
#define USART1_SR_RXNE (1u << 5)
#define USART1_DR REGISTER(0x40011004u)
#define USART1_CR1 REGISTER(0x4001100Cu)
#define USART1_CR1_RE (1u << 2)
#define USART1_CR1_TE (1u << 3)
#define USART1_CR1_RXNEIE (1u << 5)
#define USART1_CR1_UE (1u << 13)
#define USART3_SR REGISTER(0x40004800u)
#define USART3_SR_RXNE (1u << 5)
#define USART3_DR REGISTER(0x40004804u)
#define USART3_CR1 REGISTER(0x4000480Cu)
#define USART3_CR1_RE (1u << 2)
#define USART3_CR1_RXNEIE (1u << 5)
#define USART3_CR1_UE (1u << 13)
#define USART2_SR REGISTER(0x40004400u)
#define USART2_SR_ORE (1u << 3)
#define USART2_SR_RXNE (1u << 5)
#define USART2_SR_TXE (1u << 7)
#define USART2_DR REGISTER(0x40004404u)
#define USART2_BRR REGISTER(0x40004408u)
#define USART2_CR1 REGISTER(0x4000440Cu)
#define USART2_CR1_RE (1u << 2)
#define USART2_CR1_TE (1u << 3)
#define USART2_CR1_RXNEIE (1u << 5)
#define USART2_CR1_TXEIE (1u << 7)
#define USART2_CR1_UE (1u << 13)

/* Watchdog and random numbers. */
#define IWDG_KR REGISTER(0x40003000u)
#define IWDG_PR REGISTER(0x40003004u)
#define IWDG_RLR REGISTER(0x40003008u)
#define RNG_CR REGISTER(0x50060800u)
#define RNG_CR_RNGEN (1u << 2)
#define RNG_SR REGISTER(0x50060804u)
#define RNG_SR_DRDY (1u << 0)
#define RNG_DR REGISTER(0x50060808u)

/* Interrupts, by their position in the vector table. */
#define IRQ_TIM2 28u
#define IRQ_USART1 37u
#define IRQ_USART2 38u
#define IRQ_USART3 39u
#define IRQ_COUNT 82u

/* The core. */
#define NVIC_ISER(irq) REGISTER(0xE000E100u + 4u * ((irq) / 32u))
#define NVIC_ISPR(irq) REGISTER(0xE000E200u + 4u * ((irq) / 32u))
#define NVIC_IRQ_BIT(irq) (1u << ((irq) % 32u))
#define NVIC_IPR(irq) (*(volatile uint8_t *)(0xE000E400u + (irq)))
#define SCB_ICSR REGISTER(0xE000ED04u)
#define SCB_ICSR_PENDSVSET (1u << 28)
#define SCB_SHPR3 REGISTER(0xE000ED20u)
#define SCB_SHPR3_PRI_14 (255u << 16) /* PendSV's */
#define SCB_CPACR REGISTER(0xE000ED88u)
#define SCB_CPACR_CP10 (3u << 20) /* the floating point unit: full access */
#define SCB_CPACR_CP11 (3u << 22)

#endif
