/* The stack that a loop takes on the emulated mps2-an386: memory below is painted, called over, and looked through. And
   the instructions of its ticks, by SysTick. */
#include "device.h"
#include <string.h>

#define PAINT 0xA5A5A5A5u
#define WORDS 8192

extern const uint8_t part_palp[], part_palp_end[];

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(6, 12)];
static palpate_servo servo;
static palpate_tool_servo room;
static int32_t third;
static uint32_t touched;

static int semihosting(int operation, const void *argument)
{
    register int r0 __asm("r0") = operation;
    register const void *r1 __asm("r1") = argument;
    __asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

_Noreturn void Error_Handler(void);
void Error_Handler(void)
{
    for (;;) semihosting(0x18, (const void *)0x20023u);
}

void TIM2_IRQHandler(void);
void TIM2_IRQHandler(void) { Error_Handler(); }

static void good(palpate_status status)
{
    if (status != PALPATE_OK) Error_Handler();
}

__attribute__((noinline)) static void load(void)
{
    good(palpate_body_load(&body, sizeof body, part_palp, (size_t)(part_palp_end - part_palp), buffer, sizeof buffer));
}

__attribute__((noinline)) static void settings_of(palpate_settings *settings)
{
    good(device_settings(settings));
    const float origin[3] = {-0.005f, -0.02f, 0.16f};
    for (int i = 0; i < 3; i++) settings->body_origin[i] = origin[i];
}

__attribute__((noinline)) static void plain(void)
{
    palpate_settings settings;
    settings_of(&settings);
    good(START_DEVICE(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, PALPATE_RESET_POWER_ON));
}

__attribute__((noinline)) static void protected(void)
{
    palpate_settings settings;
    settings_of(&settings);
    good(START_DEVICE_PROTECTED(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, &PROTECTION,
                                PALPATE_RESET_POWER_ON));
}

__attribute__((noinline)) static void tool(void)
{
    static const palpate_tool finger = {{0, 0, 0.009f}, 0.003f, 0.4f};
    palpate_settings settings;
    settings_of(&settings);
    settings.body_origin[2] -= 0.012f;
    good(palpate_servo_start_serial_arm_tool_protected(&room.servo, sizeof room, &MECHANISM, &DEVICE, &body, &finger,
                                                       &settings, &PROTECTION, PALPATE_RESET_POWER_ON));
}

__attribute__((noinline)) static void tool_tick(void)
{
    const int32_t counts[3] = {0, 0, third};
    palpate_output output;
    good(palpate_servo_orient_wrist(&room.servo, 0, counts, 0));
    good(palpate_servo_tick(&room.servo, counts, 3, 1, &output));
    touched += output.drives;
}

__attribute__((noinline)) static void tick(void)
{
    const int32_t counts[3] = {0, 0, third};
    palpate_output output;
    good(palpate_servo_tick(&servo, counts, 3, 1, &output));
    touched += output.drives;
}

/* Bytes below this frame that a call wrote to. */
__attribute__((noinline)) static uint32_t stack_of(void (*call)(void))
{
    volatile uint32_t *top = __builtin_frame_address(0);
    top -= 32; /* this function's own */
    for (int word = 1; word <= WORDS; word++) top[-word] = PAINT;
    call();
    int deepest = WORDS;
    while (deepest > 0 && top[-deepest] == PAINT) deepest--;
    if (deepest == WORDS) Error_Handler();
    return 4u * (uint32_t)(deepest + 32);
}

static void put(const char *text, uint32_t length)
{
    static int file = -1;
    const uint32_t output[3] = {(uint32_t)":tt", 4, 3};
    if (file < 0) file = semihosting(1, output);
    const uint32_t block[3] = {(uint32_t)file, (uint32_t)text, length};
    semihosting(5, block);
}

static void say(const char *what, uint32_t number)
{
    char digits[12], *at = digits + sizeof digits;
    *--at = '\n';
    do *--at = (char)('0' + number % 10u); while (number /= 10u);
    put(what, (uint32_t)strlen(what));
    put(at, (uint32_t)(digits + sizeof digits - at));
}

/* Instructions of a call: the emulator takes 64 ns for each, 1.6 counts of SysTick, which counts down. */
static uint32_t instructions_of(void (*call)(void))
{
    volatile uint32_t *systick = (volatile uint32_t *)0xE000E010u;
    systick[1] = 0xFFFFFFu, systick[0] = 5;
    const uint32_t began = systick[2];
    call();
    return ((began - systick[2]) & 0xFFFFFFu) * 5u / 8u;
}

/* The most of anything that 3000 ticks take, pressed into the box. */
static uint32_t most(uint32_t (*measure)(void (*)(void)), void (*of)(void))
{
    uint32_t most = 0;
    for (int32_t at = 0; at < 3000; at++) {
        third = at < 1000 ? at / 5 : 200;
        const uint32_t taken = measure(of);
        if (taken > most) most = taken;
    }
    return most;
}

/* The same ticks twice: a start between them, to press in from outside again. */
static void ticks(const char *stack, const char *instructions, void (*start)(void), void (*of)(void))
{
    say(stack, most(stack_of, of));
    start();
    say(instructions, most(instructions_of, of));
}

int main(void)
{
    say("load ", stack_of(load));
    say("start ", stack_of(plain));
    ticks("tick ", "instructions ", plain, tick);
    say("protected start ", stack_of(protected));
    ticks("protected tick ", "protected instructions ", protected, tick);
    say("tool start ", stack_of(tool));
    ticks("tool tick ", "tool instructions ", tool, tool_tick);
    say("driven ", touched);
    for (;;) semihosting(0x18, (const void *)0x20026u);
}
