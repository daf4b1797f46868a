/* servo.c on a PC, with a simulated arm instead of a board: each joint is an inertia in a hand, which draws the probe
   down into the box. Prints how hard the box pushes in the end. */
#include "../servo.c"
#include <math.h>
#include <stdio.h>

#define TICKS 8000

static float angles[DEVICE_JOINTS], speeds[DEVICE_JOINTS];
static int32_t duties[DEVICE_JOINTS], tick;

int board_counts(int32_t *counts)
{
    for (int joint = 0; joint < DEVICE_JOINTS; joint++) {
        const palpate_joint *of = &DEVICE.joints[joint];
        counts[joint] = (int32_t)floorf((angles[joint] - of->angle_at_line) / of->radians_per_count);
    }
    return 1;
}

int board_enable(void)
{
    return tick >= 400;
}

void board_drive(const int32_t *given)
{
    for (int joint = 0; joint < DEVICE_JOINTS; joint++) duties[joint] = given[joint];
}

void board_off(void)
{
    for (int joint = 0; joint < DEVICE_JOINTS; joint++) duties[joint] = 0;
}

/* Semi-implicit Euler; the hand has 10 N m/rad and 0.5 N m s/rad. */
static void simulate(float rate)
{
    const float hand[DEVICE_JOINTS] = {0, 0, tick < 4000 ? 2e-5f * (float)tick : 0.08f};
    for (int joint = 0; joint < DEVICE_JOINTS; joint++) {
        float torque = (float)duties[joint] / 32767.0f * DEVICE.joints[joint].torque_at_full;
        torque += 10.0f * (hand[joint] - angles[joint]);
        torque -= 0.5f * speeds[joint];
        speeds[joint] += torque / PROTECTION.inertia[joint] / rate;
        angles[joint] += speeds[joint] / rate;
    }
}

int main(void)
{
    float rate;
    palpate_state state;
    palpate_status status = servo_start(&rate);
    for (; status == PALPATE_OK && tick < TICKS; tick++) {
        servo_tick(0);
        simulate(rate);
        status = palpate_servo_state(&servo, &state);
    }
    if (status != PALPATE_OK) {
        fprintf(stderr, "palpate: %s\n", palpate_status_text(status));
        return 1;
    }
    printf("fault: %s; depth %.4f mm, force %.4f N, state %08x\n", servo_fault(), -1e3 * (double)state.gap,
           (double)state.force[2], (unsigned)state.digest);
    return 0;
}
