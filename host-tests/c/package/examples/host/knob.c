/* A knob whose driver commutates: detents between end stops, and a spring that is set while it runs. */
#include <palpate.h>
#include <math.h>
#include <stdio.h>

static const palpate_dial dial = {.radius = 0.02f, .release_rate = 0.5f};
static const palpate_device device = {
    .joints = {{.radians_per_count = 6.2831853f / 16384, .torque_at_full = 0.063f, .dry_friction = 2e-3f,
                .least_angle = -INFINITY, .greatest_angle = INFINITY}}, /* it turns without end */
    .min_margin = 0.01f, .max_joint_rate = 120, .max_force = 2.8f, .max_stiffness = 4000, .max_damping = 8};
/* Detents of 0.24 N·m/rad need 0.0007 s times that everywhere; the stops have damping of their own. */
static palpate_feel feel = {.detents = {.pitch = 0.2618f, .torque = 0.01f},
                            .ends = {.between = {-1, 1}, .stiffness = 0.5f, .damping = 5e-4f}, .damping = 3e-4f};
static palpate_servo servo;

int main(void)
{
    palpate_settings settings;
    palpate_output output;
    palpate_turned turned = {0};
    palpate_beyond beyond = {0};
    palpate_status status = palpate_settings_recommended(&settings, &device);
    if (!status)
        status = palpate_servo_start_dial(&servo, sizeof servo, &dial, &device, &feel, &settings, PALPATE_RESET_POWER_ON);
    for (int32_t tick = 0, before = 0; !status && tick < 16000; tick++) { /* yours: the timer's interrupt, 4 kHz */
        const int32_t counts = tick < 10800 ? tick / 4 : 2700;            /* yours: the sensor, across whole turns */
        status = palpate_servo_tick(&servo, &counts, 1, 1, &output);
        /* if (!status && output.drives) motor_torque(output.duties[0]); else motor_off(); */
        if (!status) status = palpate_servo_dial(&servo, &turned);
        if (turned.detent != before) before = turned.detent; /* yours: an event, as where `end` changes */
        if (!status && tick == 14000) { /* with the interrupt masked */
            feel.spring = (palpate_spring){.stiffness = 0.02f, .rest = 1, .max_torque = 0.01f};
            status = palpate_servo_set_feel(&servo, PALPATE_FEEL_SPRING, &feel, &beyond);
        }
    }
    printf("%s, limit %g: %.4f rad, detent %d, end %d, %.3f mN.m, duty %d\n", palpate_status_text(status),
           (double)beyond.limit, (double)turned.angle, (int)turned.detent, (int)turned.end, 1e3 * (double)turned.torque,
           output.duties[0]);
    return status;
}
