/* A loop with everything: protection, virtual tool, texture, passivity control. It is fed the counts of a run and
   prints the hash of its states, how many ticks touched, and how it ended. With MODES_FILE the body gives way, and forces
   and modes are in the hash.

   replay FILE.palp NUMBERS COUNTS ENABLE_AT */
#include "replayed.h"
#ifdef MODES_FILE
#include MODES_FILE
#endif
#include <math.h>
#include <string.h>

static palpate_body body;
static palpate_servo servo;

static uint32_t hash;

static void mix(uint32_t word)
{
    hash = (hash ^ word) * 0x01000193u;
}

#ifdef MODES_FILE
static palpate_soft_body soft;
static palpate_word room[PART_MODES * PALPATE_MODE_WORDS];

static palpate_status load(const palpate_mode *given, size_t count, float rate)
{
    return palpate_soft_body_load(&soft, sizeof soft, &body, given, count, rate, room, sizeof room);
}

/* Each refusal once; the loop on what was refused is none. */
static void refusals(void)
{
    static const struct { size_t at; float number; palpate_status status; } bad[] = {
        {offsetof(palpate_mode, quadratic), NAN, PALPATE_NOT_FINITE},
        {offsetof(palpate_mode, limit), -1e-3f, PALPATE_SOFT_MODE},
        {offsetof(palpate_mode, bend), -1, PALPATE_SOFT_MODE},
        {offsetof(palpate_mode, bump_radius), -1e-3f, PALPATE_SOFT_MODE},
        {offsetof(palpate_mode, stiffness), 0, PALPATE_SOFT_MOTION},
        {offsetof(palpate_mode, damping), -1, PALPATE_SOFT_MOTION},
        {offsetof(palpate_mode, mass), 1e-12f, PALPATE_SOFT_MOTION},
    };
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++) {
        palpate_mode spoiled[PART_MODES];
        memcpy(spoiled, part_modes, sizeof part_modes);
        memcpy((char *)&spoiled[PART_MODES - 1] + bad[index].at, &bad[index].number, sizeof(float));
        if (load(spoiled, PART_MODES, 4000) != bad[index].status) exit(10 + (int)index);
    }
    if (load(part_modes, 0, 4000) != PALPATE_SOFT_MODES || load(part_modes, 9, 4000) != PALPATE_SOFT_MODES) exit(20);
    if (load(part_modes, PART_MODES, -4000) != PALPATE_SOFT_RATE || load(part_modes, PART_MODES, NAN) != PALPATE_SOFT_RATE) exit(21);
    if (palpate_soft_body_load(&soft, sizeof soft, &body, part_modes, PART_MODES, 4000, room,
                               sizeof room - sizeof room[0] * 8)
        != PALPATE_TOO_SMALL) exit(22);
    palpate_servo one;
    const palpate_serial_arm arm = {0};
    const palpate_device device = {0};
    const palpate_settings settings = {0};
    if (palpate_servo_start_serial_arm_soft(&one, sizeof one, &arm, &device, &soft, &settings, 0)
        != PALPATE_NOT_READY) exit(23);
}
#define START palpate_servo_start_serial_arm_soft_protected
#define BODY &soft
#else
#define START palpate_servo_start_serial_arm_protected
#define BODY &body
#endif

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
#ifdef MODES_FILE
    refusals();
    good(load(part_modes, PART_MODES, settings.rate));
#endif
    if (START(&servo, sizeof servo, &arm, &device, BODY, &settings, &protection, PALPATE_RESET_POWER_ON)
        != PALPATE_SETTINGS_TEXTURE) return 3;
    good(palpate_texture(bowl));
    good(START(&servo, sizeof servo, &arm, &device, BODY, &settings, &protection, PALPATE_RESET_POWER_ON));
    uint32_t touched = 0;
    float q[PALPATE_MAX_MODES];
    palpate_output output = {0};
    for (size_t tick = 0; tick < ticks; tick++) {
        palpate_state state;
        good(palpate_servo_note(&servo, PALPATE_LINK_ALIVE, &output));
        good(palpate_servo_supply(&servo, 24000, &output));
        good(palpate_servo_tick(&servo, counts + 3 * tick, 3, tick >= enable_at, &output));
        good(palpate_servo_state(&servo, &state));
        mix(state.digest);
#ifdef MODES_FILE
        uint32_t words[PALPATE_MAX_MODES + 3];
        good(palpate_servo_modes(&servo, q));
        memcpy(words, q, sizeof q), memcpy(words + PALPATE_MAX_MODES, state.force, sizeof state.force);
        for (int index = 0; index < PALPATE_MAX_MODES + 3; index++) mix(words[index]);
#endif
        touched += state.contact == 2;
    }
#ifdef MODES_FILE
    /* Other modes end the loop. */
    good(load(part_modes, PART_MODES - 1, settings.rate));
    if (palpate_servo_tick(&servo, counts, 3, 1, &output) != PALPATE_NOT_READY || output.drives) return 4;
    good(load(part_modes, PART_MODES, settings.rate));
    good(palpate_servo_tick(&servo, counts + 3 * (ticks - 1), 3, 1, &output));
#else
    if (palpate_servo_modes(&servo, q) != PALPATE_SOFT_NONE) return 5;
#endif
    printf("%08x %u %s\n", (unsigned)hash, (unsigned)touched, palpate_fault_text(output.fault));
    return 0;
}
