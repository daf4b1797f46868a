/* A loop that finds out where its joints are by itself. It is fed the counts of a run, and prints the hash of its states,
   in which tick it was armed, and how it ended.

   home FILE.palp NUMBERS HOMING COUNTS [MARKS]

   MARKS: joint and count of the index mark that each joint passes, before the tick of the same number. */
#include "palpate.h"
#include <stdio.h>
#include <stdlib.h>

static palpate_body body;
static palpate_servo servo;

static void *contents(const char *path, size_t *bytes)
{
    FILE *from = fopen(path, "rb");
    if (!from) exit(2);
    void *memory = aligned_alloc(8, 1 << 22);
    *bytes = fread(memory, 1, 1 << 22, from);
    fclose(from);
    return memory;
}

static void good(palpate_status status)
{
    if (status == PALPATE_OK) return;
    printf("home: %s\n", palpate_status_text(status));
    exit(1);
}

int main(int count, char **arguments)
{
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
    uint32_t hash = 0, armed = 0, driven = 0;
    palpate_output output = {0};
    for (size_t tick = 0; tick < ticks; tick++) {
        palpate_state state;
        if (tick < passed) good(palpate_servo_index(&servo, (uint32_t)marks[2 * tick], marks[2 * tick + 1], &output));
        good(palpate_servo_tick(&servo, counts + 3 * tick, 3, 1, &output));
        good(palpate_servo_state(&servo, &state));
        hash = (hash ^ state.digest) * 0x01000193u;
        if ((state.phase == PALPATE_PHASE_ARMED || state.phase == PALPATE_PHASE_RUNNING) && !armed) armed = (uint32_t)tick;
        if (state.phase == PALPATE_PHASE_CALIBRATE && output.drives && output.duties[0]) driven++;
    }
    printf("%08x %u %u %s\n", (unsigned)hash, (unsigned)armed, (unsigned)driven, palpate_fault_text(output.fault));
    return 0;
}
