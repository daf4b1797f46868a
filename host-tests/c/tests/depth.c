/* A tracker whose probe goes through a body along x: prints for each tick where the gap is negative and whether that is
   too deep.

   depth FILE.palp FROM TO TICKS (m) */
#include "replayed.h"

static palpate_body body;
static palpate_tracker tracker;

int main(int count, char **arguments)
{
    if (count != 5) return 2;
    size_t bytes;
    const uint8_t *file = contents(arguments[1], &bytes);
    const float from = strtof(arguments[2], NULL), to = strtof(arguments[3], NULL);
    const int ticks = atoi(arguments[4]);
    palpate_file_info info;
    good(palpate_file_head(file, bytes, &info));
    good(palpate_body_load(&body, sizeof body, file, bytes, malloc(info.buffer_bytes), info.buffer_bytes));
    good(palpate_start(&tracker, sizeof tracker, &body));
    for (int tick = 0; tick < ticks; tick++) {
        const float probe[3] = {from + (to - from) * (float)tick / (float)ticks, 0, 0};
        palpate_touch touch;
        good(palpate_step(&tracker, probe, &touch));
        if (touch.gap < 0) printf("%.9f %u\n", (double)touch.gap, (unsigned)touch.too_deep);
    }
    return 0;
}
