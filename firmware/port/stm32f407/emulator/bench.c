#include "bench.h"

#include "boot_number.h"
#include "bytes.h"
#include "frames.h"
#include "interrupts.h"
#include "pace.h"
#include "plant.h"
#include "ring.h"

#define STATE_SIZE 20

/* Where QEMU loads what the bench says before the start: RAM that the STM32F407 does not have. */
#define SETUP ((const uint8_t *)0x20020000u)
#define SETUP_END (SETUP + 4096)

static struct ring received;
static struct dv_frame_reader reader;
static uint32_t boot;
static bool powered;

static void take_power(struct dv_reader *from)
{
    boot = dv_read_u32(from);
    plant.enabled_by_high = dv_read_bool(from);
    powered = from->good;
}

static void take_arm(struct dv_reader *from)
{
    uint8_t joint = dv_read_u8(from);
    struct plant_arm arm = {0};
    arm.inverted = dv_read_bool(from);
    arm.switch_open = dv_read_bool(from);
    arm.direction = dv_read_i8(from);
    arm.at = dv_read_i32(from);
    arm.low = dv_read_i32(from);
    arm.high = dv_read_i32(from);
    arm.switch_at = dv_read_i32(from);
    if (!from->good || joint >= PLANT_ARMS) {
        return;
    }
    uint32_t held = interrupts_hold(PRIORITY_STEP);
    plant.arm[joint] = arm;
    plant.arms = joint < plant.arms ? plant.arms : (uint8_t)(joint + 1);
    interrupts_release(held);
}

static void take_input(struct dv_reader *from)
{
    uint8_t input = dv_read_u8(from), holds = dv_read_u8(from);
    if (from->good && input < PLANT_INPUTS && holds <= PLANT_FREE) {
        plant.input[input] = holds;
    }
}

static void answer(uint8_t sequence)
{
    uint8_t payload[STATE_SIZE], frame[DV_FRAME_ROOM(STATE_SIZE)];
    struct dv_writer to = {payload, sizeof payload, true};
    dv_write_bool(&to, plant_drivers_on());
    dv_write_bool(&to, plant_tool_on());
    dv_write_u16(&to, (uint16_t)TIM3_CCR1);
    for (int i = 0; i < PLANT_ARMS; i++) {
        dv_write_i32(&to, plant.arm[i].at);
    }
    size_t count = dv_frame_write(BENCH_STATE, sequence, payload, sizeof payload, frame,
                                  sizeof frame);
    for (size_t i = 0; i < count; i++) {
        USART1_DR = frame[i]; /* QEMU's is always ready */
    }
}

static void take(const struct dv_frame *frame)
{
    struct dv_reader from = {frame->payload, frame->size, true};
    switch (frame->type) {
    case BENCH_POWER:
        take_power(&from);
        break;
    case BENCH_ARM:
        take_arm(&from);
        break;
    case BENCH_INPUT:
        take_input(&from);
        break;
    case BENCH_ASK:
        answer(frame->sequence);
        break;
    default:
        break;
    }
}

static void hear(uint8_t byte)
{
    struct dv_frame frame;
    if (dv_frame_read(&reader, byte, &frame)) {
        take(&frame);
    }
}

void bench_poll(void)
{
    while (ring_used(&received) > 0) {
        hear(ring_take(&received));
    }
}

uint32_t boot_number(void)
{
    dv_frame_reader_init(&reader);
    for (int i = 0; i < PLANT_ARMS; i++) {
        plant.input[i] = PLANT_FREE;
    }
    USART1_CR1 = USART1_CR1_UE | USART1_CR1_TE | USART1_CR1_RE | USART1_CR1_RXNEIE;
    interrupt_enable(IRQ_USART1, PRIORITY_BENCH);
    pace_start();
    for (const uint8_t *at = SETUP; at < SETUP_END && !powered; at++) {
        hear(*at);
    }
    return boot;
}

void USART1_IRQHandler(void);
void USART1_IRQHandler(void)
{
    if ((USART1_SR & USART1_SR_RXNE) != 0) {
        ring_put(&received, (uint8_t)USART1_DR);
    }
}
