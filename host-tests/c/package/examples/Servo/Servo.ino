// A board for servo.c. Write your encoders and motors into the first four functions; until then the loop stops with a
// fault. On a Teensy the loop runs in a timer's interrupt, elsewhere in loop(), less steadily.
#include <palpate.h>
#include "board.h"

int board_counts(int32_t *) { return 0; }
int board_enable() { return digitalRead(2) == LOW; } // a button to ground, held
void board_drive(const int32_t *) {}
void board_off() {}

static float rate;

#ifdef TEENSYDUINO
static IntervalTimer timer;
static void on_timer() {
  static bool late = false;
  const uint32_t start = micros();
  servo_tick(late);
  late = micros() - start > (uint32_t)(1e6f / rate);
}
static bool starts() {
  timer.priority(64); // above USB and serial ports, below the clock of micros()
  return timer.begin(on_timer, 1e6f / rate);
}
void loop() {
  Serial.println(servo_fault());
  delay(1000);
}
#else
static bool starts() { return true; }
void loop() {
  static uint32_t next = micros(), ticks = 0;
  const uint32_t period = (uint32_t)(1e6f / rate), late = micros() - next;
  if ((int32_t)late < 0) return;
  servo_tick(late > period);
  next = late > period ? micros() + period : next + period;
  if (++ticks % 4000 == 0) Serial.println(servo_fault());
}
#endif

void setup() {
  board_off();
  pinMode(2, INPUT_PULLUP);
  Serial.begin(115200);
  const palpate_status status = servo_start(&rate);
  if (status == PALPATE_OK && starts()) return;
  while (true) Serial.println(status == PALPATE_OK ? "no timer is free" : palpate_status_text(status));
}
