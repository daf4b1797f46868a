/* What STM32CubeMX would have generated: the timer, the encoders and the motors. On this emulated board the encoders
   and motors are a simulated device on the host, at the other end of a link. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Starts the timer's interrupt, and calls HAL_TIM_PeriodElapsedCallback in it. */
void MX_TIM2_Init(float rate);
void HAL_TIM_PeriodElapsedCallback(void);
/* Counts instructions from here on. */
void board_count(void);
uint32_t board_counted(void);
/* The link to the host: the next byte, or -1 where there is none; a frame out. */
int board_read(void);
void board_write(const uint8_t *bytes, uint32_t count);
/* Motors off, and stop. */
_Noreturn void Error_Handler(void);
_Noreturn void board_end(void);

#endif
