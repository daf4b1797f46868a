// What a script may ask of the page, as `window.palpate`: the tests do, and the curious in the console.

import { given, shipped } from "bodies";
import { choices } from "choices";
import { openFile } from "files";
import { hashOf, secondsOf, verify } from "proof";

const by = (id) => document.getElementById(id);

export class Script {
  constructor(page) {
    this.page = page;
    /** When the page runs. */
    this.ready = null;
    this.verify = verify;
    this.exerciseSeconds = secondsOf;
  }

  /** Holds the loop still: nothing moves but what a script moves, however many frames pass. */
  pause(paused = true) {
    this.page.loop.paused = paused;
  }

  /** Whether frames are drawn. */
  draw(draws) {
    this.page.draws = draws;
  }

  /** A shipped body. */
  take(name) {
    return this.page.take(shipped(name));
  }

  /** A file of a name, its bytes in base64. */
  open(name, base64) {
    return openFile(this.page, new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], name));
  }

  /** A device of the list, by its name. */
  holdDevice(name) {
    return this.page.held.choose(name);
  }

  /** A tool of the list in the hand; the empty name is the tip. */
  takeTool(name) {
    return this.page.tool.take(name);
  }

  /** The tool as it is drawn, and its contacts; null of a tip. */
  tool() {
    return this.page.body.device.tool();
  }

  panel(name) {
    return this.page.turnTo(name);
  }

  /** The dial's hand at an angle, radians, for so many ticks; what is seen then. */
  turnKnob(angle, ticks) {
    return this.page.knob.hold(angle, ticks);
  }

  /** Puts the stylus to a place, metres in the frame of the tables, in so many ticks; what is seen there. */
  hold(place, ticks = 400) {
    const { page } = this;
    page.loop.hold(place, ticks);
    page.view = page.body.device.view();
    page.picture();
    return { ...page.view, shown: Number(by("gap").dataset.metres), text: by("gap").textContent };
  }

  /** A stroll from a time on, s, that stands where it ends. */
  show(time) {
    this.page.errors.add(this.page.loop.show(time), this.page.body.device.size);
  }

  /** When so many more frames have been drawn. */
  async drawn(frames) {
    const last = this.page.frames + frames;
    while (this.page.frames < last) await new Promise(requestAnimationFrame);
  }

  /** When all starts of the comparison have been tried. */
  async settled() {
    while (!this.page.basin.done) await new Promise(requestAnimationFrame);
  }

  /** All views of the recording that is shown. */
  views() {
    return this.page.player.recording.views;
  }

  /** Shows the recording at a time, s, and stands there. */
  seek(seconds) {
    this.page.player.seek(seconds);
  }

  /** The closest point of a place from a standing start. */
  closest(place) {
    return this.page.body.device.closest(place);
  }

  /** The rays of a feature's region. */
  sheets(code) {
    return Array.from(this.page.body.device.sheets(code));
  }

  /** Bytes of a device's telemetry; the last record. */
  monitor(bytes) {
    return this.page.body.device.monitor(Uint8Array.from(bytes));
  }

  /** Nanoseconds of a tick. */
  nanoseconds() {
    return this.page.body.device.nanosecondsATick(400_000);
  }

  about() {
    const { body, room } = this.page,
      { size, centre, faces, edges, vertices } = body.device;
    return { size, centre, faces, edges, vertices, middle: room.middle, units: body.units };
  }

  state() {
    const { page } = this;
    const { body, basin, player, view, panel, rate, frames, room, marks } = page,
      recording = player.recording;
    return {
      name: body.name,
      title: body.title,
      panel,
      replay: recording && { hash: recording.hash, with: recording.with },
      arrived: basin.arrived,
      held: { ...page.held.numbers, about: by("device-about").textContent },
      choices: choices(page.held.damping),
      margin: body.device.workspaceMargin(),
      strolls: page.loop.strolls,
      away: page.loop.presence.away,
      force: view?.force,
      refusal: by("refusal").hidden ? null : by("refusal").textContent,
      contact: view?.contact,
      gap: view?.gap,
      probe: view?.probe,
      feature: view?.feature,
      region: marks.sheet.visible ? marks.shown.code : null,
      looksFrom: room.camera.position.toArray(),
      rate,
      frames,
      digest: body.device.digest(),
      script: given.script && hashOf(given.script),
    };
  }
}
