// The loop in time: how many ticks a frame owes, and what moves the stylus in them.

import { BEHIND } from "firmware";
import { number, pace } from "choices";
import { Presence, stroll } from "stroll";

/** Seconds in which a stroll that begins has gone two thirds of its way from where the stylus was. */
const EASE = 0.12;

export class Loop {
  constructor(room, pointer) {
    Object.assign(this, { room, pointer });
    Object.assign(this, { clock: 0, owed: 0, strolls: true, stands: false, nanoseconds: 0 });
    this.presence = new Presence(room.canvas);
    /** While it is set, no frame moves anything: only a script does. */
    this.paused = false;
  }

  /** Begins on another device. */
  begin(device) {
    this.device = device;
    this.lift();
    this.strolls = true;
    this.stands = false;
  }

  /** Puts the hand over the body. */
  lift() {
    const { front } = this.room;
    this.place = this.room.unplace(front.clone().multiplyScalar(0.9 + this.pointer.reach(front)));
    this.device.restart(this.place);
  }

  /** A reader has taken the stylus. */
  taken() {
    this.strolls = this.stands = false;
    // A slider is no part of the picture.
    this.presence.come(this.presence.here);
  }

  /** Puts the stylus to a place of the room, unless it is near, in sizes of the body; contact begins anew there. */
  put(place, near) {
    if (this.room.place(this.place).distanceTo(place) <= near) return;
    this.place = this.room.unplace(place);
    this.device.restart(this.place);
  }

  /** So many seconds of a frame; the projection errors of its ticks. */
  advance(seconds) {
    if (this.stands || this.paused) return [];
    if (this.presence.isLong(seconds) && !this.pointer.held) this.strolls = true;
    this.owed += seconds * pace() * number("rate");
    const ticks = Math.floor(this.owed);
    this.owed -= ticks;
    this.clock += seconds * pace();
    if (ticks === 0) return [];
    this.place = this.next(seconds);
    const began = performance.now();
    this.device.run(ticks, this.place, !this.pointer.held);
    const took = ((performance.now() - began) * 1e6) / ticks;
    this.nanoseconds = this.nanoseconds ? this.nanoseconds + 0.05 * (took - this.nanoseconds) : took;
    return this.device.errors();
  }

  next(seconds) {
    if (this.strolls) return this.ease(seconds);
    return this.pointer.towards(this.place, seconds, this.device.view().contact === BEHIND);
  }

  // From wherever the stylus is to where it strolls.
  ease(seconds) {
    const to = stroll(this.device, this.room, this.clock, this.pointer.reach),
      share = 1 - Math.exp(-seconds / EASE);
    return this.place.map((coordinate, axis) => coordinate + (to[axis] - coordinate) * share);
  }

  /** Puts the stylus to a place, metres in the frame of the tables, in so many ticks, and holds it there. */
  hold(place, ticks) {
    this.strolls = false;
    this.place = place;
    this.pointer.hold(place);
    this.device.run(ticks, place, false);
  }

  /**
   * A stroll from a time on, s, that comes to rest and stands there until a reader takes the stylus; the projection
   * errors of its ticks.
   */
  show(time) {
    const errors = [];
    this.clock = time;
    for (let step = 0; step < 60; step += 1) {
      this.clock += 1 / 60;
      this.place = this.ease(1 / 60);
      this.device.run(67, this.place);
      errors.push(...this.device.errors());
    }
    this.pointer.hold(this.place);
    for (let count = 0; count < 30; count += 1) this.device.run(100, this.place);
    this.strolls = false;
    this.stands = true;
    return errors;
  }
}
