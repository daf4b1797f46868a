// A run that `palpate demo` or `palpate sim` has recorded: the counts of each tick, rendered again by the firmware's code.

import { decode } from "firmware";
import { read } from "bodies";
import { hashOf } from "proof";

/** How many ticks pass between two views that are kept. */
const STRIDE = 8;

/** The renderings of the firmware's code, by number. */
const RENDERINGS = ["plain", "eased", "smooth"];

const AGAIN = "record it again with `demo` or `sim --recording`";

/** A recording as the tool writes it: its body and the views of its run, which comes to the hash that was recorded. */
export async function open(text, name) {
  const said = parsed(text);
  if (said?.palpate !== "recording") throw new Error(`${name}: not a recording of palpate; ${AGAIN}`);
  const rendering = RENDERINGS.indexOf(said.rendering ?? "plain");
  if (!said.bodies?.length || !said.device_hash || rendering < 0)
    throw new Error(`${name}: recorded by another version of palpate; ${AGAIN}`);
  for (const body of said.bodies) checked(name, `the body “${body.name}”`, body.file, body.hash);
  checked(name, `the device “${said.device}”`, said.device_numbers, said.device_hash);
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
  if (hash !== said.hash)
    throw new Error(`${name}: comes to the state hash ${hash}, and ${said.hash} was recorded: its counts or settings were changed, or it is of another version of palpate; ${AGAIN}`);
  return {
    body: said.scene ? { ...body, title: said.model, parts: parts(said.scene, bodies, views[0].places) } : body,
    views,
    seconds: STRIDE / said.settings[0],
    hash,
    // A recorded loop has no friction and the firmware's law; in a scene each body has its own stiffness.
    settings: { rate: said.settings[0], stiffness: said.scene ? null : said.settings[1], friction: 0, law: 0, rendering },
    on: said.on,
    with: said.device,
  };
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

function checked(name, what, content, hash) {
  if (hashOf(content) !== hash) throw new Error(`${name}: ${what} is not that of the run; ${AGAIN}`);
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

/** Seconds between two views of a table: ticks of any rate. */
const APART = 4e-3;

/** The probe's places of a table that `palpate sim --csv` has written, evenly in time, with its device and its model's file. */
export function places(text, held) {
  const [head, ...lines] = text
    .trim()
    .split(/\r?\n/)
    .map((line) => line.split(","));
  const columns = ["time", "probe_x", "probe_y", "probe_z"].map((name) => head.indexOf(name));
  if (columns.includes(-1)) throw new Error("a table needs the columns time, probe_x, probe_y and probe_z");
  const made = lines[0]?.[head.indexOf("device")];
  if (held && made && made !== held) throw new Error(`the table was made with ${made}, and ${held} is held: hold ${made}, or the mouse`);
  const rows = lines.map((line) => columns.map((column) => Number(line[column])));
  if (!rows.length || rows.flat().some(Number.isNaN)) throw new Error("a table needs rows, and numbers in each");
  const found = [];
  for (let at = 0, time = rows[0][0]; time <= rows.at(-1)[0]; time += APART) {
    while (at + 1 < rows.length && rows[at + 1][0] <= time) at += 1;
    found.push(rows[at].slice(1));
  }
  return { places: found, with: made, of: lines[0][head.indexOf("model")] };
}

/** What the loop in the hand, with its rate, does at the places of a table: a recording. */
export function along(table, device, rate) {
  const places = table.places.map((place) => place.map((coordinate, axis) => coordinate - device.centre[axis]));
  device.restart(places[0]);
  const views = places.map((place) => (device.run(rate * APART, place), device.view()));
  return { ...table, views, seconds: APART };
}
