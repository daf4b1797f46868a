/* A dial that is turned, released and turned on: place, detent and parts of its feel are by one angle, and what a person
   does not move does not jump. Prints nothing. */
#include "palpate.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const palpate_dial dial = {.radius = 0.02f, .release_rate = 1.2f};
static const palpate_device device = {
    .joints = {{.radians_per_count = 6.2831853f / 16384, .torque_at_full = 0.063f, .dry_friction = 2e-3f,
                .least_angle = -INFINITY, .greatest_angle = INFINITY}},
    .min_margin = 0.01f, .max_joint_rate = 120, .max_force = 2.8f, .max_stiffness = 4000, .max_damping = 8};
static palpate_servo servo;
static palpate_turned turned;
static int32_t counts;
static uint32_t force;

static void demand(int is_so, const char *what)
{
    if (is_so) return;
    printf("%s: turns %d, angle %g, detent %d of counts %d\n", what, (int)turned.turns, (double)turned.angle,
           (int)turned.detent, (int)counts);
    exit(1);
}

static void good(palpate_status status)
{
    demand(status == PALPATE_OK, palpate_status_text(status));
}

/* One tick; the middle of the count is where the dial is. */
static void tick(double pitch)
{
    palpate_output output;
    palpate_state state;
    good(palpate_servo_tick(&servo, &counts, 1, force, &output));
    good(palpate_servo_dial(&servo, &turned));
    good(palpate_servo_state(&servo, &state));
    demand(output.fault == 0, "a fault");
    const double tau = 6.283185307179586, place = (counts + 0.5) * tau / 16384;
    /* A rounding of 30 rad. */
    demand(fabs(turned.turns * tau + (double)turned.angle - place) < 4e-6, "another place");
    const double pitches = (double)turned.angle / pitch;
    /* Where two are equally near, a rounding decides. */
    demand(fabs(turned.detent - pitches) < 0.5 + 1e-4, "another detent");
}

/* Ticks without motion: after the first of them nothing is another. */
static void rest(int ticks, double pitch)
{
    const palpate_turned before = turned;
    for (; ticks > 0; ticks--) {
        tick(pitch);
        demand(turned.turns == before.turns && turned.angle == before.angle && turned.detent == before.detent, "a jump");
    }
}

/* From a count on, by 2.18 turns, with a feel. */
static void turn(int32_t from, palpate_feel feel, double pitch)
{
    palpate_settings settings;
    palpate_feel before, after;
    palpate_beyond beyond = {0};
    good(palpate_settings_default(&settings));
    settings.rate = 4000, settings.max_force = device.max_force;
    good(palpate_servo_start_dial(&servo, sizeof servo, &dial, &device, &feel, &settings, 0));
    counts = from, force = 1;
    tick(pitch);
    rest(4000, pitch);
    for (int at = 0; at < 35717; at++) counts++, tick(pitch);
    for (int press = 0; press < 3; press++) {
        rest(400, pitch);
        good(palpate_servo_feel(&servo, &before));
        force = press % 2;
        rest(4000, pitch);
        good(palpate_servo_feel(&servo, &after));
        demand(memcmp(&before, &after, sizeof before) == 0, "another feel");
        /* The angle that is read is the one that is set. */
        const float angle = turned.angle;
        feel.spring = (palpate_spring){.stiffness = 0.1f, .rest = angle + 0.1f, .max_torque = 0.02f};
        good(palpate_servo_set_feel(&servo, PALPATE_FEEL_SPRING, &feel, &beyond));
        rest(400, pitch);
        const double asked = 0.1 * 0.1 - (double)feel.detents.torque * sin((double)angle * 6.283185307179586 / pitch)
                             - (double)feel.clicks.stiffness * ((double)angle - turned.detent * pitch);
        /* Roundings of 14 rad by 0.4 N·m/rad. */
        if (force) demand(fabs((double)turned.torque - asked) < 2e-6, "another torque");
        feel.spring.rest = angle + 0.8f;
        demand(palpate_servo_set_feel(&servo, PALPATE_FEEL_SPRING, &feel, &beyond) == PALPATE_KNOB_FAR
                   && fabs((double)beyond.asked - 0.8) < 2e-6, "not too far");
        good(palpate_servo_set_feel(&servo, PALPATE_FEEL_SPRING, &(palpate_feel){.spring = {0}}, &beyond));
        rest(400, pitch);
    }
}

int main(void)
{
    const double tau = 6.283185307179586;
    const palpate_feel detents = {.detents = {.pitch = (float)(tau / 24), .torque = 0.01f}, .damping = 4e-4f};
    const palpate_feel uneven = {.detents = {.pitch = 0.25f, .torque = 0.01f}, .damping = 4e-4f};
    const palpate_feel clicks = {.clicks = {.pitch = (float)(tau / 24), .stiffness = 0.02f, .damping = 1e-4f, .snap = 0.5f,
                                            .first = -100, .last = 100, .wall_stiffness = 0.04f, .max_torque = 0.01f},
                                 .damping = 1e-4f};
    /* 0 and 6.8 rad, either way; and so far that turns are out of the angle of the joint. */
    static const int32_t starts[] = {0, 17731, -17731, -35717, 160000};
    for (int which = 0; which < 5; which++) {
        turn(starts[which], detents, tau / 24);
        turn(starts[which], uneven, (double)0.25f);
        turn(starts[which], clicks, tau / 24);
    }
    return 0;
}
