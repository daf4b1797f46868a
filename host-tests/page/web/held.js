// The device in the hand: slides for the mouse, a device that ships, or the reader's own by its file.

import { given } from "bodies";
import { setChoices } from "choices";

const by = (id) => document.getElementById(id);
/** Of the slides: the recommended wall, and the device's limit, N/m. */
const MOUSE = { name: "", file: "", about: "three slides that a mouse moves" };
const SLIDES = { stiffness: 1000, maxStiffness: 6000, damping: 2, rendering: 0 };

export class Held {
  constructor(page) {
    this.page = page;
    this.all = new Map([MOUSE, ...given.devices].map((device) => [device.name, device]));
    for (const { name, about } of this.all.values()) by("device").add(new Option(name || "mouse", name, false, false));
    this.chosen = this.all.get(given.held ?? "") ?? MOUSE;
    by("device").addEventListener("change", () => this.choose(by("device").value));
  }

  /** Holds a device of the list. */
  choose(name) {
    return this.hold(this.all.get(name));
  }

  /** Holds the device of a file, from its text; whether it was taken. */
  open(file, label) {
    return this.hold({ file, label, about: "yours" });
  }

  hold(device) {
    const { page } = this;
    try {
      this.under(page.body.device, device);
      page.refuse(null);
    } catch (error) {
      page.refuse(error.message);
      by("device").value = this.chosen.name;
      return false;
    }
    page.choose();
    page.tool.begin(page.body.device);
    return true;
  }

  /** Puts a device under a body's loop, with its recommended settings: the one that is held, or another. */
  under(loop, device = this.chosen) {
    const found = { ...SLIDES, ...loop.hold(device.file, device.label ?? `${device.name}.toml`) };
    const isNew = device !== this.chosen || this.numbers === undefined;
    const name = device.label ? `${found.name ?? device.label} (yours)` : (found.name ?? device.name);
    if (!this.all.has(name)) by("device").add(new Option(name, name));
    this.chosen = { ...device, name };
    if (device.label) this.all.set(name, this.chosen);
    by("device").value = name;
    this.numbers = found;
    by("device-about").textContent = said(device, found);
    by("workspace").hidden = by("workspace-name").hidden = !found.name;
    by("stiffness").max = found.maxStiffness;
    if (isNew) setChoices({ ...found, stiffness: device.stiffness ?? found.stiffness });
  }

  /** Shows how far from the end of its workspace a device is. */
  show(loop) {
    if (this.numbers?.name) by("workspace").textContent = inside(loop.workspaceMargin());
  }

  get damping() {
    return this.numbers?.damping ?? SLIDES.damping;
  }
}

const inside = (margin) =>
  margin > 0.99 ? "inside" : margin > 0.06 ? `near its end: force × ${margin.toFixed(2)}` : "at its end";

function said({ about }, { name, maxForce, perCount, extents }) {
  if (!name) return "";
  const sides = [0, 2, 4].map((at) => Math.round(100 * (extents[at] + extents[at + 1])));
  return (
    `${about}. Workspace ${sides.join(" × ")} cm through its centre, where the body is; up to ${maxForce.toFixed(1)} N; ` +
    `a count moves the probe by up to ${(1e3 * perCount).toPrecision(2)} mm.`
  );
}
