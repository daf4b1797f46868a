/* A loop with the settings recommended for a device, or a plain one of 1,000 N/m or its limit. It is fed the counts of a run and
   prints the hash of its states and the largest step of its force from tick to tick, mN.

   rendering FILE.palp COUNTS ENABLE_AT recommended|plain */
#include "device.h"
#include "replayed.h"
#include <math.h>
#include <string.h>

static palpate_body body;
static palpate_servo servo;

int main(int count, char **arguments)
{
    if (count != 5) return 2;
    size_t file_bytes, count_bytes;
    const uint8_t *file = contents(arguments[1], &file_bytes);
    const int32_t *counts = contents(arguments[2], &count_bytes);
    const size_t enable_at = strtoul(arguments[3], NULL, 10), ticks = count_bytes / sizeof(int32_t[3]);

    palpate_settings settings;
    good(device_settings(&settings));
    if (!strcmp(arguments[4], "plain")) {
        settings.stiffness = DEVICE.max_stiffness < 1000 ? DEVICE.max_stiffness : 1000;
        settings.damping = 2, settings.velocity_corner = 150;
        settings.between_counts = 0, settings.ease_change = 0;
    }
    settings.body_origin[0] = -0.03f, settings.body_origin[1] = -0.02f, settings.body_origin[2] = -0.01675f;
    palpate_file_info info;
    good(palpate_file_head(file, file_bytes, &info));
    void *buffer = malloc(info.buffer_bytes);
    good(palpate_body_load(&body, sizeof body, file, file_bytes, buffer, info.buffer_bytes));
    good(START_DEVICE(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, PALPATE_RESET_POWER_ON));
    uint32_t hash = 0;
    float largest = 0, last[3] = {0};
    for (size_t tick = 0; tick < ticks; tick++) {
        palpate_output output;
        palpate_state state;
        good(palpate_servo_tick(&servo, counts + 3 * tick, DEVICE_JOINTS, tick >= enable_at, &output));
        good(palpate_servo_state(&servo, &state));
        hash = (hash ^ state.digest) * 0x01000193u;
        const float step[3] = {state.force[0] - last[0], state.force[1] - last[1], state.force[2] - last[2]};
        largest = fmaxf(largest, 1e3f * sqrtf(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]));
        memcpy(last, state.force, sizeof last);
    }
    printf("%08x %.9f\n", (unsigned)hash, (double)largest);
    return 0;
}
