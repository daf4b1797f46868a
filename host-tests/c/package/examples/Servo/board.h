/* The functions that servo.c needs of a board, and those that it gives. */
#ifndef BOARD_H
#define BOARD_H

#include <palpate.h>

#ifdef __cplusplus
extern "C" {
#endif

int board_counts(int32_t *counts);        /* of each joint, 0 in its zero pose (else palpate_servo_home()); false if unread */
int board_enable(void);                   /* 1 while a hand holds the enable button */
void board_drive(const int32_t *duties);  /* to each motor, full scale -32767 to 32767, and its stage on */
void board_off(void);                     /* every stage off */

palpate_status servo_start(float *rate);  /* with the timer stopped; the rate that servo_tick() must be called at, Hz */
void servo_tick(int is_late);             /* in the timer's interrupt; 1 if the last one ended late */
const char *servo_fault(void);            /* "none", or why the motors are off until a new start */

#ifdef __cplusplus
}
#endif

#endif
