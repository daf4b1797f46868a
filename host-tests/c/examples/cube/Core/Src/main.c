/* The capped box under a WoodenHaptics arm, felt from C: the scene of `cargo palpate demo`. */
#include "board.h"
#include "palpate.h"
#include <math.h>

extern const uint8_t part_palp[], part_palp_end[];

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(6, 12)];
static palpate_servo servo;
static palpate_receiver receiver;

#define RATE 4000.0f

/* A motor with an encoder of so many counts a turn, geared down to its joint; count zero in the calibration pose. */
static palpate_joint geared(float encoder_ratio, float motor_ratio, float least, float greatest)
{
    const float turn = 6.28318530717958647692f;
    palpate_joint joint = {0};
    joint.radians_per_count = turn / (2000.0f * encoder_ratio);
    joint.angle_at_zero = 0.0f + 0.5f * joint.radians_per_count;
    joint.torque_at_full = 0.0259f * 3.0f * motor_ratio; /* N·m/A, A */
    joint.dry_friction = 0.01f;
    joint.least_angle = least;
    joint.greatest_angle = greatest;
    return joint;
}

static void servo_init(void)
{
    const palpate_serial_arm arm = {
        .base_height = 0.080f, .first_link = 0.205f, .second_link = 0.245f,
        .workspace_centre = {0.220f, 0.0f, 0.080f},
        .end_masses = {0.170f * 0.051f / 0.205f + 0.110f, 0.110f * 0.091f / 0.245f},
    };
    const palpate_device device = {
        .joints = {geared(-16.0f, 16.0f, -1.6f, 1.6f), geared(-12.0f, -12.0f, -0.8f, 2.2f),
                   geared(12.0f, 12.0f, -1.2f, 1.8f)},
        .min_margin = 0.05f, .max_joint_rate = 25.0f, .max_force = 5.0f, .max_stiffness = 1000.0f,
        .max_damping = 8.0f,
    };
    palpate_settings settings;
    palpate_settings_default(&settings);
    settings.rate = RATE;
    settings.stiffness = 1000.0f;
    settings.damping = 2.0f;
    settings.max_force = 5.0f;
    settings.velocity_corner = 150.0f;
    settings.soft_start = 0.1f;
    settings.body_origin[0] = -0.03f;
    settings.body_origin[1] = -0.02f;
    settings.body_origin[2] = -0.01675f;
    settings.link_timeout = 0.1f;

    size_t bytes = (size_t)(part_palp_end - part_palp);
    if (palpate_body_load(&body, sizeof body, part_palp, bytes, buffer, sizeof buffer) != PALPATE_OK) Error_Handler();
    if (palpate_servo_start_serial_arm(&servo, sizeof servo, &arm, &device, &body, &settings,
                                       PALPATE_RESET_POWER_ON) != PALPATE_OK) Error_Handler();
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
