// What the stylus does until somebody takes it: a stroll over the body that presses in now and then.

import { Vector3 } from "three";

/** Seconds after a pointer, finger or key has left before what is shown moves by itself again. */
export const IDLE = 5;

/** Whether a reader is at a picture, and for how long nobody has been. */
export class Presence {
  constructor(canvas) {
    Object.assign(this, { here: false, away: IDLE });
    for (const name of ["pointerenter", "pointermove", "pointerdown"]) canvas.addEventListener(name, () => this.come(true));
    // A finger that is lifted leaves, too.
    for (const name of ["pointerleave", "pointercancel"]) canvas.addEventListener(name, () => this.come(false));
    for (const name of ["keydown", "wheel"]) canvas.addEventListener(name, () => this.come(this.here));
  }

  come(here) {
    Object.assign(this, { here, away: 0 });
  }

  /** Some seconds later: whether nobody has been here for long enough. */
  isLong(seconds) {
    if (!this.here) this.away += seconds;
    return !this.here && this.away >= IDLE;
  }
}

const HIGH = 0.13,
  DEEP = -0.115;

/** Where the stylus is at a time, seconds; metres, in the frame of the tables. `reach`: of its tool against a direction. */
export function stroll(device, room, time, reach) {
  const around = room.front;
  const aside = new Vector3(1, 0.2, 0).addScaledVector(around, -around.x).normalize();
  const across = around.clone().cross(aside);
  const [a, b] = [1.02 * Math.sin(0.41 * time + 0.35), 1.02 * Math.sin(0.29 * time - 0.9)];
  const angle = Math.hypot(a, b) * 0.95;
  const sideways = angle > 1e-6 ? Math.sin(angle) / Math.hypot(a, b) : 1;
  const direction = aside
    .multiplyScalar(a * sideways)
    .addScaledVector(across, b * sideways)
    .addScaledVector(around, Math.cos(angle));
  const outside = room.unplace(direction.clone());
  const { point } = device.closest(outside);
  const foot = room.place(point);
  const normal = direction.sub(foot).normalize();
  // In the air for a while, then pressed in and out again.
  const beat = 0.5 - 0.5 * Math.cos(1.15 * time);
  const height = HIGH + (DEEP - HIGH) * beat ** 1.6;
  return room.unplace(foot.addScaledVector(normal, height + reach(normal)));
}
