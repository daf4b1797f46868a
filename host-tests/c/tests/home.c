/* A loop that finds out where its joints are by itself. It is fed the counts of a run, and prints the hash of its states,
   in which tick it was armed, how it ended, and why homing was refused. Without arguments it prints all such words.

   home FILE.palp NUMBERS HOMING COUNTS [MARKS]

   MARKS: joint and count of the index mark that each joint passes, before the tick of the same number. */
#include "replayed.h"

static palpate_body body;
static palpate_servo servo;

int main(int count, char **arguments)
{
    if (count == 1) {
        for (uint32_t code = 0; code < 12; code++) puts(palpate_refusal_text(code));
        for (uint32_t code = 0; code < 25; code++) puts(palpate_fault_text(code));
        return 0;
    }
    if (count != 5 && count != 6) return 2;
    size_t file_bytes, number_bytes, homing_bytes, count_bytes, mark_bytes = 0;
    const uint8_t *file = contents(arguments[1], &file_bytes);
    const float *numbers = contents(arguments[2], &number_bytes);
    const palpate_homing *homing = contents(arguments[3], &homing_bytes);
    const int32_t *counts = contents(arguments[4], &count_bytes);
    const int32_t *marks = count == 6 ? contents(arguments[5], &mark_bytes) : NULL;
    const size_t ticks = count_bytes / sizeof(int32_t[3]), passed = mark_bytes / sizeof(int32_t[2]);
    if (homing_bytes != sizeof *homing) return 2;

    palpate_serial_arm arm;
    palpate_device device;
    for (size_t index = 0; index < sizeof arm / sizeof(float); index++) ((float *)&arm)[index] = *numbers++;
    for (size_t index = 0; index < sizeof device / sizeof(float); index++) ((float *)&device)[index] = *numbers++;

    palpate_settings settings;
    good(palpate_settings_default(&settings));
    settings.rate = 4000, settings.stiffness = 1000, settings.damping = 2, settings.max_force = 5;
    settings.velocity_corner = 150, settings.soft_start = 0.1f;
    settings.body_origin[0] = -0.03f, settings.body_origin[1] = -0.02f, settings.body_origin[2] = -0.01675f;

    palpate_file_info info;
    good(palpate_file_head(file, file_bytes, &info));
    void *buffer = malloc(info.buffer_bytes);
    good(palpate_body_load(&body, sizeof body, file, file_bytes, buffer, info.buffer_bytes));
    good(palpate_servo_start_serial_arm(&servo, sizeof servo, &arm, &device, &body, &settings, PALPATE_RESET_POWER_ON));
    good(palpate_servo_home(&servo, homing));
    uint32_t hash = 0, armed = 0, driven = 0, refusal = 0;
    palpate_output output = {0};
    for (size_t tick = 0; tick < ticks; tick++) {
        palpate_state state;
        if (tick < passed) good(palpate_servo_index(&servo, (uint32_t)marks[2 * tick], marks[2 * tick + 1], &output));
        good(palpate_servo_tick(&servo, counts + 3 * tick, 3, 1, &output));
        good(palpate_servo_state(&servo, &state));
        refusal = state.refusal;
        hash = (hash ^ state.digest) * 0x01000193u;
        if ((state.phase == PALPATE_PHASE_ARMED || state.phase == PALPATE_PHASE_RUNNING) && !armed) armed = (uint32_t)tick;
        if (state.phase == PALPATE_PHASE_CALIBRATE && output.drives && output.duties[0]) driven++;
    }
    printf("%08x %u %u %s: %s\n", (unsigned)hash, (unsigned)armed, (unsigned)driven, palpate_fault_text(output.fault),
           palpate_refusal_text(refusal));
    return 0;
}
