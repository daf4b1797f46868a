// The page: a loop of frames that runs the firmware's ticks and shows what they came to.

import { Vector3 } from "three";
import { featureOf, FACE, EDGE, hex } from "firmware";
import { given, read, shipped } from "bodies";
import { Room } from "scene";
import { Marks } from "marks";
import { Pointer } from "pointer";
import { stroll } from "stroll";
import { Errors, show } from "panel";
import { Basin } from "basin";
import { hashOf, secondsOf, verify } from "proof";
import { open as openRecording, places } from "recording";
import { connect, seen } from "live";

const by = (id) => document.getElementById(id);
/** A page that was away for longer does not catch up. */
const LONGEST_FRAME = 0.05;
/** Seconds without a pointer before the stylus strolls again. */
const IDLE = 20;

const room = new Room(by("scene"));
const marks = new Marks(room);
const errors = new Errors(by("errors"));
const pointer = new Pointer(room, { touched: () => ((idle = 0), (strolls = halted = false)) });
const basin = new Basin({
  changed: ([ours, newton]) => tab === "basin" && marks.ways(ours.places, newton.places),
});

let body,
  target,
  view,
  tab = "feel";
let strolls = true,
  idle = 0,
  clock = 0,
  owed = 0,
  replayed = null,
  live = null,
  ahead = null;
let fps = 60,
  nanoseconds = 0,
  halted = false;

/** Takes another body, or says why not. */
async function take(promise) {
  refuse(null);
  try {
    const taken = await promise;
    body = taken;
  } catch (error) {
    refuse(error.message);
    return false;
  }
  replayed = ahead = null;
  by("timeline").hidden = true;
  room.show(body.device);
  marks.begin();
  pointer.begin();
  target = room.unplace(room.front.clone().multiplyScalar(0.9));
  choose();
  body.device.restart(target);
  if (!by("body").querySelector(`option[value="${CSS.escape(body.name)}"]`)) {
    by("body").add(new Option(body.title, body.name));
    owned.set(body.name, body.bytes);
  }
  by("body").value = body.name;
  strolls = true;
  halted = false;
  if (tab === "basin") beginBasin();
  return true;
}
const owned = new Map();

function refuse(message) {
  by("refusal").hidden = !message;
  by("refusal").textContent = message ?? "";
}

const number = (id) => Number(by(id).value);

function choose() {
  const choices = {
    rate: number("rate"),
    stiffness: number("stiffness"),
    damping: 2,
    friction: number("friction"),
    law: number("law"),
  };
  for (const [id, text] of [
    ["rate", `${choices.rate} Hz`],
    ["stiffness", `${choices.stiffness} N/m`],
    ["friction", choices.friction ? choices.friction.toFixed(2) : "none"],
    ["slow", slowness()],
  ]) {
    by(id).nextElementSibling.textContent = text;
  }
  try {
    body.device.choose(choices);
    refuse(null);
  } catch (error) {
    refuse(error.message);
  }
}

const slow = () => 10 ** -number("slow");
const slowness = () => (number("slow") === 0 ? "real" : `1 / ${Math.round(10 ** number("slow"))}`);

/** One frame: so many ticks of simulated time, and the picture. */
function frame(now) {
  requestAnimationFrame(frame);
  const seconds = Math.min((now - (frame.last ?? now)) / 1e3, LONGEST_FRAME);
  if (now - (frame.last ?? now) > 0) fps += 0.05 * (1e3 / (now - frame.last) - fps);
  frame.last = now;
  if (!body) return;
  if (live) view = live.view ?? view;
  else if (replayed) playOn(seconds);
  else if (tab === "basin") basin.step();
  else if (!halted) advance(seconds);
  if (view) picture();
  if (window.palpate.draws) room.draw();
}

function advance(seconds) {
  idle += seconds;
  if (idle > IDLE && !pointer.held) strolls = true;
  owed += seconds * slow() * number("rate");
  const ticks = Math.floor(owed);
  owed -= ticks;
  clock += seconds * slow();
  if (ticks > 0) {
    if (ahead) target = follow(ahead);
    else if (strolls) target = ease(stroll(body.device, room, clock), seconds);
    else target = pointer.towards(target, seconds);
    const began = performance.now();
    body.device.run(ticks, target, !pointer.held);
    nanoseconds += 0.05 * (((performance.now() - began) * 1e6) / ticks - nanoseconds);
    errors.add(body.device.errors(), body.device.size);
  }
  view = body.device.view();
}

// Places of a table: the hand is where the probe was.
function follow(table) {
  while (table.at + 1 < table.length && table[table.at + 1].time < clock - table.began) table.at += 1;
  if (table.at + 1 >= table.length) ahead = null;
  return table[table.at].place;
}

// From wherever the stylus is to where it strolls.
function ease(to, seconds) {
  const share = 1 - Math.exp(-seconds / 0.12);
  return target.map((coordinate, axis) => coordinate + (to[axis] - coordinate) * share);
}

function playOn(seconds) {
  const { views } = replayed;
  if (replayed.plays) replayed.at = (replayed.at + (seconds * slow()) / replayed.seconds) % views.length;
  view = views[Math.floor(replayed.at)];
  by("time").value = Math.floor(replayed.at);
  by("clock").textContent = `${(replayed.at * replayed.seconds).toFixed(2)} s`;
}

function picture() {
  const lit = facesOf(view.feature);
  room.light_up(body.device.isPatch ? [] : lit);
  const withRegion = by("regions").checked && tab === "feel";
  if (withRegion) marks.region(view.feature, body.device);
  marks.show(view, withRegion);
  show(view, body);
  if (tab === "feel") errors.draw();
  if (Math.floor(frame.last / 500) !== frame.told) {
    frame.told = Math.floor(frame.last / 500);
    by("speed").textContent =
      `${Math.round(number("rate") * slow())} ticks a second at ${Math.round(fps)} frames; ` +
      `${(nanoseconds / 1e3).toFixed(2)} µs a tick here`;
  }
}

// An edge lights its faces, a vertex none.
function facesOf(code) {
  const { kind, index } = featureOf(code);
  return kind === FACE ? [index] : kind === EDGE ? [] : [];
}

function beginBasin() {
  // Straight out from where the patch is, or where the reader has left the stylus.
  const at = body.device.isPatch ? over() : (view?.probe ?? target);
  basin.begin(body.device, at);
  body.device.restart(at);
  body.device.run(200, at, false);
  view = body.device.view();
}

// A probe over a patch, a third of its size straight out.
function over() {
  const steps = 10,
    grid = body.device.face(0, steps),
    at = 6 * (3 * (steps + 1) + 7);
  return [0, 1, 2].map((axis) => grid[at + axis] + 0.35 * body.device.size * grid[at + 3 + axis]);
}

/** Opens a file: a body, a recording, or a table of places. */
async function openFile(file) {
  const name = file.name;
  if (/\.palp$/i.test(name)) {
    return take(file.arrayBuffer().then((buffer) => read(new Uint8Array(buffer), name.replace(/\.palp$/i, ""))));
  }
  const text = await file.text();
  if (/\.csv$/i.test(name)) return playTable(text);
  return playRecording(text, name);
}

async function playRecording(text, name) {
  let found;
  const opened = await take((async () => (found = await openRecording(text, name)).body)());
  if (!opened) return false;
  replayed = Object.assign(found, { at: 0, plays: true });
  by("time").max = found.views.length - 1;
  by("timeline").hidden = false;
  by("live").textContent = found.same
    ? `state hash ${found.hash}: ${found.on}’s, bit for bit`
    : `state hash ${found.hash}, recorded was ${found.recorded}`;
  return true;
}

function playTable(text) {
  try {
    ahead = Object.assign(places(text, body.device.centre), { at: 0, began: clock });
    refuse(null);
    return true;
  } catch (error) {
    refuse(error.message);
    return false;
  }
}

function choosePanel(name) {
  tab = name;
  document.querySelectorAll("[data-tab]").forEach((element) => {
    if (element.role === "tab") element.setAttribute("aria-selected", String(element.dataset.tab === name));
    else element.hidden = element.dataset.tab !== name;
  });
  marks.ways();
  if (name === "basin") beginBasin();
  if (name === "proof" && by("hash").textContent === "…") verify();
}

function wire() {
  for (const { name, title } of given.bodies) by("body").add(new Option(title, name));
  by("body").addEventListener("change", ({ target: { value } }) =>
    take(owned.has(value) ? read(owned.get(value), value) : shipped(value)),
  );
  for (const id of ["stiffness", "friction", "rate", "slow", "law"]) by(id).addEventListener("input", choose);
  by("hand").addEventListener("change", () => {
    pointer.mode = by("hand").value;
    pointer.goal = room.place(target);
    pointer.foot = null;
  });
  document
    .querySelectorAll("[role=tab]")
    .forEach((button) => button.addEventListener("click", () => choosePanel(button.dataset.tab)));
  by("open").addEventListener("click", () => by("file").click());
  by("file").addEventListener("change", ({ target: { files } }) => files[0] && openFile(files[0]));
  by("verify").addEventListener("click", verify);
  by("table1").addEventListener("click", () => take(shipped("table1")));
  by("play").addEventListener("click", () => {
    replayed.plays = !replayed.plays;
    by("play").textContent = replayed.plays ? "pause" : "play";
  });
  by("time").addEventListener("input", () => (replayed.at = number("time")));
  by("leave").addEventListener("click", () => take(Promise.resolve(body)));
  by("serial").addEventListener("click", toggleLive);
  addEventListener("resize", () => room.resize());
  addEventListener("dragover", (event) => (event.preventDefault(), (by("drop").hidden = false)));
  addEventListener("dragleave", (event) => event.relatedTarget ?? (by("drop").hidden = true));
  addEventListener("drop", (event) => {
    event.preventDefault();
    by("drop").hidden = true;
    if (event.dataTransfer.files[0]) openFile(event.dataTransfer.files[0]);
  });
}

async function toggleLive() {
  if (live) return live.stop();
  try {
    const stop = await connect(body.device, (record) => {
      if (!record) return void ((live = null), (by("serial").textContent = "Connect a device…"));
      live.view = seen(record, body.device);
      by("live").textContent =
        `${record.records} records, ${record.damaged} damaged; a tick took ` + `${(record.took * 1e6).toFixed(1)} µs`;
    });
    live = { stop, view: null };
    by("serial").textContent = "Disconnect";
  } catch (error) {
    if (error.name !== "NotFoundError") refuse(error.message);
  }
  return undefined;
}

/** For tests, and for the curious in the console. */
window.palpate = {
  ready: null,
  /** Whether frames are drawn: a processor that does it alone has little time for all else. */
  draws: true,
  /** Puts the stylus to a place, metres in the frame of the tables, in so many ticks, and holds it there; the view. */
  hold(place, ticks = 400) {
    strolls = false;
    target = place;
    pointer.hold(place);
    body.device.run(ticks, place, false);
    view = body.device.view();
    picture();
    return { ...view, shown: Number(by("gap").dataset.metres), text: by("gap").textContent };
  },
  closest: (place) => body.device.closest(place),
  monitor: (bytes) => body.device.monitor(Uint8Array.from(bytes)),
  nanoseconds: () => body.device.nanosecondsATick(400_000),
  open: (name, base64) => openFile(new File([Uint8Array.from(atob(base64), (at) => at.charCodeAt(0))], name)),
  take: (name) => take(shipped(name)),
  /** Takes the stylus for a stroll, from a time on, s; for pictures. */
  strollFrom(time) {
    clock = time;
    strolls = true;
    for (let step = 0; step < 60; step += 1) {
      clock += 1 / 60;
      target = ease(stroll(body.device, room, clock), 1 / 60);
      body.device.run(67, target);
    }
  },
  /** A stroll from a time on, s, that halts there. */
  show(time) {
    window.palpate.strollFrom(time);
    pointer.hold(target);
    strolls = false;
    for (let count = 0; count < 30; count += 1) body.device.run(100, target);
    view = body.device.view();
    halted = true;
  },
  about: () => ({
    size: body.device.size,
    centre: body.device.centre,
    middle: room.middle,
    units: body.units,
    faces: body.device.faces,
  }),
  /** When all starts have been tried. */
  async settled() {
    while (!basin.done) await new Promise((go) => setTimeout(go, 20));
  },
  exerciseSeconds: () => secondsOf(),
  panel: choosePanel,
  state: () => ({
    name: body.name,
    title: body.title,
    tab,
    replay: replayed && { same: replayed.same, hash: replayed.hash },
    arrived: basin.arrived,
    done: basin.done,
    refusal: by("refusal").hidden ? null : by("refusal").textContent,
    contact: view?.contact,
    gap: view?.gap,
    fps,
    digest: body.device.digest(),
    script: given.script && hashOf(given.script),
  }),
  verify,
  hex,
  Vector3,
};

wire();
window.palpate.ready = (async () => {
  await take(shipped(given.first));
  requestAnimationFrame(frame);
  if (given.recording) await playRecording(JSON.stringify(given.recording), "the recording");
  return true;
})();
