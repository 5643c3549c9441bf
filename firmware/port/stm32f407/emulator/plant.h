/* What hangs on the emulated board's pins: arms that move by STEP and DIR, with mechanical ends and
 * switches, and an e-stop button. Positions are microsteps from the arm's true zero angle.
 */
#ifndef PLANT_H
#define PLANT_H

#include <stdbool.h>
#include <stdint.h>

#define PLANT_ARMS 4
#define PLANT_INPUTS 5 /* the switches, then the e-stop button */

struct plant_arm {
    bool inverted;      /* positive angles at the low level of DIR */
    int32_t at;         /* where it is */
    int32_t low, high;  /* the mechanical ends; a step beyond is lost */
    int32_t switch_at;  /* pressed from here on, in this direction: */
    int8_t direction;   /* +1 or -1 */
    bool switch_open;   /* the pressed switch is an open circuit */
};

enum plant_input { PLANT_CLOSED = 0, PLANT_OPEN = 1, PLANT_FREE = 2 };

struct plant {
    uint8_t arms;
    struct plant_arm arm[PLANT_ARMS];
    bool enabled_by_high;              /* which level of ENABLE switches the drivers on */
    uint8_t input[PLANT_INPUTS];       /* enum plant_input: what holds it, whatever the arm does */
};

extern struct plant plant;

/* What goes to the pins and what they read; as `io_write` and `io_read`. */
void plant_write(uint32_t port, uint32_t set_and_clear);
uint32_t plant_read(uint32_t port);

bool plant_drivers_on(void);
bool plant_tool_on(void);

#endif
