/* The loop of a dial, whose feel is changed between ticks. Prints duty and hash of the state of each tick, and what came
   of each change: in words, the number beyond its limit, and a hash of the feel that is set then.

   knob STREAM

   STREAM: mechanism, device, protection, first feel; then of each tick count, enable, and a change or none: the part's
   number, or -1, and its feel. */
#include "replayed.h"
#include <string.h>

static palpate_servo servo;

static const uint8_t *take(const uint8_t *from, void *to, size_t bytes)
{
    memcpy(to, from, bytes);
    return from + bytes;
}

static unsigned bits(float number)
{
    uint32_t word;
    memcpy(&word, &number, sizeof word);
    return word;
}

/* FNV-1a by words. */
static unsigned sum(const void *of, size_t bytes)
{
    uint32_t hash = 2166136261u, word;
    for (size_t at = 0; at < bytes; at += sizeof word) {
        memcpy(&word, (const uint8_t *)of + at, sizeof word);
        hash = (hash ^ word) * 16777619u;
    }
    return hash;
}

int main(int count, char **arguments)
{
    if (count != 2) return 2;
    size_t bytes;
    const uint8_t *at = contents(arguments[1], &bytes), *const end = at + bytes;
    palpate_dial dial;
    palpate_device device = {0};
    palpate_protection protection = {0};
    palpate_feel feel;
    palpate_settings settings;
    at = take(at, &dial, sizeof dial);
    at = take(at, &device.joints[0], offsetof(palpate_joint, feed));
    at = take(at, &device.min_margin, sizeof device - offsetof(palpate_device, min_margin));
    at = take(at, &protection.motors[0], sizeof protection.motors[0]);
    at = take(at, &protection.max_joint_rates[0], sizeof(float));
    at = take(at, &protection.max_probe_speed, sizeof(float));
    at = take(at, &feel, sizeof feel);
    good(palpate_settings_default(&settings));
    settings.rate = 4000, settings.max_force = device.max_force;

    /* A feel that is refused makes no loop. */
    const palpate_feel stiff = {.spring = {1e3f, 0, 0.01f}}, free_feel = {0};
    if (palpate_servo_start_dial(&servo, sizeof servo, &dial, &device, &stiff, &settings, 0) != PALPATE_KNOB_MAX_STIFFNESS
        || palpate_servo_set_feel(&servo, PALPATE_FEEL_FREE, &free_feel, NULL) != PALPATE_NOT_READY) return 3;
    good(palpate_servo_start_dial_protected(&servo, sizeof servo, &dial, &device, &feel, &settings, &protection, 0));
    const palpate_homing homing = {.by = PALPATE_BY_POSE, .still_ticks = 40, .still_counts = 2, .timeout_ticks = 4000};
    good(palpate_servo_home(&servo, &homing));
    palpate_output output = {0};
    palpate_turned turned = {0};
    while (at < end) {
        int32_t tick[2], part;
        at = take(at, tick, sizeof tick);
        at = take(at, &part, sizeof part);
        at = take(at, &feel, sizeof feel);
        palpate_state state;
        if (part >= 0) {
            palpate_beyond beyond = {0};
            palpate_status status = palpate_servo_set_feel(&servo, (uint32_t)part, &feel, &beyond);
            palpate_feel now;
            good(palpate_servo_feel(&servo, &now));
            printf("%s %08x %08x %08x\n", palpate_status_text(status), bits(beyond.asked), bits(beyond.limit),
                   sum(&now, sizeof now));
        }
        good(palpate_servo_tick(&servo, tick, 1, (uint32_t)tick[1], &output));
        good(palpate_servo_state(&servo, &state));
        good(palpate_servo_dial(&servo, &turned));
        printf("%d %d %08x %d %.9g %d %d\n", (int)output.drives, (int)output.duties[0], (unsigned)state.digest,
               (int)turned.turns, (double)turned.angle, (int)turned.detent, (int)turned.end);
    }
    puts(palpate_fault_text(output.fault));
    return 0;
}
