// The loop of a haptic device whose driver gives a position and takes a force: palpate follows the closest point of the
// body in part.h, and a spring with a damper pushes along its normal. The device here is simulated.
#include <palpate.h>
#include "part.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

constexpr float rate = 4000.0f, stiffness = 500.0f, damping = 2.0f, max_force = 3.0f, soft_start_s = 0.2f;

constexpr float top[3] = PART_TOP;

// Your driver's two calls instead. A grip of 100 g in a hand, which draws it from above the part down to 10 mm inside.
struct Device {
    float at[3] = {top[0], top[1], top[2] + 0.02f}, moves[3] = {0, 0, 0};

    void position(float (&probe)[3]) const { std::copy(at, at + 3, probe); }

    void force(const float (&given)[3]) {
        const float hand[3] = {top[0], top[1], top[2] - 0.01f};
        for (int i = 0; i < 3; i++) {
            moves[i] += (given[i] + 300.0f * (hand[i] - at[i]) - 8.0f * moves[i]) / (0.1f * rate);
            at[i] += moves[i] / rate;
        }
    }
};

static void must(palpate_status status) {
    if (status == PALPATE_OK) return;
    std::fprintf(stderr, "palpate: %s\n", palpate_status_text(status));
    std::exit(1);
}

int main() {
    static palpate_body body;
    static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(PART_FACES, PART_EDGES)];
    palpate_tracker tracker;
    must(palpate_body_load(&body, sizeof body, part_palp, sizeof part_palp, buffer, sizeof buffer));
    must(palpate_start(&tracker, sizeof tracker, &body));

    Device device;
    float last[3], velocity[3] = {0, 0, 0}, depth = 0, push = 0;
    device.position(last);
    for (int tick = 0; tick < 2 * rate; tick++) {
        float probe[3], force[3] = {0, 0, 0};
        device.position(probe);
        palpate_touch touch;
        const palpate_status status = palpate_step(&tracker, probe, &touch);
        // Low-pass of 80 Hz: a difference alone makes a buzz of the position's last digit.
        for (int i = 0; i < 3; i++) velocity[i] += 0.112f * ((probe[i] - last[i]) * rate - velocity[i]);
        std::copy(probe, probe + 3, last);
        // No force where the point is not known, or was left behind.
        if (status == PALPATE_OK && touch.contact == 2 && !touch.unexplained && touch.gap < 0) {
            float along = 0;
            for (int i = 0; i < 3; i++) along += velocity[i] * touch.normal[i];
            const float fade = std::min(1.0f, tick / (soft_start_s * rate));
            depth = -touch.gap;
            push = fade * std::min(std::max(stiffness * depth - damping * along, 0.0f), max_force);
            for (int i = 0; i < 3; i++) force[i] = push * touch.normal[i];
        }
        device.force(force);
    }
    // Two springs in line: 300 N/m x 10 mm / (300 + 500) N/m.
    std::printf("depth %.4f mm, force %.4f N\n", 1e3f * depth, push);
}
