/* Calls with bad arguments, one spoiled thing each: every one must come back with an error code, and under the
   sanitizers no byte may be touched that is not the library's to touch. Memory that is handed over is of exactly the
   size that is said, on the heap. Prints how many calls came back with which status.

   hammer FILE.palp CALLS */
#include "palpate.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t seed = 0x9e3779b97f4a7c15u;
static uint32_t any(uint32_t below)
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return below ? (uint32_t)(seed >> 33) % below : 0;
}

static uint8_t *file;
static size_t file_bytes;
static palpate_file_info info;
static palpate_body body;
static void *buffer;
static palpate_soft_body soft;
static palpate_word room[2 * PALPATE_MODE_WORDS];
static palpate_tracker tracker;
static palpate_pair pair;
static palpate_servo servo, soft_servo, dial_servo;
static palpate_tool_servo tool_servo;
static palpate_receiver receiver;

static const palpate_serial_arm arm = {0.08f, 0.205f, 0.245f, {0.22f, 0, 0.08f}, {0.15f, 0.04f}};
static palpate_device device;
static palpate_settings settings;
static const palpate_protection protection = {
    {{0.5f, 16}, {0.5f, 16}, {0.5f, 16}}, {15, 15, 15}, 1.5f, 1, {5e-3f, 5e-3f, 5e-3f}, 1, 20000, 30000};
static void smooth(const palpate_touched *touched, float *force)
{
    (void)touched, force[0] = force[1] = force[2] = 0;
}
static const palpate_mode modes[2] = {
    {.linear = {{16.7f}}, .limit = 6e-3f, .motion = 1.01f, .stretch = 16.8f, .stiffness = 500},
    {.linear = {{0}, {0, 16.7f}}, .bump_direction = {0, 0, 1}, .bump_radius = 0.01f, .limit = 1e-3f, .motion = 2,
     .stretch = 300, .bend = 6e4f, .twist = 1e7f, .mass = 0.01f, .damping = 0.5f, .stiffness = 700}};
static const palpate_pose pose = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.2f, 0, 0}, {0, 0, 0}, {0, 0, 0}};

static void stop(const char *what, palpate_status status)
{
    printf("hammer: %s: %s\n", what, palpate_status_text(status));
    exit(1);
}
static void good(const char *what, palpate_status status)
{
    if (status != PALPATE_OK) stop(what, status);
}

/* A number that is none. */
static float bad_float(void)
{
    const float bad[3] = {NAN, INFINITY, -INFINITY};
    return bad[any(3)];
}

/* Memory of a handle that was never made one, or was made elsewhere. */
static void *no_handle(const void *handle, size_t bytes)
{
    uint8_t *memory = malloc(bytes);
    switch (any(3)) {
    case 0: memset(memory, 0, bytes); break;
    case 1: for (size_t i = 0; i < bytes; i++) memory[i] = (uint8_t)any(256); break;
    default: memcpy(memory, handle, bytes); break; /* moved */
    }
    return memory;
}

/* One past an address: not aligned for anything. */
#define ASKEW(pointer) ((void *)((uintptr_t)(pointer) + 1))

static uint32_t crc32_of(const uint8_t *bytes, size_t count)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

/* A tracker on a body: whatever an accepted file holds, nothing reads outside of it. */
static void use(const palpate_body *spoiled)
{
    palpate_tracker one;
    good("start", palpate_start(&one, sizeof one, spoiled));
    for (int i = 0; i < 40; i++) {
        const float probe[3] = {(float)any(200) * 1e-3f - 0.1f, (float)any(200) * 1e-3f - 0.1f,
                                (float)any(200) * 1e-3f - 0.1f};
        palpate_touch touch;
        palpate_located located;
        good("step", palpate_step(&one, probe, &touch));
        good("closest", palpate_closest(spoiled, probe, &located));
    }
}

/* A loop on the soft body, ticked anywhere. */
static void press(void)
{
    palpate_output output;
    good("a soft loop", palpate_servo_start_serial_arm_soft(&soft_servo, sizeof soft_servo, &arm, &device, &soft,
                                                            &settings, 0));
    for (int i = 0; i < 400; i++) {
        const int32_t counts[3] = {(int32_t)any(200) - 100, (int32_t)any(200) - 100, (int32_t)any(200) - 100};
        good("a soft tick", palpate_servo_tick(&soft_servo, counts, 3, 1, &output));
    }
    float q[PALPATE_MAX_MODES];
    good("modes", palpate_servo_modes(&soft_servo, q));
}

static unsigned accepted;

/* A file spoiled somewhere: cut short, changed, or changed with its CRC made right again. */
static palpate_status spoiled_file(void)
{
    size_t bytes = file_bytes;
    uint32_t kind = any(4);
    if (kind == 0) bytes = any((uint32_t)file_bytes);
    uint8_t *copy = aligned_alloc(8, (bytes + 8) & ~(size_t)7);
    memcpy(copy, file, bytes);
    if (kind > 0) copy[any((uint32_t)bytes)] ^= (uint8_t)(1u << any(8));
    if (kind == 3) {
        uint32_t crc = crc32_of(copy, bytes - 4);
        memcpy(copy + bytes - 4, &crc, 4);
    }
    palpate_body one;
    void *place = malloc(info.buffer_bytes);
    palpate_status status = palpate_body_load(&one, sizeof one, copy, bytes, place, info.buffer_bytes);
    if (status == PALPATE_OK) {
        /* A hash, a note or a place in the model: another good file. Not counted. */
        if (kind != 3) stop("a damaged file was taken", status);
        accepted++;
        use(&one);
    } else {
        palpate_touch touch;
        const float probe[3] = {0, 0, 0};
        palpate_tracker on;
        if (palpate_start(&on, sizeof on, &one) != PALPATE_NOT_READY) stop("a refused body was taken", status);
        (void)probe, (void)touch;
    }
    free(place);
    free(copy);
    return status;
}

static palpate_status bad_load(void)
{
    palpate_body *one = malloc(sizeof *one);
    void *place = malloc(info.buffer_bytes);
    palpate_status status;
    switch (any(7)) {
    case 0: status = palpate_body_load(NULL, sizeof *one, file, file_bytes, place, info.buffer_bytes); break;
    case 1: status = palpate_body_load(one, sizeof *one, NULL, file_bytes, place, info.buffer_bytes); break;
    case 2: status = palpate_body_load(one, sizeof *one, file, file_bytes, NULL, info.buffer_bytes); break;
    case 3: status = palpate_body_load(ASKEW(one), sizeof *one, file, file_bytes, place, info.buffer_bytes); break;
    case 4: {
        size_t bytes = any(sizeof *one / 2);
        void *small = malloc(bytes + 1);
        status = palpate_body_load(small, bytes, file, file_bytes, place, info.buffer_bytes);
        free(small);
        break;
    }
    case 5: {
        size_t bytes = any(info.buffer_bytes);
        void *small = malloc(bytes + 1);
        status = palpate_body_load(one, sizeof *one, file, file_bytes, small, bytes);
        free(small);
        break;
    }
    default: status = palpate_body_load(one, sizeof *one, ASKEW(file), file_bytes - 1, place, info.buffer_bytes); break;
    }
    free(place);
    free(one);
    return status;
}

static palpate_status bad_info(void)
{
    palpate_file_info out;
    switch (any(4)) {
    case 0: return palpate_file_head(NULL, file_bytes, &out);
    case 1: return palpate_file_head(file, file_bytes, NULL);
    case 2: return palpate_file_head(file, any((uint32_t)file_bytes), &out);
    default: return palpate_file_head(file, (size_t)-1 - any(1000), &out);
    }
}

static palpate_status bad_probe(void)
{
    float probe[3] = {0, 0, 0};
    palpate_touch touch;
    palpate_located located;
    void *no_body = no_handle(&body, sizeof body), *no_tracker = no_handle(&tracker, sizeof tracker);
    palpate_status status;
    switch (any(12)) {
    case 0: probe[any(3)] = bad_float(); status = palpate_step(&tracker, probe, &touch); break;
    case 1: probe[any(3)] = bad_float(); status = palpate_closest(&body, probe, &located); break;
    case 2: probe[any(3)] = bad_float(); status = palpate_track(&tracker, probe); break;
    case 3: status = palpate_step(no_tracker, probe, &touch); break;
    case 4: status = palpate_closest(no_body, probe, &located); break;
    case 5: status = palpate_step(&tracker, NULL, &touch); break;
    case 6: status = palpate_step(&tracker, probe, NULL); break;
    case 7: status = palpate_step(NULL, probe, &touch); break;
    case 8: status = palpate_closest(&body, ASKEW(probe), &located); break;
    case 9: status = palpate_closest(&body, probe, NULL); break;
    case 10: status = palpate_update_contact(no_tracker, &touch); break;
    default: status = palpate_update_contact(&tracker, NULL); break;
    }
    free(no_body);
    free(no_tracker);
    return status;
}

static palpate_status bad_start(void)
{
    void *no_body = no_handle(&body, sizeof body);
    size_t bytes = any(sizeof(palpate_tracker) / 2);
    palpate_tracker *one = malloc(sizeof *one);
    void *small = malloc(bytes + 1);
    palpate_status status;
    switch (any(7)) {
    case 0: status = palpate_start(one, sizeof *one, no_body); break;
    case 1: status = palpate_start(one, sizeof *one, NULL); break;
    case 2: status = palpate_start(NULL, sizeof *one, &body); break;
    case 3: status = palpate_start(small, bytes, &body); break;
    case 4: status = palpate_start_on(one, sizeof *one, &body, info.faces + any(1u << 20), 0.5f, 0.5f); break;
    case 5: status = palpate_start_on(one, sizeof *one, &body, 0, bad_float(), 0.5f); break;
    default: status = palpate_start(ASKEW(one), sizeof *one, &body); break;
    }
    free(one);
    free(small);
    free(no_body);
    return status;
}

static palpate_status bad_pair(void)
{
    palpate_pair *one = malloc(sizeof *one);
    palpate_apart apart;
    palpate_pose spoiled = pose;
    ((float *)&spoiled)[any(sizeof spoiled / sizeof(float))] = bad_float();
    void *no_pair = no_handle(&pair, sizeof pair);
    palpate_status status;
    switch (any(7)) {
    case 0: status = palpate_pair_step(&pair, &spoiled, &apart); break;
    case 1: status = palpate_pair_step(&pair, NULL, &apart); break;
    case 2: status = palpate_pair_step(&pair, &pose, NULL); break;
    case 3: status = palpate_pair_step(no_pair, &pose, &apart); break;
    case 4: status = palpate_pair_start(one, sizeof *one, &body, info.faces + any(9), &body, 0); break;
    case 5: status = palpate_pair_start(one, any(sizeof *one / 2), &body, 0, &body, 0); break;
    default: status = palpate_pair_start(one, sizeof *one, &body, 0, NULL, 0); break;
    }
    free(no_pair);
    free(one);
    return status;
}

#define start_arm palpate_servo_start_serial_arm

static palpate_status bad_servo(void)
{
    palpate_servo *one = malloc(sizeof *one);
    palpate_serial_arm no_arm = arm;
    palpate_device no_device = device;
    palpate_settings no_settings = settings;
    ((float *)&no_arm)[any(sizeof arm / sizeof(float))] = bad_float();
    /* Every number of the device but the feed's ratio and what only a voltage needs must be finite. */
    ((float *)&no_device)[any(sizeof device / sizeof(float))] = NAN;
    /* Up to the timeout they are floats, and none may be NaN, whether or not it is of a feature that is on. */
    if (any(2)) {
        no_settings.friction_static = 0.4f, no_settings.friction_dynamic = 0.3f;
        no_settings.texture_share = 0.2f, no_settings.passivity_damping = 1, no_settings.passivity_resolution = 1e-4f;
        no_settings.ease_onset = 1, no_settings.ease_change = 200;
        no_settings.coupling_stiffness = 500, no_settings.coupling_damping = 3, no_settings.coupling_mass = 0.1f;
    }
    ((float *)&no_settings)[any(offsetof(palpate_settings, max_overruns) / sizeof(float))] = NAN;
    void *no_body = no_handle(&body, sizeof body);
    palpate_status status;
    switch (any(12)) {
    case 10: status = palpate_settings_recommended(&no_settings, NULL); break;
    case 0: status = start_arm(one, sizeof *one, &no_arm, &device, &body, &settings, 0); break;
    case 1: status = start_arm(one, sizeof *one, &arm, &no_device, &body, &settings, 0); break;
    case 2: status = start_arm(one, sizeof *one, &arm, &device, &body, &no_settings, 0); break;
    case 3: status = start_arm(one, sizeof *one, &arm, &device, no_body, &settings, 0); break;
    case 4: status = start_arm(one, any(sizeof *one / 2), &arm, &device, &body, &settings, 0); break;
    case 5: status = start_arm(one, sizeof *one, &arm, &device, &body, &settings, 9 + any(9)); break;
    case 6: status = start_arm(one, sizeof *one, NULL, &device, &body, &settings, 0); break;
    case 7: status = start_arm(one, sizeof *one, &arm, NULL, &body, &settings, 0); break;
    case 8: status = start_arm(one, sizeof *one, &arm, &device, &body, NULL, 0); break;
    case 9: status = start_arm(NULL, sizeof *one, &arm, &device, &body, &settings, 0); break;
    default: status = start_arm(ASKEW(one), sizeof *one, &arm, &device, &body, &settings, 0); break;
    }
    if (status != PALPATE_OK) {
        palpate_state state;
        if (palpate_servo_state(one, &state) != PALPATE_NOT_READY) stop("a refused loop was taken", status);
    }
    free(no_body);
    free(one);
    return status;
}

#define start_protected palpate_servo_start_serial_arm_protected

/* A number that is none, of a feature that is off, is refused by that feature's status. */
static void off_but_not_finite(void)
{
    static const struct { size_t at; palpate_status expected; } of[] = {
        {offsetof(palpate_settings, friction_stiffness), PALPATE_SETTINGS_FRICTION},
        {offsetof(palpate_settings, friction_damping), PALPATE_SETTINGS_FRICTION},
        {offsetof(palpate_settings, coupling_stiffness), PALPATE_SETTINGS_COUPLING},
        {offsetof(palpate_settings, coupling_damping), PALPATE_SETTINGS_COUPLING},
        {offsetof(palpate_settings, passivity_resolution), PALPATE_SETTINGS_PASSIVITY},
        {offsetof(palpate_settings, device_damping), PALPATE_SETTINGS_PASSIVITY},
        {offsetof(palpate_settings, device_friction), PALPATE_SETTINGS_PASSIVITY},
        {offsetof(palpate_settings, ease_onset), PALPATE_SETTINGS_EASE}};
    palpate_servo *one = malloc(sizeof *one);
    palpate_status status;
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        palpate_settings no_settings = settings;
        *(float *)((char *)&no_settings + of[i].at) = bad_float();
        status = start_arm(one, sizeof *one, &arm, &device, &body, &no_settings, 0);
        if (status != of[i].expected) stop("another refusal of a feature that is off", status);
    }
    palpate_protection none = protection;
    none.watch_signs = 0, none.inertia[any(3)] = bad_float();
    status = start_protected(one, sizeof *one, &arm, &device, &body, &settings, &none, 0);
    if (status != PALPATE_PROTECTION_INERTIA) stop("another refusal of an inertia", status);
    free(one);
}

static palpate_status bad_protection(void)
{
    palpate_servo *one = malloc(sizeof *one);
    palpate_protection none = protection;
    palpate_settings no_settings = settings;
    palpate_status status;
    switch (any(10)) {
    case 9: (any(2) ? &none.watch_signs : &none.watch_supply)[0] = 2; break;
    case 0: none.motors[any(3)].continuous = any(2) ? bad_float() : -1; break;
    case 1: none.motors[any(3)].time_constant = any(2) ? bad_float() : 1e-9f; break;
    case 2: none.max_joint_rates[any(3)] = any(2) ? NAN : 0; break;
    case 3: none.max_probe_speed = any(2) ? NAN : -1; break;
    case 4: none.inertia[any(3)] = any(2) ? bad_float() : 0; break;
    case 5: none.least_supply = none.most_supply + any(9); break;
    case 6: no_settings.texture_share = 1.5f; break;
    case 7:
        status = start_protected(one, sizeof *one, &arm, &device, &body, &settings, any(2) ? NULL : ASKEW(&none), 0);
        free(one);
        return status;
    default:
        free(one);
        return palpate_texture(NULL);
    }
    status = start_protected(one, sizeof *one, &arm, &device, &body, &no_settings, &none, 0);
    free(one);
    return status;
}

/* A mechanism that no device has, each by its own status; and a weight just above what its motor holds. */
static palpate_status bad_mechanism(void)
{
    palpate_servo *one = malloc(sizeof *one);
    palpate_serial_arm no_arm = arm;
    palpate_delta delta = {0.06f, 0.1025f, 0.0225f, 0.02557f, 0.00191f, {{0, 1}, {1, 0}, {-0.6f, -0.8f}},
                           {0, 0, 0.12f}, {0, 1, 0}, 0.17f, 0.006f};
    palpate_five_bar bar = {0.038f, {0.07f, 0.07f}, {0.09f, 0.09f}, 1, 0.09f, {0.019f, 0.1f}};
    palpate_linkage_arm linkage = {{-0.034f, {0.165f, 0.025f}, {0.034f, 0.19f}, -1, -0.1308f, {0, 9}}, 0.017f,
                                   {0.2f, 0, 0.03f}, {{0.1f, 0.03f, 0}, {0.1f, 0, 0}, {0.1f, 0.06f, 0}, {0.1f, 0.09f, 0}}};
    palpate_paddle paddle = {0.066f, 0};
    palpate_settings no_settings = settings;
    palpate_protection half = protection;
    palpate_status expected = PALPATE_DEVICE_MECHANISM, status;
    const float lengths[4] = {-0.2f, 0, 200, 0.0005f};
    /* 1 N.m holds 0.41606 kg at 0.245 m; with protection half of it. */
    no_arm.end_masses[1] = any(2) ? 0.416f : -0.416f;
    good("a weight that is held", start_arm(one, sizeof *one, &no_arm, &device, &body, &settings, 0));
    half.motors[2].continuous = 0.99f;
    if (start_protected(one, sizeof *one, &no_arm, &device, &body, &settings, &half, 0) != PALPATE_DEVICE_WEIGHT)
        stop("more than a motor holds for long", PALPATE_OK);
    no_arm = arm;
    switch (any(16)) {
    case 0: no_arm.first_link = lengths[any(4)]; goto serial;
    case 1: no_arm.second_link = lengths[any(4)]; goto serial;
    case 2: no_arm.base_height = 2.5f; goto serial;
    case 3: no_arm.workspace_centre[any(2)] = 9, expected = PALPATE_DEVICE_CENTRE; goto serial;
    case 4: no_arm.end_masses[0] = -5, expected = PALPATE_DEVICE_WEIGHT; goto serial;
    case 5: no_arm.end_masses[1] = any(2) ? 50 : 0.4162f, expected = PALPATE_DEVICE_WEIGHT; goto serial;
    case 6: delta.shin = lengths[any(4)]; goto delta;
    case 7: delta.directions[any(3)][any(2)] = 2; goto delta;
    case 8: delta.up[1] = 0; goto delta;
    case 9: delta.carried_mass = -1, expected = PALPATE_DEVICE_MASS; goto delta;
    case 10: delta.carried_mass = 17, expected = PALPATE_DEVICE_WEIGHT; goto delta;
    case 11: any(2) ? (bar.side = 0) : (bar.rods[any(2)] = lengths[any(4)]); goto five_bar;
    case 12: bar.workspace_centre[1] = 1, expected = PALPATE_DEVICE_CENTRE; goto five_bar;
    case 13: linkage.masses[2 + any(2)][0] = any(2) ? -1 : 200; goto linkage;
    case 14: paddle.mass_moment = 0.11f, expected = PALPATE_DEVICE_WEIGHT; goto paddle;
    default:
        expected = PALPATE_OUT_OF_RANGE;
        (any(2) ? any(2) ? &no_settings.between_counts : &no_settings.leave_weight : &no_settings.wait_for_homing)[0] = 7;
    }
serial:
    status = start_arm(one, sizeof *one, &no_arm, &device, &body, &no_settings, 0);
    goto end;
delta:
    status = palpate_servo_start_delta(one, sizeof *one, &delta, &device, &body, &settings, 0);
    goto end;
five_bar:
    status = palpate_servo_start_five_bar(one, sizeof *one, &bar, &device, &body, &settings, 0);
    goto end;
linkage:
    status = palpate_servo_start_linkage_arm(one, sizeof *one, &linkage, &device, &body, &settings, 0);
    expected = status == PALPATE_DEVICE_WEIGHT ? PALPATE_DEVICE_WEIGHT : PALPATE_DEVICE_MASS;
    goto end;
paddle:
    status = palpate_servo_start_paddle(one, sizeof *one, &paddle, &device, &body, &settings, 0);
end:
    if (status != expected) stop("another refusal of a mechanism", status);
    free(one);
    return status;
}

static palpate_status bad_homing(void)
{
    const palpate_reference stop_at = {0.5f, -0.4f, 0.2f, 0.1f, 3};
    palpate_homing homing = {PALPATE_BY_STOPS, 100, 2, 40000, 0, {stop_at, stop_at, stop_at}};
    palpate_servo *one = malloc(sizeof *one);
    palpate_output output;
    good("a loop", start_arm(one, sizeof *one, &arm, &device, &body, &settings, 0));
    palpate_status status;
    switch (any(10)) {
    case 9: homing.when_asked = 7; break;
    case 0: homing.by = 4 + any(1000); break;
    case 1: ((float *)&homing.joints[any(3)])[any(sizeof stop_at / sizeof(float))] = bad_float(); break;
    case 2: homing.by = 1 + any(2), homing.joints[any(3)].angle = bad_float(); break;
    case 3: homing.still_ticks = 0; break;
    case 4: homing.timeout_ticks = any(100); break;
    case 5:
        status = palpate_servo_home(any(2) ? NULL : one, any(2) ? NULL : ASKEW(&homing));
        free(one);
        return status;
    case 6: {
        const int32_t counts[3] = {0, 0, 0};
        good("a tick", palpate_servo_tick(one, counts, 3, 0, &output));
        break;
    }
    case 7:
        status = palpate_servo_index(one, 3 + any(1u << 30), 0, &output);
        free(one);
        return status;
    default:
        status = palpate_servo_index(any(2) ? NULL : one, 0, 0, any(2) ? NULL : ASKEW(&output));
        free(one);
        return status;
    }
    status = palpate_servo_home(one, &homing);
    free(one);
    return status;
}

static palpate_status bad_soft(void)
{
    palpate_soft_body *one = malloc(sizeof *one);
    uint32_t count = 1 + any(2);
    palpate_mode *spoiled = malloc(count * sizeof *spoiled);
    memcpy(spoiled, modes, count * sizeof *spoiled);
    size_t bytes = count * PALPATE_MODE_WORDS * sizeof(palpate_word);
    palpate_word *place = malloc(bytes);
    palpate_mode *mode = spoiled + any(count);
    void *no_body = no_handle(&body, sizeof body);
    const palpate_body *on = &body;
    float rate = 4000, q[PALPATE_MAX_MODES];
    palpate_status status = PALPATE_OK;
    switch (any(14)) {
    case 0: ((float *)mode)[any(sizeof *mode / sizeof(float))] = bad_float(); break;
    case 1: (any(2) ? &mode->limit : &mode->motion)[any(2)] = -1; break;
    case 2: mode->bump_radius = -1; break;
    case 3: (any(2) ? &mode->mass : &mode->damping)[0] = -1; break;
    case 4: mode->stiffness = any(2) ? 0 : -1; break;
    case 5: mode->mass = 1e-20f; break;
    case 6: rate = any(2) ? bad_float() : -(float)any(2); break;
    case 7: count = any(2) ? 0 : 9 + any(1u << 30); break;
    case 8: bytes = any(count * 160); break; /* a mode takes 172 */
    case 9: on = any(2) ? no_body : NULL; break;
    case 10: status = palpate_soft_body_load(one, any(sizeof *one / 2), on, spoiled, count, rate, place, bytes); break;
    case 11:
        status = palpate_soft_body_load(one, sizeof *one, on, any(2) ? NULL : ASKEW(spoiled), 1, rate, place, bytes);
        break;
    case 12:
        status = palpate_soft_body_load(one, sizeof *one, on, spoiled, 1, rate, any(2) ? NULL : ASKEW(place), bytes);
        break;
    default: status = palpate_servo_modes(any(2) ? &servo : NULL, any(2) ? q : ASKEW(q)); break;
    }
    if (status == PALPATE_OK) status = palpate_soft_body_load(one, sizeof *one, on, spoiled, count, rate, place, bytes);
    if (palpate_servo_start_serial_arm_soft(&soft_servo, sizeof soft_servo, &arm, &device, one, &settings, 0)
        == PALPATE_OK) stop("a refused soft body was taken", status);
    free(no_body);
    free(place);
    free(spoiled);
    free(one);
    return status;
}

static const palpate_dial dial = {0.02f, 1.2f};
static palpate_device motor;
static const palpate_feel feel = {
    {0.25f, 2e-3f, 0}, {0.25f, 0.02f, 1e-4f, 0.6f, -3, 3, 0.02f, 0.01f}, {0.05f, 1e-4f, 0}, {0.01f, 0, 0.01f},
    {{-1, 1}, 0.1f, 1e-4f}, 1e-4f, {1e-3f, 5}, {0.2f, 0.3f, 1e-3f}};

/* A loop of a dial, ticked anywhere. */
static void turn(void)
{
    palpate_output output;
    palpate_turned turned;
    good("a dial", palpate_servo_start_dial(&dial_servo, sizeof dial_servo, &dial, &motor, &feel, &settings, 0));
    for (int32_t i = 0; i < 400; i++) {
        good("a tick of a dial", palpate_servo_tick(&dial_servo, &i, 1, 1, &output));
        good("a part of a feel", palpate_servo_set_feel(&dial_servo, any(9), &feel, NULL));
        good("its damping", palpate_servo_set_feel(&dial_servo, PALPATE_FEEL_DAMPING, &feel, NULL));
    }
    good("where it is", palpate_servo_dial(&dial_servo, &turned));
}

/* Either limit of the torque has its status and its number. */
static void too_much_torque(void)
{
    static const struct { float full; palpate_status expected; float limit; } of[] = {
        {-0.06f, PALPATE_KNOB_MOTOR, 0.06f}, {1, PALPATE_KNOB_MAX_TORQUE, 5 * 0.02f}};
    const palpate_feel much = {.spring = {0.01f, 0, 0.5f}}, none = {.damping = 1e-4f};
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        palpate_device one = motor;
        palpate_beyond beyond = {0, 0};
        one.joints[0].torque_at_full = of[i].full;
        good("a dial", palpate_servo_start_dial(&dial_servo, sizeof dial_servo, &dial, &one, &none, &settings, 0));
        palpate_status status = palpate_servo_set_feel(&dial_servo, PALPATE_FEEL_SPRING, &much, &beyond);
        if (status != of[i].expected || beyond.asked != 0.5f || fabsf(beyond.limit - of[i].limit) > 1e-8f)
            stop("another limit of the torque", status);
    }
}

static palpate_status bad_dial(void)
{
    /* Each part spoiled, and what of the whole is too much. */
    static const struct { uint32_t part; size_t at; float number; } bad[] = {
        {1, offsetof(palpate_feel, detents.pitch), 0}, {1, offsetof(palpate_feel, detents.centre), 7},
        {2, offsetof(palpate_feel, clicks.snap), 0.4f}, {2, offsetof(palpate_feel, clicks.pitch), 4},
        {3, offsetof(palpate_feel, texture.pitch), 1e-5f}, {3, offsetof(palpate_feel, texture.torque), -1},
        {4, offsetof(palpate_feel, spring.stiffness), -1}, {4, offsetof(palpate_feel, spring.rest), NAN},
        {5, offsetof(palpate_feel, ends.between), 2}, {5, offsetof(palpate_feel, ends.damping), -1},
        {6, offsetof(palpate_feel, damping), -1}, {6, offsetof(palpate_feel, damping), NAN},
        {7, offsetof(palpate_feel, friction.whole_at), 0}, {7, offsetof(palpate_feel, friction.torque), INFINITY},
        {8, offsetof(palpate_feel, notch.width), 4}, {8, offsetof(palpate_feel, notch.at), INFINITY},
        {4, offsetof(palpate_feel, spring.stiffness), 100}, {6, offsetof(palpate_feel, damping), 1},
        {4, offsetof(palpate_feel, spring.max_torque), 1}, {4, offsetof(palpate_feel, spring.rest), 9}};
    palpate_feel none = feel;
    palpate_dial no_dial = dial;
    palpate_device no_motor = motor;
    palpate_turned turned;
    palpate_beyond beyond;
    palpate_servo *one = malloc(sizeof *one);
    uint32_t which = any(sizeof bad / sizeof bad[0]);
    memcpy((char *)&none + bad[which].at, &bad[which].number, sizeof(float));
    palpate_status status;
    switch (any(10)) {
    case 0: status = palpate_servo_set_feel(&dial_servo, bad[which].part, &none, any(2) ? NULL : &beyond); break;
    case 1: status = palpate_servo_set_feel(&dial_servo, 9 + any(1000), &feel, any(2) ? NULL : ASKEW(&beyond)); break;
    case 2: status = palpate_servo_set_feel(any(2) ? NULL : &servo, 0, &feel, &beyond); break;
    case 3:
        status = any(2) ? palpate_servo_set_feel(&dial_servo, 1, any(2) ? NULL : ASKEW(&none), &beyond)
                        : palpate_servo_feel(any(2) ? NULL : &servo, any(2) ? &none : ASKEW(&none));
        break;
    case 4: status = palpate_servo_dial(any(2) ? NULL : &servo, &turned); break;
    case 5: status = palpate_servo_dial(&dial_servo, any(2) ? NULL : ASKEW(&turned)); break;
    default:
        /* A place is not looked at where the dial's is not known. */
        if (bad[which].number == 9) none.spring.rest = NAN;
        switch (any(5)) {
        case 0: none = feel, no_dial.radius = any(2) ? bad_float() : -(float)any(2); break;
        case 1: none = feel, no_dial.release_rate = any(2) ? bad_float() : -(float)any(2); break;
        case 2: none = feel, no_motor.joints[0].radians_per_count = 1e-3f; break;
        default: break;
        }
        status = any(2) ? palpate_servo_start_dial(one, sizeof *one, &no_dial, &no_motor, &none, &settings, 0)
                        : palpate_servo_start_dial_protected(one, any(2) ? sizeof *one : any(99), &no_dial, &no_motor,
                                                             &none, &settings, &protection, 0);
        if (palpate_servo_dial(one, &turned) != PALPATE_NOT_READY) stop("a refused dial was taken", status);
    }
    free(one);
    return status;
}

static const palpate_tool tool = {{0.004f, 0.003f, 0.009f}, 0.003f, 0.4f};
static const palpate_wrist wrist = {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, {1e-3f, 1e-3f, 1e-3f}, {0, 0, 0},
                                    {{-2, 2}, {-1, 1}, {-2, 2}}, 40};
static const int32_t at_zero[3] = {0, 0, 0};

#define start_tool palpate_servo_start_serial_arm_tool

/* A loop with a tool, ticked anywhere and turned anyhow. */
static void hold(void)
{
    palpate_output output;
    palpate_held held;
    palpate_servo *one = &tool_servo.servo;
    good("a tool", start_tool(one, sizeof tool_servo, &arm, &device, &body, &tool, &settings, 0));
    for (int i = 0; i < 400; i++) {
        const int32_t counts[3] = {(int32_t)any(200) - 100, (int32_t)any(200) - 100, (int32_t)any(200) - 100};
        const float turned[4] = {0, 0.6f, 0, any(2) ? 0.8f : -0.8f};
        good("its orientation", palpate_servo_orient(one, turned));
        good("a rigid one", palpate_servo_orient_wrist(one, NULL, counts, any(2) ? NULL : counts));
        good("no counts", palpate_servo_orient_wrist(one, &wrist, counts, NULL));
        good("a wrist", palpate_servo_orient_wrist(one, &wrist, counts, counts));
        good("its tick", palpate_servo_tick(one, counts, 3, 1, &output));
        good("its contacts", palpate_servo_held(one, &held));
    }
}

static palpate_status bad_tool(void)
{
    palpate_tool none = tool;
    palpate_settings no_settings = settings;
    palpate_tool_servo *one = malloc(sizeof *one);
    void *no_body = no_handle(&body, sizeof body);
    palpate_status status, expected = PALPATE_OK;
    switch (any(14)) {
    case 0: none.half[any(3)] = any(2) ? bad_float() : -1, expected = PALPATE_TOOL_HALF; break;
    case 1:
        none.half[0] = none.half[1] = 0, none.half[2] = any(2) ? bad_float() : -1;
        expected = PALPATE_TOOL_HALF;
        break;
    case 2: none.radius = any(2) ? bad_float() : -1, expected = PALPATE_TOOL_RADIUS; break;
    case 3: none.radius = any(2) ? 0 : 8e-5f, expected = PALPATE_TOOL_THIN; break;
    case 4: none.friction = any(2) ? bad_float() : any(2) ? -1 : 2.5f, expected = PALPATE_TOOL_FRICTION; break;
    case 5:
        (any(2) ? &no_settings.friction_static : &no_settings.friction_dynamic)[0] = 0.2f;
        expected = PALPATE_TOOL_POINT_FRICTION;
        break;
    case 6: no_settings.texture_share = 0.2f, expected = PALPATE_TOOL_TEXTURE; break;
    case 7: no_settings.coupling_mass = 0.1f, expected = PALPATE_TOOL_COUPLING; break;
    case 8:
        (any(2) ? &no_settings.stiffness : &no_settings.rate)[0] = any(2) ? bad_float() : -(float)any(2);
        expected = PALPATE_TOOL_STIFFNESS;
        break;
    case 9: {
        /* A point's memory and not a word more. */
        palpate_servo *small = malloc(sizeof *small);
        status = start_tool(small, sizeof *small, &arm, &device, &body, &tool, &settings, 0);
        free(small);
        expected = PALPATE_TOOL_MEMORY;
        goto end;
    }
    case 10: status = start_tool(&one->servo, any(99), &arm, &device, &body, &tool, &settings, 0); goto end;
    case 11: status = start_tool(&one->servo, sizeof *one, &arm, &device, no_body, &tool, &settings, 0); goto end;
    case 12:
        status = palpate_servo_start_delta_tool_protected(&one->servo, sizeof *one, NULL, &device, &body, &tool,
                                                          &settings, any(2) ? &protection : NULL, 0);
        goto end;
    default:
        status = start_tool(&one->servo, sizeof *one, &arm, &device, &body, any(2) ? NULL : ASKEW(&none), &settings, 0);
        goto end;
    }
    status = any(2) ? start_tool(&one->servo, sizeof *one, &arm, &device, &body, &none, &no_settings, 0)
                    : palpate_servo_start_serial_arm_tool_protected(&one->servo, sizeof *one, &arm, &device, &body,
                                                                    &none, &no_settings, &protection, 0);
    palpate_held held;
    if (palpate_servo_held(&one->servo, &held) != PALPATE_NOT_READY) stop("a refused tool was taken", status);
end:
    if (expected != PALPATE_OK && status != expected) stop("another refusal of a tool", status);
    free(no_body);
    free(one);
    return status;
}

static palpate_status bad_orientation(void)
{
    palpate_servo *one = &tool_servo.servo, *point = any(2) ? &servo : &dial_servo;
    float turned[4] = {0, 0, 0, 1};
    palpate_wrist no_wrist = wrist;
    palpate_held held;
    int32_t counts[3] = {0, 0, 0};
    palpate_status expected = PALPATE_OK, status;
    switch (any(11)) {
    case 0: turned[any(4)] = bad_float(), status = palpate_servo_orient(one, turned), expected = PALPATE_NOT_FINITE; break;
    case 1:
        turned[3] = any(2) ? 0 : 1.01f;
        status = palpate_servo_orient(one, turned), expected = PALPATE_TOOL_ROTATION;
        break;
    case 2: status = palpate_servo_orient(any(2) ? NULL : one, any(2) ? NULL : ASKEW(turned)); break;
    case 3:
        status = any(2) ? palpate_servo_orient(point, turned)
                        : any(2) ? palpate_servo_orient_wrist(point, any(2) ? NULL : &wrist, counts, counts)
                                 : palpate_servo_held(point, &held);
        expected = PALPATE_TOOL_NONE;
        break;
    case 4:
        switch (any(5)) {
        case 0: no_wrist.axes[any(3)][any(3)] = any(2) ? bad_float() : 2; break;
        case 1: memcpy(no_wrist.axes[1], no_wrist.axes[any(2) * 2], sizeof no_wrist.axes[1]); break;
        case 2: (any(2) ? no_wrist.radians_per_count : no_wrist.angle_at_line)[any(3)] = bad_float(); break;
        case 3: no_wrist.range[any(3)][0] = any(2) ? bad_float() : 9; break;
        default: no_wrist.max_rate = any(2) ? bad_float() : -(float)any(2); break;
        }
        status = palpate_servo_orient_wrist(one, &no_wrist, counts, any(2) ? NULL : counts);
        expected = PALPATE_WRIST_NUMBERS;
        break;
    case 5:
        counts[any(3)] = any(2) ? 5000 : INT32_MIN;
        status = palpate_servo_orient_wrist(one, &wrist, at_zero, counts), expected = PALPATE_WRIST_RANGE;
        break;
    case 6:
        good("forgotten", palpate_servo_orient_wrist(one, &wrist, at_zero, NULL));
        good("counts", palpate_servo_orient_wrist(one, &wrist, at_zero, counts));
        counts[any(3)] = 500;
        status = palpate_servo_orient_wrist(one, &wrist, at_zero, counts), expected = PALPATE_WRIST_JUMP;
        break;
    case 7: status = palpate_servo_orient_wrist(one, any(2) ? NULL : &wrist, any(2) ? NULL : ASKEW(counts), counts); break;
    case 8: status = palpate_servo_orient_wrist(one, ASKEW(&wrist), at_zero, counts); break;
    case 9: status = palpate_servo_held(any(2) ? NULL : one, any(2) ? NULL : ASKEW(&held)); break;
    default: {
        /* Moved, or its body is gone. */
        palpate_tool_servo *other = malloc(sizeof *other);
        palpate_body *gone = malloc(sizeof *gone);
        void *place = malloc(info.buffer_bytes);
        good("a body", palpate_body_load(gone, sizeof *gone, file, file_bytes, place, info.buffer_bytes));
        good("a tool", start_tool(&other->servo, sizeof *other, &arm, &device, gone, &tool, &settings, 0));
        good("its orientation", palpate_servo_orient(&other->servo, turned));
        if (any(2)) memset(gone, 0, sizeof *gone);
        else memcpy(&tool_servo, other, sizeof *other), free(other), other = &tool_servo;
        status = any(2) ? palpate_servo_orient(&other->servo, turned) : palpate_servo_held(&other->servo, &held);
        expected = PALPATE_NOT_READY;
        if (other != &tool_servo) free(other);
        free(place);
        free(gone);
        good("a tool", start_tool(one, sizeof tool_servo, &arm, &device, &body, &tool, &settings, 0));
    }
    }
    if (expected != PALPATE_OK && status != expected) stop("another refusal of an orientation", status);
    return status;
}

static palpate_status bad_tick(void)
{
    const int32_t counts[3] = {0, 0, 0};
    palpate_output output;
    palpate_state state;
    uint8_t frame[PALPATE_MAX_FRAME];
    size_t written;
    memset(&output, 0xff, sizeof output);
    void *no_servo = no_handle(&servo, sizeof servo);
    palpate_status status;
    switch (any(11)) {
    case 0: status = palpate_servo_tick(no_servo, counts, 3, 1, &output); break;
    case 1: status = palpate_servo_tick(&servo, NULL, 3, 1, &output); break;
    case 2: status = palpate_servo_tick(&servo, counts, any(3), 1, &output); break;
    case 3: status = palpate_servo_tick(&servo, counts, 4 + (size_t)any(1u << 30), 1, &output); break;
    case 4: status = palpate_servo_tick(NULL, counts, 3, 1, &output); break;
    case 5: status = palpate_servo_tick(&servo, ASKEW(counts), 3, 1, &output); break;
    case 6: free(no_servo); return palpate_servo_tick(&servo, counts, 3, 1, NULL);
    case 7: free(no_servo); return palpate_servo_note(&servo, 8 + any(1000), &output);
    case 8: free(no_servo); return palpate_servo_state(any(2) ? NULL : &servo, any(2) ? NULL : ASKEW(&state));
    case 9: {
        uint32_t short_frame = any(20);
        uint8_t *small = malloc(short_frame + 1);
        status = palpate_servo_report(&servo, 0, small, short_frame, &written);
        free(small);
        free(no_servo);
        return status;
    }
    default:
        free(no_servo);
        return palpate_servo_report(any(2) ? NULL : &servo, 0, any(2) ? NULL : frame, sizeof frame, NULL);
    }
    if (output.drives != 0 || output.duties[0] != 0) stop("a refused tick drives", status);
    free(no_servo);
    return status;
}

static palpate_status bad_receiver(void)
{
    palpate_heard heard;
    void *none = no_handle(&receiver, sizeof receiver);
    palpate_status status;
    switch (any(4)) {
    case 0: status = palpate_receiver_feed(none, 1, &heard); break;
    case 1: status = palpate_receiver_feed(&receiver, 1, NULL); break;
    case 2: status = palpate_receiver_start(NULL, sizeof receiver); break;
    default: status = palpate_receiver_start(none, any(sizeof receiver / 2)); break;
    }
    free(none);
    return status;
}

int main(int count, char **arguments)
{
    if (count != 3) return 2;
    FILE *from = fopen(arguments[1], "rb");
    if (!from) return 2;
    file = aligned_alloc(8, 1 << 20);
    file_bytes = fread(file, 1, 1 << 20, from);
    fclose(from);
    unsigned long calls = strtoul(arguments[2], NULL, 10);

    for (int joint = 0; joint < 3; joint++) {
        const palpate_joint one = {1e-4f, 0, 1, 0.01f, -2, 2, {0, 0, 0, 0, 0, 0}};
        device.joints[joint] = one;
    }
    device.min_margin = 0.05f, device.max_joint_rate = 25, device.max_force = 5;
    device.max_stiffness = 1000, device.max_damping = 8;
    good("settings", palpate_settings_default(&settings));
    good("texture", palpate_texture(smooth));
    good("head", palpate_file_head(file, file_bytes, &info));
    buffer = malloc(info.buffer_bytes);
    good("load", palpate_body_load(&body, sizeof body, file, file_bytes, buffer, info.buffer_bytes));
    good("start", palpate_start(&tracker, sizeof tracker, &body));
    good("pair", palpate_pair_start(&pair, sizeof pair, &body, 0, &body, 0));
    good("servo", start_arm(&servo, sizeof servo, &arm, &device, &body, &settings, 0));
    good("soft", palpate_soft_body_load(&soft, sizeof soft, &body, modes, 2, settings.rate, room, sizeof room));
    off_but_not_finite();
    press();
    const palpate_joint shaft = {6.2831853f / 4000, 0, 0.06f, 0, -INFINITY, INFINITY, {0, 0, 0, 0, 0, 0}};
    motor = device, motor.joints[0] = shaft, motor.min_margin = 0.01f, motor.max_stiffness = 4000,
    motor.max_joint_rate = 120;
    too_much_torque();
    turn();
    hold();
    good("receiver", palpate_receiver_start(&receiver, sizeof receiver));
    use(&body);

    palpate_status (*const ways[])(void) = {spoiled_file, bad_load, bad_info, bad_probe, bad_start,
                                            bad_pair, bad_servo, bad_protection, bad_mechanism, bad_homing, bad_soft, bad_dial,
                                            bad_tool, bad_orientation,
                                            bad_tick, bad_receiver};
    unsigned long of[128] = {0}, refused = 0;
    while (refused < calls) {
        uint32_t way = any(sizeof ways / sizeof ways[0]);
        unsigned before = accepted;
        palpate_status status = ways[way]();
        if (accepted != before) continue;
        if (status <= PALPATE_OK || status >= 128) {
            printf("hammer: way %u was not refused: %d\n", way, (int)status);
            return 1;
        }
        of[status]++;
        refused++;
    }
    /* What is good still is. */
    use(&body);
    press();
    turn();
    hold();
    for (int status = 1; status < 128; status++) {
        if (of[status]) printf("  %7lu  %s\n", of[status], palpate_status_text(status));
    }
    printf("hammer: %lu calls with bad arguments, an error code each; %u files that differ were good ones\n", refused,
           accepted);
    free(buffer);
    free(file);
    return 0;
}
