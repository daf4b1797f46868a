/* A loop with everything: protection, virtual tool, texture, passivity control. It is fed the counts of a run and
   prints the hash of its states, how many ticks touched, and how it ended.

   replay FILE.palp NUMBERS COUNTS ENABLE_AT */
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
    printf("replay: %s\n", palpate_status_text(status));
    exit(1);
}

/* Along u, more to the ends of the patch. */
static void bowl(const palpate_touched *touched, float *force)
{
    const float share = -0.25f * touched->push * (touched->parameters[0] - 0.5f);
    for (int axis = 0; axis < 3; axis++) force[axis] = touched->along_u[axis] * share;
}

int main(int count, char **arguments)
{
    if (count != 5) return 2;
    size_t file_bytes, number_bytes, count_bytes;
    const uint8_t *file = contents(arguments[1], &file_bytes);
    const float *numbers = contents(arguments[2], &number_bytes);
    const int32_t *counts = contents(arguments[3], &count_bytes);
    const size_t enable_at = strtoul(arguments[4], NULL, 10), ticks = count_bytes / sizeof(int32_t[3]);

    palpate_serial_arm arm;
    palpate_device device;
    palpate_protection protection = {0};
    float *const places[] = {(float *)&arm, (float *)&device, (float *)&protection, protection.inertia};
    const size_t lengths[] = {sizeof arm, sizeof device, offsetof(palpate_protection, watch_signs),
                              sizeof protection.inertia};
    for (int part = 0; part < 4; part++) {
        for (size_t index = 0; index < lengths[part] / sizeof(float); index++) places[part][index] = *numbers++;
    }
    protection.watch_signs = protection.watch_supply = 1;
    protection.least_supply = 20000, protection.most_supply = 30000;

    palpate_settings settings;
    good(palpate_settings_default(&settings));
    settings.rate = 4000, settings.stiffness = 1000, settings.damping = 2, settings.max_force = 5;
    settings.velocity_corner = 150, settings.soft_start = 0.1f, settings.link_timeout = 0.1f;
    settings.body_origin[0] = -0.03f, settings.body_origin[1] = -0.02f, settings.body_origin[2] = -0.01675f;
    settings.texture_share = 0.2f;
    settings.coupling_stiffness = 800, settings.coupling_damping = 4, settings.coupling_mass = 0.05f;
    settings.passivity_damping = 4, settings.passivity_resolution = 1e-4f;
    settings.device_damping = 0.5f, settings.device_friction = 0.01f;

    palpate_file_info info;
    good(palpate_file_head(file, file_bytes, &info));
    void *buffer = malloc(info.buffer_bytes);
    good(palpate_body_load(&body, sizeof body, file, file_bytes, buffer, info.buffer_bytes));
    if (palpate_servo_start_serial_arm_protected(&servo, sizeof servo, &arm, &device, &body, &settings, &protection,
                                                 PALPATE_RESET_POWER_ON) != PALPATE_SETTINGS_TEXTURE) return 3;
    good(palpate_texture(bowl));
    good(palpate_servo_start_serial_arm_protected(&servo, sizeof servo, &arm, &device, &body, &settings, &protection,
                                                  PALPATE_RESET_POWER_ON));
    uint32_t hash = 0, touched = 0;
    palpate_output output = {0};
    for (size_t tick = 0; tick < ticks; tick++) {
        palpate_state state;
        good(palpate_servo_note(&servo, PALPATE_LINK_ALIVE, &output));
        good(palpate_servo_supply(&servo, 24000, &output));
        good(palpate_servo_tick(&servo, counts + 3 * tick, 3, tick >= enable_at, &output));
        good(palpate_servo_state(&servo, &state));
        hash = (hash ^ state.digest) * 0x01000193u;
        touched += state.contact == 2;
    }
    printf("%08x %u %s\n", (unsigned)hash, (unsigned)touched, palpate_fault_text(output.fault));
    return 0;
}
