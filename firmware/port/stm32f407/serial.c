#include "serial.h"

#include BOARD_HEADER
#include "gpio.h"
#include "interrupts.h"
#include "peripherals.h"
#include "ring.h"

/* Of what is to be sent, so that sending does not keep the step interrupt waiting. */
#define BYTES_AT_ONCE 4

static struct ring received, to_send;

void serial_start(const struct clock *clock)
{
    peripheral_enable(&RCC_APB1ENR, RCC_APB1ENR_USART2EN);
    pin_pull(PIN_SERIAL_RX, GPIO_PULL_UP); /* without an adapter it hears silence, not noise */
    pin_function(PIN_SERIAL_RX, PIN_SERIAL_FUNCTION);
    USART2_BRR = (clock->serial_hz + BAUD / 2u) / BAUD;
    USART2_CR1 = USART2_CR1_UE | USART2_CR1_TE | USART2_CR1_RE | USART2_CR1_RXNEIE;
    pin_function(PIN_SERIAL_TX, PIN_SERIAL_FUNCTION); /* its transmitter holds it high by now */
    interrupt_enable(IRQ_USART2, PRIORITY_SERIAL);
}

size_t serial_read(uint8_t *bytes, size_t room)
{
    size_t count = 0;
    while (count < room && ring_used(&received) > 0) {
        bytes[count] = ring_take(&received);
        count++;
    }
    return count;
}

bool serial_write(const uint8_t *bytes, size_t count)
{
    if (count > ring_free(&to_send)) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        ring_put(&to_send, bytes[i]);
    }
    USART2_CR1 |= USART2_CR1_TXEIE;
    return true;
}

static void send_some(void)
{
    int count = 0;
    while (count < BYTES_AT_ONCE && ring_used(&to_send) > 0
           && (USART2_SR & USART2_SR_TXE) != 0) {
        USART2_DR = ring_take(&to_send);
        count++;
    }
    if (ring_used(&to_send) == 0) {
        USART2_CR1 &= ~USART2_CR1_TXEIE;
    }
}

void USART2_IRQHandler(void);
void USART2_IRQHandler(void)
{
    /* After an overrun (ORE) reading the data is what clears it. */
    if ((USART2_SR & (USART2_SR_RXNE | USART2_SR_ORE)) != 0) {
        ring_put(&received, (uint8_t)USART2_DR);
    }
    if ((USART2_CR1 & USART2_CR1_TXEIE) != 0) {
        send_some();
    }
}
