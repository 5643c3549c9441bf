/* The bench: who stands beside the emulated board, switches it on, presses its switches. It speaks
 * by frames as the link does, over a serial port of its own (USART1).
 */
#ifndef BENCH_H
#define BENCH_H

/* Little-endian, without padding; `deltaviz/link/emulator/bench.py` is the other end. */
enum bench_message {
    BENCH_POWER = 0x40, /* boot number u32, level of ENABLE that enables u8: the board starts */
    BENCH_ARM = 0x41,   /* joint u8, inverted u8, switch open when pressed u8, direction i8,
                           at, low, high, switch at: i32 each */
    BENCH_INPUT = 0x42, /* input u8, enum plant_input u8 */
    BENCH_ASK = 0x43,   /* answered, with the same sequence number, by: */
    BENCH_STATE = 0xC0, /* drivers on u8, tool on u8, servo's pulse in us u16, at i32[4] */
};

/* Does what the bench has said meanwhile. */
void bench_poll(void);

#endif
