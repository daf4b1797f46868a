// The page as one thing: which body is shown, in which panel, and what is seen of it.

import { EDGE, FACE, featureOf } from "firmware";
import { given, read, shipped } from "bodies";
import { Room } from "scene";
import { Marks } from "marks";
import { Pointer } from "pointer";
import { Loop } from "loop";
import { Player } from "player";
import { Errors, show } from "panel";
import { Basin } from "basin";
import { Held } from "held";
import { Modes } from "modes";
import { Tool } from "tool";
import { Knob } from "knob";
import { choices, number, pace, say } from "choices";
import { verify } from "proof";

const by = (id) => document.getElementById(id);
/** A page that was away for longer does not catch up, s. */
const LONGEST_FRAME = 0.05;
/** How often the words about speed change, ms. */
const TOLD_EVERY = 500;

export class Page {
  constructor() {
    this.room = new Room(by("scene"));
    this.marks = new Marks(this.room);
    this.errors = new Errors(by("errors"));
    this.pointer = new Pointer(this.room, {
      touched: () => this.loop.taken(),
      put: (place, far) => this.loop.put(place, far),
      reach: (direction) => this.tool.reach(direction),
      turned: (...pixels) => this.tool.turn(...pixels),
    });
    this.tool = new Tool(this);
    this.loop = new Loop(this.room, this.pointer);
    this.player = new Player();
    this.modes = new Modes();
    this.held = new Held(this);
    this.knob = new Knob(this);
    const ways = ([ours, newton]) => this.panel === "basin" && this.marks.ways(ours.places, newton.places);
    this.basin = new Basin({ changed: ways });
    this.panel = "feel";
    /** Bodies of files that were opened, by name. */
    this.opened = new Map();
    /** A device on a line, and what it says; see live.js. */
    this.live = null;
    /** Whether frames are drawn: a processor that does it alone has little time for all else. */
    this.draws = location.hash !== "#undrawn";
    Object.assign(this, { frames: 0, rate: 60 });
  }

  /** Takes a body, or says why not. */
  async take(promise) {
    this.refuse(null);
    try {
      this.body = await promise;
    } catch (error) {
      this.refuse(error.message);
      return false;
    }
    const { device, name, title, bytes, parts } = this.body;
    this.player.close();
    this.room.show(parts ?? [this.body]);
    this.marks.begin();
    this.held.under(device);
    this.modes.begin(device);
    this.pointer.begin();
    this.choose();
    this.tool.begin(device);
    if (!parts && !by("body").querySelector(`option[value="${CSS.escape(name)}"]`)) {
      by("body").add(new Option(`${title} (yours)`, name));
      this.opened.set(name, bytes);
    }
    by("scene-name").hidden = !parts;
    by("scene-name").textContent = parts ? title : "";
    by("body").value = parts ? "" : name;
    if (this.panel === "basin") this.beginBasin();
    return true;
  }

  /** Leaves a recording: of a scene its first body stays. */
  leave() {
    return this.take(Promise.resolve({ ...this.body, parts: undefined }));
  }

  /** Whether a name is in the list. */
  has(name) {
    return this.opened.has(name) || given.bodies.some((body) => body.name === name);
  }

  /** The body of a name in the list. */
  named(name) {
    return this.opened.has(name) ? read(this.opened.get(name), name) : shipped(name);
  }

  /** Says what is wrong, or that nothing is. */
  refuse(message) {
    by("refusal").hidden = !message;
    by("refusal").textContent = message ?? "";
  }

  /** Goes on as the sliders say. */
  choose() {
    say();
    if (this.player.recording?.settings) return;
    try {
      this.body.device.choose(choices(this.held.damping));
      this.player.again(this.body.device, number("rate"));
      this.refuse(null);
    } catch (error) {
      this.refuse(error.message);
    }
  }

  /** Turns to a panel. */
  turnTo(name) {
    this.panel = name;
    document.querySelectorAll("[data-tab]").forEach((element) => {
      if (element.role === "tab") element.setAttribute("aria-selected", String(element.dataset.tab === name));
      else element.hidden = element.dataset.tab !== name;
    });
    this.marks.ways();
    by("stage").classList.toggle("dials", name === "knob");
    by("stage").classList.toggle("still", name === "basin");
    by("dial").hidden = name !== "knob";
    by("choose").hidden = name === "knob";
    if (name === "knob") return this.knob.begin();
    if (name === "basin") this.beginBasin();
    if (name === "proof" && by("hash").textContent === "…") verify();
    return undefined;
  }

  beginBasin() {
    const { device } = this.body;
    // It compares methods on the body at rest.
    this.modes.letGo();
    device.restart(this.loop.place);
    // Straight out from where the patch is, or where the reader has left the stylus.
    const at = device.isPatch ? over(device) : (this.view?.probe ?? this.loop.place);
    this.basin.begin(device, at);
    device.restart(at);
    device.run(200, at, false);
    this.view = device.view();
  }

  /** A frame of the browser's, at its time in ms. */
  frame(now) {
    const took = now - (this.last ?? now);
    if (took > 0) this.rate += 0.05 * (1e3 / took - this.rate);
    this.last = now;
    if (!this.body) return;
    this.advance(Math.min(took / 1e3, LONGEST_FRAME));
    this.frames += 1;
  }

  /** So many seconds of whatever is shown, and the picture of it. */
  advance(seconds) {
    if (this.panel === "knob") return this.knob.advance(seconds);
    if (this.live) this.view = this.live.view ?? this.view;
    else if (this.player.recording) {
      this.view = this.player.advance(seconds);
      this.errors.add([this.view.error], this.body.device.size);
    }
    else if (this.panel === "basin") this.basin.step();
    else {
      const errors = this.loop.advance(seconds);
      if (!this.tool.isShaped) this.errors.add(errors, this.body.device.size);
      this.view = this.body.device.view();
    }
    this.picture();
    this.room.draw(this.draws);
  }

  /** Puts marks and words to where the view is. */
  picture() {
    const { view, body, marks } = this;
    if (!view) return;
    // Of a scene, the part that is felt.
    const part = body.parts ? (view.part ?? 0) : 0,
      felt = body.parts?.[part] ?? body;
    const { kind, index } = featureOf(view.feature),
      isPatch = felt.device.isPatch;
    this.room.put(view.places ?? []);
    if (this.modes.show()) {
      this.room.reshape(body.device);
      marks.begin();
    }
    this.room.lightUp(part, kind === FACE && !isPatch ? index : null);
    marks.on(part);
    marks.edge(kind === EDGE && !isPatch ? index : null, felt.device);
    const withRegion = by("regions").checked && this.panel === "feel";
    if (withRegion) marks.region(view.feature, felt.device);
    const isHeld = !this.live && !this.player.recording && this.panel !== "basin";
    marks.show(view, withRegion, isHeld && this.tool.isShaped);
    this.tool.show(this.room.place(view.probe), isHeld);
    show(view, felt, isHeld && this.tool.isShaped);
    this.held.show(body.device);
    by("height").value = Math.round(100 * this.pointer.height);
    by("height").nextElementSibling.textContent = `${(1e3 * this.pointer.height * this.room.size).toFixed(1)} mm`;
    if (this.panel === "feel") this.errors.draw();
    if (Math.floor(this.last / TOLD_EVERY) === this.told) return;
    this.told = Math.floor(this.last / TOLD_EVERY);
    by("speed").textContent =
      `${Math.round(number("rate") * pace())} ticks a second at ${Math.round(this.rate)} frames` +
      (this.loop.nanoseconds ? `; ${(this.loop.nanoseconds / 1e3).toFixed(2)} µs a tick here` : "");
  }
}

// A probe over a patch, a third of its size straight out.
function over(device) {
  const steps = 10,
    grid = device.face(0, steps),
    at = 6 * (3 * (steps + 1) + 7);
  return [0, 1, 2].map((axis) => grid[at + axis] + 0.35 * device.size * grid[at + 3 + axis]);
}
