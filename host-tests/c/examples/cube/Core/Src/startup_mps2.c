/* What ST's startup file does on an STM32: the vector table, and the way to main. */
#include <stdint.h>
#include <string.h>

extern uint32_t _estack[], _sidata[], _sdata[], _edata[], _sbss[], _ebss[];
int main(void);
void TIM2_IRQHandler(void);
void Error_Handler(void);

void Reset_Handler(void);
void Reset_Handler(void)
{
    /* Before any float is touched: coprocessors 10 and 11 are the floating-point unit. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm volatile("dsb\n isb");
    memcpy(_sdata, _sidata, (size_t)((char *)_edata - (char *)_sdata));
    memset(_sbss, 0, (size_t)((char *)_ebss - (char *)_sbss));
    main();
    Error_Handler();
}

typedef void (*vector)(void);
/* The board's first timer is interrupt 8. */
__attribute__((section(".isr_vector"), used)) static const vector vectors[16 + 9] = {
    (vector)_estack, Reset_Handler, Error_Handler, Error_Handler, Error_Handler, Error_Handler, Error_Handler,
    0, 0, 0, 0, Error_Handler, Error_Handler, 0, Error_Handler, Error_Handler,
    Error_Handler, Error_Handler, Error_Handler, Error_Handler, Error_Handler, Error_Handler, Error_Handler,
    Error_Handler, TIM2_IRQHandler,
};
