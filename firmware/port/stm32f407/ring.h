/* Bytes from one context to another, which may interrupt each other: one puts, one takes. */
#ifndef RING_H
#define RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define RING_SIZE 2048u /* bytes, a power of two */

struct ring {
    volatile uint32_t put;   /* ever, modulo 2^32 */
    volatile uint32_t taken; /* ever, modulo 2^32 */
    volatile uint8_t bytes[RING_SIZE];
};

static inline uint32_t ring_used(const struct ring *ring)
{
    return ring->put - ring->taken;
}

static inline uint32_t ring_free(const struct ring *ring)
{
    return RING_SIZE - ring_used(ring);
}

/* A byte that finds no room is lost. */
static inline void ring_put(struct ring *ring, uint8_t byte)
{
    if (ring_free(ring) > 0) {
        ring->bytes[ring->put % RING_SIZE] = byte;
        ring->put = ring->put + 1;
    }
}

/* Only when there is one. */
static inline uint8_t ring_take(struct ring *ring)
{
    uint8_t byte = ring->bytes[ring->taken % RING_SIZE];
    ring->taken = ring->taken + 1;
    return byte;
}

#endif
