/* The emulated mps2-an386: its first timer, SysTick as a counter, and two FIFOs of the host by semihosting. */
#include "board.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER 0x40000000u
#define SYSTICK 0xE000E010u
#define CLOCK 25000000.0f

void MX_TIM2_Init(float rate)
{
    uint32_t reload = (uint32_t)(CLOCK / rate) - 1u;
    REGISTER(TIMER + 8) = reload;
    REGISTER(TIMER + 4) = reload;
    REGISTER(TIMER) = 9; /* enable, with interrupt */
    REGISTER(TIMER + 12) = 1;
    REGISTER(0xE000E280u) = 1u << 8; /* not pending */
    REGISTER(0xE000E100u) = 1u << 8; /* unmasked */
    REGISTER(SYSTICK + 4) = 0xFFFFFFu;
    REGISTER(SYSTICK + 8) = 0;
    REGISTER(SYSTICK) = 5; /* free running, at the core's clock */
}

void TIM2_IRQHandler(void);
void TIM2_IRQHandler(void)
{
    REGISTER(TIMER + 12) = 1;
    HAL_TIM_PeriodElapsedCallback();
}

static uint32_t began;

void board_count(void) { began = REGISTER(SYSTICK + 8); }

/* The emulator takes 64 ns an instruction: 1.6 counts. */
uint32_t board_counted(void) { return ((began - REGISTER(SYSTICK + 8)) & 0xFFFFFFu) * 5u / 8u; }

static int semihosting(int operation, const void *argument)
{
    register int r0 __asm("r0") = operation;
    register const void *r1 __asm("r1") = argument;
    __asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static int open_file(const char *name, uint32_t length, uint32_t mode)
{
    const uint32_t block[3] = {(uint32_t)name, mode, length};
    int file = semihosting(1, block);
    if (file < 0) Error_Handler();
    return file;
}

int board_read(void)
{
    static int file = -1;
    static uint8_t buffer[128];
    static uint32_t next, end;
    if (file < 0) file = open_file("to-device", 9, 1);
    /* A read that gives nothing is the end of the file, or one that a signal cut short in the emulator. */
    for (int attempt = 0; next >= end && attempt < 16; attempt++) {
        const uint32_t block[3] = {(uint32_t)file, (uint32_t)buffer, sizeof buffer};
        uint32_t left = (uint32_t)semihosting(6, block);
        next = 0;
        end = left < sizeof buffer ? sizeof buffer - left : 0;
    }
    return next < end ? buffer[next++] : -1;
}

void board_write(const uint8_t *bytes, uint32_t count)
{
    static int file = -1;
    if (file < 0) file = open_file("from-device", 11, 5);
    const uint32_t block[3] = {(uint32_t)file, (uint32_t)bytes, count};
    semihosting(5, block);
}

_Noreturn static void leave(uint32_t reason)
{
    for (;;) semihosting(0x18, (const void *)reason);
}

_Noreturn void board_end(void) { leave(0x20026); /* as a program that is done */ }

_Noreturn void Error_Handler(void)
{
    __asm volatile("cpsid i");
    leave(0x20023); /* as one that went wrong */
}
