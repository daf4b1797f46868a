// The numbers beside the picture, and the sentence below it.

import { colour } from "scheme";
import { EDGE, FACE, featureOf, TOUCHING } from "firmware";

const MODES = ["", "held at u = 0", "held at u = 1", "held at v = 0", "held at v = 1", "interior", "corner"];
const PHASES = ["reset", "calibrate", "armed", "running", "fault"];
const by = (id) => document.getElementById(id);
const set = (id, text) => {
  const element = by(id);
  if (element.textContent !== text) element.textContent = text;
};

export const length = (vector) => Math.hypot(...vector);

/** A feature in words, of a scene's part with what that is called. */
export function nameOf(code, body) {
  const of = body.called ? ` of ${body.called}` : "";
  return placeOf(featureOf(code), body) + of;
}

function placeOf({ kind, index }, body) {
  if (kind === FACE) return body.device.isPatch ? "the patch" : `face “${body.faces[index] ?? index}”`;
  return kind === EDGE ? `edge ${index}` : `vertex ${index}`;
}

/** Shows a view of the loop. */
export function show(view, body, isShaped = false) {
  const millimetres = view.gap * 1e3,
    touching = view.contact === TOUCHING;
  set("gap", millimetres.toFixed(3).replace("-", "−"));
  by("gap").dataset.metres = view.gap;
  by("gap").classList.toggle("touching", touching);
  set("contact", ["behind", "in front", "touching"][view.contact] + (view.tooDeep ? ", very deep" : ""));
  set("feature", nameOf(view.feature, body));
  set("parameters", `${view.u.toFixed(5)}, ${view.v.toFixed(5)}`);
  set("mode", MODES[view.mode] ?? String(view.mode));
  const newtons = length(view.force);
  set("force", `${newtons.toFixed(2)} N${view.held ? (view.slips ? ", slipping" : ", sticking") : ""}`);
  // A tool's step is of the pair.
  set("gain", isShaped ? "–" : view.gain.toFixed(4));
  // Several bodies share a tick, and those of one that gives way are not counted.
  set("evaluations", body.called || !view.evaluations ? "–" : String(view.evaluations));
  set("phase", view.fault ? `${PHASES[view.phase]} ${view.fault}` : PHASES[view.phase]);
  by("caption").innerHTML = `<span>${caption(view, body, millimetres, newtons, touching, isShaped)}</span>`;
}

function caption(view, body, millimetres, newtons, touching, isShaped) {
  const on = escape(nameOf(view.feature, body));
  if (touching) {
    return (
      `pressed <b class="touch">${Math.abs(millimetres).toFixed(1)} mm</b> into ${on}: the motors push back with ` +
      `<b class="touch">${newtons.toFixed(2)} N</b>`
    );
  }
  if (view.contact === 1) return `<b class="away">${millimetres.toFixed(1)} mm</b> in front of ${on}`;
  return `behind ${on}: nothing is felt before the ${isShaped ? "tool" : "stylus"} has been in front`;
}

const escape = (text) => text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);

const DECADES = [-9, -1];

/** The projection errors of the last ticks, in sizes of the body, on a logarithmic scale. */
export class Errors {
  constructor(canvas) {
    this.context = canvas.getContext("2d");
    this.values = [];
  }

  add(errors, size) {
    for (const error of errors) this.values.push(error / size);
    this.values.splice(0, Math.max(this.values.length - 320, 0));
  }

  draw() {
    const { context, values } = this;
    const { width, height } = context.canvas;
    grid(context, DECADES);
    context.strokeStyle = colour("witness");
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.beginPath();
    values.forEach((value, index) => {
      context.lineTo(GUTTER + ((width - GUTTER) * (index + 320 - values.length)) / 319, level(value, DECADES, height));
    });
    context.stroke();
  }
}

/** Left of the curve, for the numbers; above and below it, px. */
const GUTTER = 76,
  MARGIN = 18;

/** How high a value stands. */
export function level(value, [low, high], height) {
  const decade = Math.log10(Math.max(value, 1e-30));
  return MARGIN + (height - 2 * MARGIN) * (1 - Math.min(Math.max((decade - low) / (high - low), 0), 1));
}

/** Clears a canvas and draws a line a decade. */
export function grid(context, [low, high]) {
  const { width, height } = context.canvas;
  context.clearRect(0, 0, width, height);
  context.fillStyle = colour("quiet");
  context.strokeStyle = colour("grid");
  context.lineWidth = 2;
  context.font = "26px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (let decade = low; decade <= high; decade += 2) {
    const y = level(10 ** decade, [low, high], height);
    context.beginPath();
    context.moveTo(GUTTER, y);
    context.lineTo(width, y);
    context.stroke();
    context.fillText(`10${superscript(decade)}`, 8, y);
  }
}

const superscript = (number) =>
  [...String(number)].map((letter) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(letter)]).join("");
