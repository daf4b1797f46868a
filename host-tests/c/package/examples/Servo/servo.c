/* A whole servo loop: encoder counts in, duties out. WoodenHaptics on the body in part.h, with the rendering that is
   recommended for that device, and its protection. For yours, `cargo palpate device my.toml --out device.h`. */
#include "board.h"
#include "part.h"
#include <palpate/woodenhaptics-2016.h>

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(PART_FACES, PART_EDGES)];
static palpate_servo servo;
static volatile uint32_t fault;
static int released; /* ticks on end, up to RELEASED: a button that is held or stuck since the start gives no force */
#define RELEASED 100 /* 25 ms at 4 kHz: no bouncing contact, and no damaged reading */

palpate_status servo_start(float *rate)
{
    palpate_settings settings;
    palpate_status status = device_settings(&settings);
    if (status != PALPATE_OK) return status;
    /* The top of the part lies at `start`, 11.5 mm below the probe of a WoodenHaptics whose counts are zero. */
    const float start[3] = {0.025f, 0.0f, 0.1935f}, top[3] = PART_TOP;
    for (int i = 0; i < 3; i++) settings.body_origin[i] = start[i] - top[i];
    *rate = settings.rate;
    released = 0;
    status = palpate_body_load(&body, sizeof body, part_palp, sizeof part_palp, buffer, sizeof buffer);
    if (status != PALPATE_OK) return status;
    /* The last argument is why the chip was reset: after a watchdog the loop starts with a fault. */
    return START_DEVICE_PROTECTED(&servo, sizeof servo, &MECHANISM, &DEVICE, &body, &settings, &PROTECTION,
                                  PALPATE_RESET_UNKNOWN);
}

void servo_tick(int is_late)
{
    int32_t counts[DEVICE_JOINTS];
    palpate_output output;
    palpate_status status = PALPATE_OK;
    const int is_pressed = board_enable();
    if (released < RELEASED) released = is_pressed ? 0 : released + 1;
    if (is_late) status = palpate_servo_note(&servo, PALPATE_OVERRUN, &output);
    if (status == PALPATE_OK) {
        if (board_counts(counts)) {
            status = palpate_servo_tick(&servo, counts, DEVICE_JOINTS, (uint32_t)(is_pressed && released == RELEASED), &output);
        } else {
            status = palpate_servo_tick_without(&servo, 0, &output); /* a fault */
        }
    }
    /* Motors are on only in a tick that went well and says so. */
    if (status == PALPATE_OK && output.drives) {
        board_drive(output.duties);
    } else {
        board_off();
    }
    if (status == PALPATE_OK) fault = output.fault;
}

const char *servo_fault(void)
{
    return palpate_fault_text(fault);
}
