/* The capped box under a WoodenHaptics arm, felt from C: the scene of `cargo palpate demo`. device.h is written by
   `palpate device woodenhaptics-2016 --out device.h`; for your own arm, `palpate device my.toml --out device.h`. */
#include "board.h"
#include "device.h"

extern const uint8_t part_palp[], part_palp_end[];

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(6, 12)];
static palpate_servo servo;
static palpate_receiver receiver;

#define RATE 4000.0f

static void servo_init(void)
{
    palpate_settings settings;
    if (device_settings(&settings) != PALPATE_OK) Error_Handler();
    settings.rate = RATE;
    settings.body_origin[0] = -0.03f;
    settings.body_origin[1] = -0.02f;
    settings.body_origin[2] = -0.01675f;
    settings.link_timeout = 0.1f;

    size_t bytes = (size_t)(part_palp_end - part_palp);
    if (palpate_body_load(&body, sizeof body, part_palp, bytes, buffer, sizeof buffer) != PALPATE_OK) Error_Handler();
    if (START_DEVICE(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, PALPATE_RESET_POWER_ON)
        != PALPATE_OK) Error_Handler();
    if (palpate_receiver_start(&receiver, sizeof receiver) != PALPATE_OK) Error_Handler();
}

/* The frame of this tick: on a device of your own, read the encoders instead. */
static palpate_heard sensors(void)
{
    palpate_heard heard = {0};
    for (int bytes = 0; bytes < 16 * PALPATE_MAX_FRAME; bytes++) {
        int byte = board_read();
        if (byte < 0) board_end(); /* the host is gone */
        palpate_receiver_feed(&receiver, (uint8_t)byte, &heard);
        if (heard.what != 0) break;
    }
    return heard;
}

void HAL_TIM_PeriodElapsedCallback(void)
{
    static uint32_t tick;
    palpate_output output;
    palpate_heard heard = sensors();
    if (heard.what == 1 || heard.what == 3) palpate_servo_note(&servo, PALPATE_LINK_ALIVE, &output);

    board_count();
    if (heard.what == 1 && heard.tick == tick) {
        palpate_servo_tick(&servo, heard.counts, 3, heard.enable, &output);
    } else {
        palpate_servo_tick_without(&servo, heard.what == 2, &output);
    }
    uint32_t instructions = board_counted();
    tick++;
    /* On a device of your own, here: duties to the pulse widths if output.drives, else every stage off. */

    if ((float)instructions > 15625000.0f / RATE) palpate_servo_note(&servo, PALPATE_OVERRUN, &output);
    uint8_t frame[PALPATE_MAX_FRAME];
    size_t length;
    if (palpate_servo_report(&servo, instructions, frame, sizeof frame, &length) != PALPATE_OK) Error_Handler();
    board_write(frame, (uint32_t)length);
}

int main(void)
{
    servo_init();
    MX_TIM2_Init(RATE);
    for (;;) __asm volatile("wfi");
}
