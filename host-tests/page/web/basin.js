// The paper's controller beside Newton's method: the same starts, the same probe, the same tables.

import { colour, withColours } from "scheme";

const CELLS = 48;
/** Milliseconds of a frame for starts: the picture fills while the page stays alive. */
const BUDGET = 9;
/** A run has found the closest point if it ends no farther from the probe than this, in sizes of the body. */
const FOUND = 1e-5;
const OURS = [47, 184, 168],
  LOST = [214, 70, 86];

export class Basin {
  constructor({ changed }) {
    const by = (id) => document.getElementById(id);
    this.maps = [by("map-ours"), by("map-newton")];
    this.shares = [by("ours-share"), by("newton-share")];
    this.falls = by("falls").getContext("2d");
    this.note = by("basin-note");
    this.law = by("basin-law");
    this.other = by("newton-law");
    for (const choice of [this.law, this.other]) {
      choice.addEventListener("change", () => this.begin(this.device, this.probe, this.start));
    }
    this.changed = changed;
    withColours(() => this.ways && this.plot());
    for (const map of this.maps) {
      map.addEventListener("pointermove", (event) => this.pick(map, event));
      map.addEventListener("pointerdown", (event) => this.pick(map, event));
    }
  }

  /** A patch and a probe, metres. */
  begin(device, probe, start = [0.06, 0.06]) {
    Object.assign(this, { device, probe, row: 0, picked: false });
    const found = device.closest(probe);
    Object.assign(this, { face: found.face, closest: found });
    this.images = [0, 1].map(() => new ImageData(CELLS, CELLS));
    this.arrived = [0, 0];
    this.done = false;
    this.note.textContent = "";
    this.shares.forEach((share) => (share.textContent = ""));
    this.follow(start);
  }

  methods() {
    return [Number(this.law.value), Number(this.other.value)];
  }

  /** A few more rows of starts. */
  step() {
    if (this.done || !this.device) return;
    const began = performance.now();
    for (; this.row < CELLS && performance.now() - began < BUDGET; this.row += 1) {
      this.methods().forEach((method, index) => {
        const cells = this.device.basinRow(this.face, this.probe, (this.row + 0.5) / CELLS, CELLS, method);
        for (let column = 0; column < CELLS; column += 1)
          this.cell(index, column, cells[2 * column], cells[2 * column + 1]);
      });
    }
    if (this.row === CELLS) {
      this.done = true;
      const [ours, newton] = this.arrived.map((count) => `${((100 * count) / CELLS ** 2).toFixed(1)} %`);
      this.shares[0].textContent = ours;
      this.shares[1].textContent = newton;
      if (!this.picked) this.follow(this.telling());
    }
    this.paint();
  }

  // u to the right, v up; brighter where it took fewer steps.
  cell(index, column, steps, distance) {
    const found = distance <= this.closest.distance + FOUND * this.device.size;
    const bright = 1.15 - 0.55 * Math.min(Math.log2(1 + steps) / 7, 1);
    const at = 4 * ((CELLS - 1 - column) * CELLS + this.row);
    (found ? OURS : LOST).forEach(
      (part, channel) => (this.images[index].data[at + channel] = Math.min(part * bright, 255)),
    );
    this.images[index].data[at + 3] = 255;
    this.arrived[index] += found ? 1 : 0;
  }

  // The start nearest to the corner, but not at the border, from which only one of the two arrives.
  telling() {
    const [ours, newton] = this.images.map(({ data }) => (column, row) => {
      const at = 4 * ((CELLS - 1 - column) * CELLS + row);
      return data[at + 1] > data[at];
    });
    for (let sum = 8; sum < 2 * CELLS - 8; sum += 1) {
      for (let row = Math.max(3, sum - CELLS + 4); row < Math.min(CELLS - 3, sum - 3); row += 1) {
        if (ours(sum - row, row) !== newton(sum - row, row))
          return [row, sum - row].map((cell) => (cell + 0.5) / CELLS);
      }
    }
    return this.start;
  }

  pick(map, event) {
    this.picked = true;
    const { left, top, width, height } = map.getBoundingClientRect();
    const u = (event.clientX - left) / width,
      v = 1 - (event.clientY - top) / height;
    this.follow([u, v].map((parameter) => Math.min(Math.max(parameter, 0), 1)));
  }

  /** Both methods from one start. */
  follow(start) {
    this.start = start;
    this.ways = this.methods().map((method) => ways(this.device.way(this.face, this.probe, start, method)));
    this.changed(this.ways);
    const [ours, newton] = this.ways.map((way) => {
      const end = distance(way.places.at(-1), this.probe);
      const steps = `${way.places.length - 1} step${way.places.length > 2 ? "s" : ""}`;
      if (outside(way.parameters.at(-1))) return `leaves the patch after ${steps}`;
      const found = end <= this.closest.distance + FOUND * this.device.size;
      return `${found ? "arrives" : "ends elsewhere"} after ${steps}, at ${(end * 1e3).toFixed(2)} mm`;
    });
    this.note.textContent = `From (${start.map((at) => at.toFixed(2)).join(", ")}): palpate ${ours}; Newton ${newton}.`;
    this.plot();
    this.paint();
  }

  plot() {
    const falls = this.ways.map(({ places }) => places.map((place) => distance(place, this.probe) * 1e3));
    const all = falls.flat(),
      least = Math.min(...all),
      most = Math.max(...all);
    const { falls: context } = this,
      { width, height } = context.canvas;
    context.clearRect(0, 0, width, height);
    const longest = Math.max(...falls.map((fall) => fall.length), 8);
    // The numbers stand beside the curves and below them.
    const [left, right, top, bottom] = [16, width - 165, 20, height - 56];
    const across = (step) => left + ((right - left) * step) / (longest - 1),
      high = (value) => top + (bottom - top) * (1 - (value - least) / Math.max(most - least, 1e-9));
    falls.forEach((fall, index) => {
      context.strokeStyle = context.fillStyle = colour(["witness", "lost"][index]);
      context.lineWidth = 4 - index;
      context.beginPath();
      fall.forEach((value, step) => context.lineTo(across(step), high(value)));
      context.stroke();
      // As long as they are apart.
      if (longest <= 40) fall.forEach((value, step) => dot(context, [across(step), high(value)], 5, context.fillStyle));
    });
    context.fillStyle = colour("quiet");
    context.font = "26px system-ui, sans-serif";
    context.textBaseline = "middle";
    for (const [value, text] of [most, least].map((value) => [value, `${value.toFixed(1)} mm`]))
      context.fillText(text, right + 16, high(value));
    context.textAlign = "right";
    context.fillText(`${longest - 1} steps`, right, height - 20);
    context.textAlign = "left";
  }

  paint() {
    if (!this.images) return;
    this.maps.forEach((map, index) => {
      const context = map.getContext("2d"),
        { width, height } = map;
      this.scratch ??= Object.assign(document.createElement("canvas"), { width: CELLS, height: CELLS });
      this.scratch.getContext("2d").putImageData(this.images[index], 0, 0);
      context.imageSmoothingEnabled = false;
      context.clearRect(0, 0, width, height);
      context.drawImage(this.scratch, 0, 0, width, height);
      const spot = ([u, v]) => [u * width, (1 - v) * height];
      if (this.ways) {
        context.strokeStyle = "#fff";
        context.lineWidth = 1.6;
        context.beginPath();
        this.ways[index].parameters.forEach((parameters) => context.lineTo(...spot(parameters)));
        context.stroke();
        dot(context, spot(this.start), 4, "#fff");
      }
      dot(context, spot([this.closest.u, this.closest.v]), 5, "#0d1220");
      dot(context, spot([this.closest.u, this.closest.v]), 3, "#fff");
    });
  }
}

function ways(numbers) {
  const parameters = [],
    places = [];
  for (let at = 0; at < numbers.length; at += 5) {
    parameters.push([numbers[at], numbers[at + 1]]);
    places.push(Array.from(numbers.subarray(at + 2, at + 5)));
  }
  return { parameters, places };
}

const outside = (parameters) => parameters.some((parameter) => parameter < 0 || parameter > 1);
const distance = (a, b) => Math.hypot(...a.map((coordinate, axis) => coordinate - b[axis]));

function dot(context, [x, y], radius, colour) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, radius, 0, 7);
  context.fill();
}
