/* The emulated board's time: it passes only as far as it is granted, by milliseconds, over a serial
 * port of its own (USART3: each byte is a number of them). Between its grants the board stands still,
 * though it hears and answers. So its time need not run ahead of ours when QEMU could be quicker, and
 * who grants it can make it wait.
 */
#ifndef PACE_H
#define PACE_H

void pace_start(void);

/* A millisecond has passed. */
void pace_piece(void);

#endif
