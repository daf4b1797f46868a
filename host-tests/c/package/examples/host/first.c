#include "palpate/woodenhaptics-2016.h" /* MECHANISM, DEVICE, START_DEVICE; yours: palpate device my.toml --out device.h */
#include "part.h"                       /* palpate bake capped_box --out part.h; also of a part.step */
#include <stdio.h>

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(PART_FACES, PART_EDGES)];
static palpate_servo servo;

int main(void)
{
    palpate_settings settings;
    palpate_output output;
    palpate_state state = {0};
    device_settings(&settings);
    const float start[3] = {0.025f, 0.0f, 0.1935f}, top[3] = PART_TOP; /* m; 11.5 mm below the probe at zero counts */
    for (int i = 0; i < 3; i++) settings.body_origin[i] = start[i] - top[i];
    palpate_status status = palpate_body_load(&body, sizeof body, part_palp, sizeof part_palp, buffer, sizeof buffer);
    if (!status)
        status = START_DEVICE(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, PALPATE_RESET_POWER_ON);
    for (int32_t tick = 0; !status && tick < 3000; tick++) { /* yours: the timer's interrupt, 4 kHz */
        const int32_t counts[3] = {0, 0, tick < 1000 ? tick / 5 : 200}; /* yours: encoders. Joint 3 lowers the probe */
        status = palpate_servo_tick(&servo, counts, 3, 1, &output);
        /* if (!status && output.drives) set_pulse_widths(output.duties); else stages_off(); */
    }
    if (!status) status = palpate_servo_state(&servo, &state);
    printf("%s, fault: %s, depth %.3f mm, force %.3f N\n", palpate_status_text(status), palpate_fault_text(state.fault),
           -1e3 * (double)state.gap, (double)state.force[2]);
    return status;
}
