// A body that gives way: a slider a mode, and the surface where the modes have moved it.

const by = (id) => document.getElementById(id);
/** Steps of a slider from the middle to the limit. */
const STEPS = 100;
/** A surface that moves less is not drawn again, in sizes of the body. */
const STILL = 1e-5;

export class Modes {
  constructor() {
    by("let-go").addEventListener("click", () => this.letGo());
  }

  /** Begins on a body, which may have none. */
  begin(device) {
    this.device = device;
    this.drawn = null;
    by("modes").querySelectorAll("label").forEach((label) => label.remove());
    this.sliders = device.modes().map(({ frequency, limit }, mode) => this.slider(mode, frequency, limit));
    by("modes").hidden = this.sliders.length === 0;
  }

  slider(mode, frequency, limit) {
    const label = document.createElement("label"),
      slider = Object.assign(document.createElement("input"), { type: "range", min: -STEPS, max: STEPS, value: 0 });
    label.append(`${frequency.toFixed(0)} Hz `, slider, document.createElement("output"));
    slider.addEventListener("input", () => this.device.holdMode(mode, (limit * Number(slider.value)) / STEPS));
    by("modes").append(label);
    return slider;
  }

  letGo() {
    this.sliders.forEach((_, mode) => this.device.holdMode(mode));
  }

  /** Puts the sliders to where the modes are; whether the surface is another than the one that was drawn. */
  show() {
    if (!this.sliders.length) return false;
    const modes = this.device.modes();
    modes.forEach(({ q, limit, held }, mode) => {
      const slider = this.sliders[mode];
      if (!held) slider.value = (STEPS * q) / limit;
      slider.nextElementSibling.textContent = `${(1e3 * q).toFixed(2)} mm`.replace("-", "−");
    });
    const moved = modes.some(({ q }, mode) => Math.abs(q - (this.drawn?.[mode] ?? 0)) > STILL * this.device.size);
    if (moved) this.drawn = modes.map(({ q }) => q);
    return moved;
  }
}
