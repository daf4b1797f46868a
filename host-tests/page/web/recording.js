// A run that `palpate demo` or `palpate sim` has recorded: the counts of each tick, felt anew by the firmware's code.

import { decode } from "firmware";
import { read } from "bodies";

/** How many ticks pass between two views that are kept. */
const STRIDE = 8;

/** The renderings of the firmware's code, by number. */
const RENDERINGS = ["plain", "eased", "smooth"];

/** A recording as the tool writes it: its body, the views of its run, and whether the hash is what was recorded. */
export async function open(text, name) {
  const said = JSON.parse(text);
  if (said.palpate !== "recording") throw new Error(`${name}: not a recording of palpate`);
  const rendering = RENDERINGS.indexOf(said.rendering ?? "plain");
  if (!said.bodies?.length || !said.device_numbers || rendering < 0) throw new Error(`${name}: recorded by another version of palpate`);
  const bodies = await Promise.all(said.bodies.map(({ name, file }) => read(decode(file), name)));
  const [body] = bodies;
  for (const { bytes } of bodies.slice(1)) body.device.addToReplay(bytes);
  body.device.beginReplay({
    settings: said.settings,
    rendering,
    device: decode(said.device_numbers),
    scene: said.scene ? decode(said.scene.numbers) : new Uint8Array(),
    linkTimeout: said.link_timeout,
  });
  const rows = counts(decode(said.counts), said.ticks, said.enable_at);
  const views = [];
  for (let tick = 0; tick < said.ticks; tick += STRIDE) {
    body.device.replay(rows.subarray(4 * tick, 4 * Math.min(tick + STRIDE, said.ticks)));
    views.push(body.device.replayView());
  }
  const hash = body.device.replayHash();
  return {
    body: said.scene ? { ...body, title: said.model, parts: parts(said.scene, bodies, views[0].places) } : body,
    views,
    seconds: STRIDE / said.settings[0],
    hash,
    recorded: said.hash,
    same: hash === said.hash,
    on: said.on,
  };
}

/** What a scene is made of: each part with its body, what it is called, and where it begins. */
function parts(scene, bodies, places) {
  return scene.parts.map(([called, body], index) => ({ ...bodies[body], called, place: places[index] }));
}

/** Differences of counts from tick to tick, zig-zag and LEB128, as rows of three counts and whether force is asked for. */
function counts(bytes, ticks, enableAt) {
  const rows = new Int32Array(4 * ticks),
    last = [0, 0, 0];
  let at = 0;
  for (let tick = 0; tick < ticks; tick += 1) {
    for (let joint = 0; joint < 3; joint += 1) {
      let number = 0,
        shift = 0,
        byte;
      do {
        byte = bytes[at++];
        number |= (byte & 127) << shift;
        shift += 7;
      } while (byte > 127);
      last[joint] = (last[joint] + ((number >>> 1) ^ -(number & 1))) | 0;
      rows[4 * tick + joint] = last[joint];
    }
    rows[4 * tick + 3] = tick >= enableAt ? 1 : 0;
  }
  return rows;
}

/** The probe's places of a table that `palpate sim --csv` has written, in the frame of the tables, one a time. */
export function places(text, centre) {
  const [head, ...lines] = text
    .trim()
    .split(/\r?\n/)
    .map((line) => line.split(","));
  const columns = ["time", "probe_x", "probe_y", "probe_z"].map((name) => head.indexOf(name));
  if (columns.includes(-1)) throw new Error("a table needs the columns time, probe_x, probe_y and probe_z");
  return lines.map((line) => {
    const [time, ...place] = columns.map((column) => Number(line[column]));
    return { time, place: place.map((coordinate, axis) => coordinate - centre[axis]) };
  });
}
