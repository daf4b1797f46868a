// The firmware's code: an instance of the wasm module is a device, its exports are in src/exports.rs.

// The order of src/view.rs.
const VECTORS = ["target", "probe", "point", "normal", "force", "anchor"];
const NUMBERS = [
  "gap",
  "u",
  "v",
  "mode",
  "contact",
  "feature",
  "gain",
  "error",
  "evaluations",
  "phase",
  "fault",
  "held",
  "slips",
  "tooDeep",
  "rejected",
];

export const BEHIND = 0,
  TOUCHING = 2;
export const FACE = 0,
  EDGE = 1,
  VERTEX = 2;

/** A feature's kind and index, from its code. */
export const featureOf = (code) => ({ kind: code >> 14, index: code & 0x3fff });

export const decode = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));

let compiled;
/** The module, compiled once. */
export const module = () => (compiled ??= WebAssembly.compile(decode(document.getElementById("firmware").textContent)));

/** An instance on a body, from the bytes of its file. */
export class Device {
  static async on(bytes, place = [0, 0, 0]) {
    const device = new Device((await WebAssembly.instantiate(await module(), {})).exports);
    device.#put(bytes);
    if (device.exports.load(bytes.length, ...place) < 0) throw new Error(device.#text());
    const [faces, edges, vertices, convex, size, x, y, z, patch] = device.#numbers();
    Object.assign(device, { faces, edges, vertices, size, convex: !!convex, isPatch: !!patch, centre: [x, y, z] });
    return device;
  }

  /** An instance without a body: a knob alone. */
  static async bare() {
    return new Device((await WebAssembly.instantiate(await module(), {})).exports);
  }

  constructor(exports) {
    this.exports = exports;
  }

  /** Gives the body modes, from the bytes of their numbers. */
  soften(bytes) {
    this.#put(bytes);
    if (this.exports.soften(bytes.length / 4) < 0) throw new Error(this.#text());
  }

  /** Of each mode: q and its limit, metres, its frequency, Hz, and whether it is held. */
  modes() {
    this.exports.modes();
    const numbers = this.#numbers();
    return Array.from({ length: numbers.length / 4 }, (_, mode) => {
      const [q, limit, frequency, held] = numbers.subarray(4 * mode, 4 * mode + 4);
      return { q, limit, frequency, held: held > 0 };
    });
  }

  /** Holds a mode at some q, metres; without one, lets go of it. */
  holdMode(mode, q = NaN) {
    this.exports.hold_mode(mode, q);
  }

  /** Takes the device of a file in the hand, from its text and name, or without a text slides for the mouse; what it is. */
  hold(text, label) {
    const [name, file] = [label, text].map((words) => new TextEncoder().encode(words));
    this.#put(Uint8Array.from([...name, ...file]));
    if (this.exports.hold_device(name.length + file.length, name.length) < 0) throw new Error(this.#text());
    const [stiffness, damping, rendering, maxForce, maxStiffness, perCount, ...extents] = this.#numbers();
    const found = { name: this.#text(), stiffness, damping, rendering, maxForce, maxStiffness, perCount, extents };
    return file.length ? found : {};
  }

  /** Takes a tool in the hand: half lengths of its core and its radius, metres; with a radius of 0 the tip. */
  takeTool(half, radius) {
    if (this.exports.take_tool(...half, radius) < 0) throw new Error(this.#text());
  }

  /** Turns it towards an orientation, a quaternion. */
  turnTool(orientation) {
    this.exports.turn_tool(...orientation);
  }

  /** The tool as it is drawn, held outside of the body, its orientation in the hand, and its contacts; null of a tip. */
  tool() {
    this.exports.tool();
    const [x, y, z, ...rest] = this.#numbers();
    if (x === undefined) return null;
    const contact = (at) => ({ place: rest.slice(at, at + 3), force: rest.slice(at + 3, at + 6), gap: rest[at + 6] });
    return {
      position: [x, y, z],
      orientation: rest.slice(0, 4),
      hand: rest.slice(4, 8),
      contacts: Array.from({ length: (rest.length - 8) / 7 }, (_, index) => contact(8 + 7 * index)),
    };
  }

  /** How far what is held is from the end of its workspace: 1 well inside, 0 there. */
  workspaceMargin() {
    return this.exports.workspace_margin();
  }

  choose({ rate, stiffness, damping, friction, law, rendering }) {
    if (this.exports.choose(rate, stiffness, damping, friction, law, rendering) < 0) throw new Error(this.#text());
  }

  restart(place) {
    this.exports.restart(...place);
  }

  /** So many ticks while the pointer moves straight to a place, metres. */
  run(ticks, place, yields = true) {
    this.exports.run(ticks, ...place, yields ? 1 : 0);
  }

  view() {
    this.exports.view();
    return seen(this.#numbers());
  }

  errors() {
    this.exports.errors();
    return this.#numbers();
  }

  digest() {
    return hex(this.exports.digest());
  }

  closest(place) {
    this.exports.closest(...place);
    const [face, u, v, x, y, z, distance, evaluations, complete] = this.#numbers();
    return { face, u, v, point: [x, y, z], distance, evaluations, complete: !!complete };
  }

  face(index, steps) {
    this.exports.face(index, steps);
    return this.#numbers();
  }

  edge(index, steps) {
    this.exports.edge(index, steps);
    return this.#numbers();
  }

  isSmooth(edge) {
    return this.exports.edge_kind(edge) === 1;
  }

  sheets(code) {
    this.exports.sheets(code);
    return this.#numbers();
  }

  way(face, probe, [u, v], method) {
    this.exports.way(face, ...probe, u, v, method);
    return this.#numbers();
  }

  basinRow(face, probe, u, columns, method) {
    this.exports.basin_row(face, ...probe, u, columns, method);
    return this.#numbers();
  }

  /** Nanoseconds of a tick of the firmware alone, where the hand is. */
  nanosecondsATick(ticks = 20_000) {
    const began = performance.now();
    this.exports.tick_only(ticks);
    return ((performance.now() - began) * 1e6) / ticks;
  }

  /** Takes another body of a scene, from the bytes of its file. */
  addToReplay(bytes) {
    this.#put(bytes);
    if (this.exports.replay_body(bytes.length) < 0) throw new Error(this.#text());
  }

  /** A run on the device of these numbers, over a scene's if there are any; numbers are bytes of f32. */
  beginReplay({ settings, rendering, device, scene, linkTimeout }) {
    const parts = [new Uint8Array(Float32Array.from(settings).buffer), device, scene];
    const numbers = new Uint8Array(parts.reduce((length, part) => length + part.length, 0));
    let at = 0;
    for (const part of parts) {
      numbers.set(part, at);
      at += part.length;
    }
    this.#put(numbers);
    const begun = this.exports.replay_begin(numbers.length / 4, device.length / 4, linkTimeout, rendering);
    if (begun < 0) throw new Error(this.#text());
  }

  replay(rows) {
    this.#put(new Uint8Array(rows.buffer, rows.byteOffset, rows.byteLength));
    this.exports.replay_run(rows.length / 4);
  }

  replayView() {
    this.exports.replay_view();
    return seen(this.#numbers());
  }

  replayHash() {
    return hex(this.exports.replay_hash());
  }

  /** Bytes of a device's telemetry; the last record so far, or nothing. */
  monitor(bytes) {
    this.#put(bytes);
    if (this.exports.monitor(bytes.length) === 0) return null;
    const [tick, phase, fault, mode, contact, feature, gap, px, py, pz, fx, fy, fz, took, period, records, damaged] =
      this.#numbers();
    return {
      tick,
      phase,
      fault,
      mode,
      contact,
      feature,
      gap,
      probe: [px, py, pz],
      force: [fx, fy, fz],
      took,
      period,
      records,
      damaged,
    };
  }

  /** Sets a part of the simulated knob's feel, from its numbers. */
  setKnob(numbers) {
    if (this.exports.knob_set(...numbers) < 0) throw new Error(this.#text());
  }

  /** So many ticks of the knob while a hand turns to an angle, radians, or lets go of it. */
  turnKnob(ticks, angle, holds) {
    this.exports.knob_run(ticks, angle, holds ? 1 : 0);
    const [turned, whole, rate, torque, detent, end, phase, fault, step] = this.#numbers();
    return { angle: turned, whole, rate, torque, detent, end, phase, fault, step };
  }

  /** Its torque at so many places of a turn around an angle. */
  knobCurve(middle, count) {
    this.exports.knob_curve(middle, count);
    return this.#numbers();
  }

  /** A part of a feel as a frame for a device. */
  knobFrame(number, numbers) {
    this.exports.knob_frame(number, ...numbers);
    return Uint8Array.from(this.#numbers());
  }

  /** What a knob on the line has said last. */
  heardOfKnob() {
    this.exports.knob_heard();
    const [greeted, number, refused, ...dial] = this.#numbers();
    const [angle, rate, torque, detent, end] = dial;
    const told = dial.length ? { angle, rate, torque, detent, end } : null;
    return { greeted: !!greeted, number, refused: refused ? this.#text() : "", dial: told };
  }

  #put(bytes) {
    const at = this.exports.input(bytes.length);
    new Uint8Array(this.exports.memory.buffer, at, bytes.length).set(bytes);
  }

  #numbers() {
    const { memory, output, output_length } = this.exports;
    return new Float32Array(memory.buffer, output(), output_length()).slice();
  }

  #text() {
    const { memory, text, text_length } = this.exports;
    return new TextDecoder().decode(new Uint8Array(memory.buffer, text(), text_length()));
  }
}

export const hex = (word) => (word >>> 0).toString(16).padStart(8, "0");

function seen(numbers) {
  const view = {};
  VECTORS.forEach((name, index) => (view[name] = Array.from(numbers.subarray(3 * index, 3 * index + 3))));
  NUMBERS.forEach((name, index) => (view[name] = numbers[3 * VECTORS.length + index]));
  // Of a scene: which of its parts is felt, and of each its axes and its origin.
  const [felt = 0, ...places] = numbers.subarray(3 * VECTORS.length + NUMBERS.length);
  view.part = felt;
  view.places = Array.from({ length: places.length / 12 }, (_, part) => places.slice(12 * part, 12 * part + 12));
  return view;
}
