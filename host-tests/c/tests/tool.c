/* A loop with a tool that has a shape, replayed: prints of each tick a hash of the state, whether contacts are located and
   why they are given up, the orientation, and what came of telling it.

   tool FILE.palp STREAM plain|protected

   STREAM: tool and origin of the body; then of each tick three counts, enable, how the orientation is told (0 not, 1 a
   quaternion, 2 wrist, 3 wrist without counts, 4 rigid), a quaternion, and three counts of the wrist. */
#include "device.h"
#include "replayed.h"
#include <string.h>

static palpate_body body;
static palpate_tool_servo room;

/* Yaw, pitch and roll, 4,096 counts a turn. */
static const palpate_wrist gimbal = {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                     {6.28318530718f / 4096, 6.28318530718f / 4096, 6.28318530718f / 4096}, {0.01f, -0.02f, 0.03f},
                                     {{-2.5f, 2.5f}, {-1.2f, 1.2f}, {-2.6f, 2.6f}}, 40};

int main(int count, char **arguments)
{
    if (count != 4) return 2;
    size_t file_bytes, bytes;
    const uint8_t *file = contents(arguments[1], &file_bytes);
    const uint8_t *at = contents(arguments[2], &bytes), *const end = at + bytes;
    palpate_tool tool;
    palpate_settings settings;
    good(device_settings(&settings));
    memcpy(&tool, at, sizeof tool), at += sizeof tool;
    memcpy(settings.body_origin, at, sizeof settings.body_origin), at += sizeof settings.body_origin;
    palpate_file_info info;
    good(palpate_file_head(file, file_bytes, &info));
    void *buffer = malloc(info.buffer_bytes);
    good(palpate_body_load(&body, sizeof body, file, file_bytes, buffer, info.buffer_bytes));
    palpate_servo *servo = &room.servo;
    if (strcmp(arguments[3], "plain")) {
        palpate_protection protection = PROTECTION;
        protection.watch_signs = 0;
        good(palpate_servo_start_serial_arm_tool_protected(servo, sizeof room, &MECHANISM, &DEVICE, &body, &tool,
                                                           &settings, &protection, PALPATE_RESET_POWER_ON));
    } else {
        good(palpate_servo_start_serial_arm_tool(servo, sizeof room, &MECHANISM, &DEVICE, &body, &tool, &settings,
                                                 PALPATE_RESET_POWER_ON));
    }
    palpate_state state = {0};
    while (at < end) {
        struct { int32_t counts[3]; uint32_t enable, way; float quaternion[4]; int32_t wrist[3]; } tick;
        memcpy(&tick, at, sizeof tick), at += sizeof tick;
        palpate_status told = PALPATE_OK;
        switch (tick.way) {
        case 1: told = palpate_servo_orient(servo, tick.quaternion); break;
        case 2: told = palpate_servo_orient_wrist(servo, &gimbal, tick.counts, tick.wrist); break;
        case 3: told = palpate_servo_orient_wrist(servo, &gimbal, tick.counts, NULL); break;
        case 4: told = palpate_servo_orient_wrist(servo, NULL, tick.counts, NULL); break;
        }
        palpate_output output;
        palpate_held held;
        good(palpate_servo_tick(servo, tick.counts, 3, tick.enable, &output));
        good(palpate_servo_state(servo, &state));
        good(palpate_servo_held(servo, &held));
        printf("%08x %u %u", (unsigned)state.digest, (unsigned)held.located, (unsigned)held.given_up);
        for (int i = 0; i < 4; i++) printf(" %.9g", (double)held.orientation[i]);
        printf(" %s\n", palpate_status_text(told));
    }
    printf("force %.9g %.9g %.9g %s\n", (double)state.force[0], (double)state.force[1], (double)state.force[2],
           palpate_fault_text(state.fault));
    return 0;
}
