// Follows the closest point of a body with a probe that circles above it, and prints how far off the surface is.
// part.h holds the body: `palpate bake part.step --out part.h` writes yours.
#include <palpate.h>
#include "part.h"

static palpate_body body;
static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(PART_FACES, PART_EDGES)];
static palpate_tracker tracker;
static const float top[3] = PART_TOP;

static void must(palpate_status status) {
  if (status == PALPATE_OK) return;
  Serial.println(palpate_status_text(status));
  while (true) {}
}

void setup() {
  Serial.begin(115200);
  must(palpate_body_load(&body, sizeof body, part_palp, sizeof part_palp, buffer, sizeof buffer));
  must(palpate_start(&tracker, sizeof tracker, &body));
}

void loop() {
  static float angle = 0.0f;
  angle += 0.01f;
  const float probe[3] = {top[0] + 0.02f * cosf(angle), top[1] + 0.02f * sinf(angle), top[2] + 0.02f};
  palpate_touch touch;
  must(palpate_step(&tracker, probe, &touch));
  Serial.println(touch.gap * 1000.0f); // millimetres
}
