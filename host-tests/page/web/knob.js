// The knob: sliders for its feel, the simulated dial that a reader turns, and the same parts for a device on the line.

import { Device } from "firmware";
import { pace } from "choices";
import { colour } from "scheme";
import { IDLE, Presence } from "stroll";
import { free, rem } from "free";

const by = (id) => document.getElementById(id);
const DEGREE = Math.PI / 180,
  MILLI = 1e-3;
/** Ticks a second of the knob's loop. */
const RATE = 4000;
/** Without a hand the dial is turned there and back: that turn's time, s, and angle. */
const SWING = 14,
  FAR = 70 * DEGREE;
/** Places at which a turn's torque is drawn. */
const PLACES = 720;
/** How far marks and stops stand round the dial, in its radii. */
const AROUND = 1.25;
/** The sliders of the panel. */
const SLIDERS = ["pitch", "strength", "count", "stops", "hardness", "spring", "damping", "rub", "texture", "click", "click-at"];

const value = (id) => Number(by(`knob-${id}`).value);

/** What the sliders say of each part: its number in src/knob.rs, and its numbers, in radians and N·m. */
const PARTS = {
  // First: stiff parts need it.
  damping: () => [5, value("damping") * MILLI, 0, 0, 0],
  detents: () => [0, value("pitch") * DEGREE, smooth() ? value("strength") * MILLI : 0, 0, 0],
  clicks: () => {
    const count = value("count"),
      first = -Math.floor((count - 1) / 2);
    return [1, value("pitch") * DEGREE, smooth() ? 0 : value("strength") * MILLI, first, first + count - 1];
  },
  texture: () => [2, 5 * DEGREE, value("texture") * MILLI, 0, 0],
  spring: () => [3, value("spring") * MILLI, 0, 0.02, 0],
  // The last place of the slider is none.
  "end stops": () => {
    const stops = value("stops") * DEGREE;
    // Damped for the time that the torque comes late, and a little more.
    return [4, -stops, stops, isEndless() ? 0 : MILLI * value("hardness"), 1e-6 * value("hardness")];
  },
  friction: () => [6, value("rub") * MILLI, 6, 0, 0],
  click: () => [7, value("click-at") * DEGREE, 10 * DEGREE, value("click") * MILLI, 0],
};
/** Which parts a slider changes. */
const CHANGES = {
  shape: ["detents", "clicks"],
  pitch: ["detents", "clicks"],
  strength: ["detents", "clicks"],
  count: ["clicks"],
  stops: ["end stops"],
  hardness: ["end stops"],
  spring: ["spring"],
  damping: ["damping"],
  rub: ["friction"],
  texture: ["texture"],
  click: ["click"],
  "click-at": ["click"],
};

const smooth = () => by("knob-shape").value === "smooth";
const isEndless = () => value("stops") === Number(by("knob-stops").max);

export class Knob {
  constructor(page) {
    this.page = page;
    this.canvas = by("dial");
    Object.assign(this, { hand: 0, grip: null, idle: 0, clock: 0, owed: 0, view: null, curve: null });
    for (const slider of [...SLIDERS, "shape"])
      by(`knob-${slider}`).addEventListener("input", () => this.change(slider));
    const { canvas } = this;
    this.presence = new Presence(canvas);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.grip = this.angleOf(event);
      if (!this.holds()) this.hand = this.view?.angle ?? 0;
      this.idle = 0;
    });
    canvas.addEventListener("pointermove", (event) => this.turn(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => (this.grip = null));
    canvas.addEventListener("wheel", (event) => (event.preventDefault(), this.by(-Math.sign(event.deltaY) * 3 * DEGREE)), {
      passive: false,
    });
    canvas.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (way) this.by(way * 3 * DEGREE);
    });
  }

  /** Begins, the first time. */
  async begin() {
    if (this.device) return;
    this.device = await Device.bare();
    this.view = this.device.turnKnob(1, 0, true);
    this.set(Object.keys(PARTS));
    this.keep();
  }

  /** Sets what a slider changes, or puts it back to what is in force and says why beside it. */
  change(slider) {
    this.moved = slider;
    // The kind of detents that goes makes room for the other.
    const parts = () => (smooth() ? [...CHANGES[slider]].reverse() : CHANGES[slider]);
    const refusal = this.set(parts());
    if (refusal) {
      by(`knob-${slider}`).value = this.inForce[slider];
      this.set(parts());
    } else if (by("knob-live").checked) for (const part of parts()) this.page.live?.orders.set(part, PARTS[part]());
    this.keep();
    this.refuse(refusal);
  }

  /** Sets parts of the dial as the sliders say; why one is refused. */
  set(parts) {
    this.curve = null;
    try {
      for (const part of parts) this.device?.setKnob(PARTS[part]());
    } catch (error) {
      return error.message;
    }
    return "";
  }

  /** Keeps what the sliders stand on, which is in force. */
  keep() {
    this.inForce = Object.fromEntries([...SLIDERS, "shape"].map((slider) => [slider, by(`knob-${slider}`).value]));
    this.say();
  }

  /** Says beside the slider that was moved last what is wrong, or that nothing is. */
  refuse(message) {
    const said = by("knob-refusal"),
      row = by(`knob-${this.moved}`).closest("label");
    said.hidden = !message;
    if (!message) return;
    said.textContent = `${row.firstElementChild.textContent}: ${message}`;
    row.after(said);
    said.scrollIntoView({ block: "nearest" });
  }

  say() {
    const unit = { pitch: "°", strength: " mN·m", count: "", stops: "°", hardness: " mN·m/rad", spring: " mN·m/rad" };
    const others = { damping: " mN·m·s", rub: " mN·m", texture: " mN·m", click: " mN·m", "click-at": "°" };
    for (const [slider, words] of Object.entries({ ...unit, ...others })) {
      const text = slider === "stops" && isEndless() ? "none" : `${value(slider)}${words}`.replace("-", "−");
      by(`knob-${slider}`).nextElementSibling.textContent = text;
    }
    by("knob-count").disabled = smooth();
    by("knob-hardness").disabled = isEndless();
  }

  angleOf({ clientX, clientY }) {
    const { left, top, width } = this.canvas.getBoundingClientRect(),
      { x, y } = this.places().dial;
    return Math.atan2(clientX - left - (x * width) / this.canvas.width, -(clientY - top - (y * width) / this.canvas.width));
  }

  turn(event) {
    if (this.grip === null) return;
    const angle = this.angleOf(event),
      step = angle - this.grip;
    this.grip = angle;
    this.by(step - 2 * Math.PI * Math.round(step / (2 * Math.PI)));
  }

  by(angle) {
    this.hand += angle;
    this.idle = 0;
  }

  holds() {
    return this.grip !== null || this.idle < 1 || this.presence.away >= IDLE;
  }

  /** So many seconds of the loop, and the picture. */
  advance(seconds) {
    if (!this.device) return;
    if (!this.page.loop.paused) {
      this.idle += seconds;
      this.owed += seconds * pace() * RATE;
      const ticks = Math.floor(this.owed);
      this.owed -= ticks;
      if (this.presence.isLong(seconds)) {
        this.clock += seconds * pace();
        const aim = FAR * Math.sin((2 * Math.PI * this.clock) / SWING);
        this.hand += (aim - this.hand) * (1 - Math.exp(-seconds * 4));
      }
      if (ticks > 0) this.view = this.device.turnKnob(ticks, this.hand, this.holds());
    }
    this.show();
  }

  /** Holds the dial's hand at an angle, radians, for so many ticks; what is seen then. */
  hold(angle, ticks) {
    this.hand = angle;
    this.idle = this.presence.away = 0;
    this.view = this.device.turnKnob(ticks, angle, true);
    this.show();
    return this.view;
  }

  show() {
    const heard = by("knob-live").checked && this.page.live?.dial;
    const { angle, rate, torque, detent, end } = heard || this.view;
    const signed = (number, digits) => number.toFixed(digits).replace(/^-(?=0\.?0*$)/, "").replace("-", "−");
    by("knob-angle").textContent = `${signed(angle / DEGREE, 1)}°`;
    by("knob-rate").textContent = `${signed(rate, 2)} rad/s`;
    by("knob-torque").textContent = `${signed(torque / MILLI, 1)} mN·m`;
    by("knob-detent").textContent =
      signed(detent, 0) + (end ? (end > 0 ? ", beyond the upper stop" : ", beyond the lower stop") : "");
    this.draw(angle, torque, heard ? null : this.hand);
  }

  /**
   * Where the dial is drawn with what stands round it, and the plot: beside each other where the
   * dial is larger then; px of the canvas.
   */
  places() {
    const scale = this.canvas.width / Math.max(this.canvas.clientWidth, 1),
      { width, top, bottom } = free(),
      high = bottom - top - rem(),
      isLow = 0.405 * width > 0.64 * high;
    const [wide, tall] = isLow ? [0.45 * width, high] : [width, 0.64 * high];
    const radius = scale * Math.max(Math.min(0.9 * wide, tall) / (2 * AROUND), 1);
    const plot = isLow
      ? [0.48 * width, 0.97 * width, top + 0.3 * high, top + 0.7 * high]
      : [0.08 * width, 0.92 * width, top + tall + 2.2 * rem(), top + high];
    return {
      dial: { x: (scale * wide) / 2, y: scale * (top + 0.4 * rem() + tall / 2), radius },
      plot: plot.map((place) => scale * place),
    };
  }

  draw(angle, torque, hand) {
    const { canvas } = this,
      scale = Math.min(devicePixelRatio, 2),
      context = canvas.getContext("2d");
    const [width, height] = [canvas.clientWidth * scale, canvas.clientHeight * scale].map(Math.round);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    context.clearRect(0, 0, width, height);
    this.drawDial(context, angle, hand, scale);
    this.drawCurve(context, angle, torque, scale);
  }

  drawDial(context, angle, hand, scale) {
    const { x, y, radius } = this.places().dial;
    const at = (turn, far) => [x + Math.sin(turn) * radius * far, y - Math.cos(turn) * radius * far];
    const line = (turn, from, to, colour, thick) => {
      context.strokeStyle = colour;
      context.lineWidth = thick * scale;
      context.beginPath();
      context.moveTo(...at(turn, from));
      context.lineTo(...at(turn, to));
      context.stroke();
    };
    const pitch = value("pitch") * DEGREE,
      count = smooth() ? Math.floor((2 * Math.PI) / pitch) : value("count"),
      first = smooth() ? 0 : -Math.floor((count - 1) / 2);
    for (let detent = first; value("strength") && detent < first + count; detent += 1)
      line(detent * pitch, 1.08, 1.16, colour("quiet"), 2);
    if (!isEndless()) for (const side of [-1, 1]) line(side * value("stops") * DEGREE, 1.05, AROUND, colour("force"), 4);
    context.fillStyle = colour("control");
    context.strokeStyle = colour("dots");
    context.lineWidth = 2 * scale;
    context.beginPath();
    context.arc(x, y, radius, 0, 7);
    context.fill();
    context.stroke();
    line(angle, 0.35, 0.95, colour("witness"), 6);
    if (hand === null || !this.holds()) return;
    context.fillStyle = colour("ink");
    context.beginPath();
    context.arc(...at(hand, 0.82), 7 * scale, 0, 7);
    context.fill();
  }

  /** The torque of a turn around the dial's place, which rises to the left of a detent. */
  drawCurve(context, angle, torque, scale) {
    this.curve ??= this.device.knobCurve(0, PLACES);
    const [left, right, top, bottom] = this.places().plot;
    const most = Math.max(0.01, Math.min(0.056, this.curve.reduce((a, b) => Math.max(a, Math.abs(b)), 0)));
    const across = (turn) => left + (right - left) * (turn / (2 * Math.PI) + 0.5),
      up = (value) => (top + bottom) / 2 - ((bottom - top) / 2) * Math.min(Math.max(value / most, -1), 1);
    context.strokeStyle = colour("line");
    context.lineWidth = scale;
    context.strokeRect(left, top, right - left, bottom - top);
    context.beginPath();
    context.moveTo(left, up(0));
    context.lineTo(right, up(0));
    context.stroke();
    context.strokeStyle = colour("force");
    context.lineWidth = 2 * scale;
    context.beginPath();
    this.curve.forEach((value, place) => context.lineTo(across(((place / PLACES) * 2 - 1) * Math.PI), up(value)));
    context.stroke();
    const within = angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
    context.fillStyle = colour("witness");
    context.beginPath();
    context.arc(across(within), up(torque), 6 * scale, 0, 7);
    context.fill();
    context.fillStyle = colour("soft");
    context.font = `${0.86 * rem() * scale}px system-ui, sans-serif`;
    const lines = [""];
    for (const word of `torque over a turn, ±${(most / MILLI).toFixed(0)} mN·m`.split(" ")) {
      const longer = `${lines[0]} ${word}`.trim();
      if (context.measureText(longer).width < right - left) lines[0] = longer;
      else lines.unshift(word);
    }
    lines.forEach((line, above) => context.fillText(line, left, top - 6 * scale - above * 1.1 * rem() * scale));
  }
}
