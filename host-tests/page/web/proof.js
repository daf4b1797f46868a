// The script of the emulated boards, run by this browser: the same bits.

import { hex, module } from "firmware";
import { given } from "bodies";

// A thread of its own: a million ticks take about a second.
const WORKER = `onmessage = async ({ data }) => {
  const { exports: e } = await WebAssembly.instantiate(data, {});
  const began = performance.now();
  e.exercise();
  const seconds = (performance.now() - began) / 1e3;
  postMessage({ text: new TextDecoder().decode(new Uint8Array(e.memory.buffer, e.text(), e.text_length())), seconds });
};`;

/** All lines of a run in one number: FNV-1a over their letters. */
export const hashOf = (text) => {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 0x01000193);
  return hex(hash);
};

let lastSeconds = 0;
/** Seconds of the last run. */
export const secondsOf = () => lastSeconds;

export async function verify() {
  const by = (id) => document.getElementById(id);
  by("verdict").className = "";
  by("verdict").textContent = "running a million ticks …";
  const worker = new Worker(URL.createObjectURL(new Blob([WORKER], { type: "text/javascript" })));
  worker.postMessage(await module());
  const { text, seconds } = await new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = reject;
  });
  worker.terminate();
  lastSeconds = seconds;
  const same = text === given.script,
    ticks = (1e6 / seconds / 1e6).toFixed(1);
  by("hash").textContent = hashOf(text);
  by("lines").textContent = text
    .trim()
    .split("\n")
    .map((line) => line.split(" features")[0])
    .join("\n");
  by("verdict").className = same ? "good" : "bad";
  by("verdict").textContent = same
    ? `The microcontroller’s, bit for bit: ${given.script.trim().split("\n").length} lines agree. ${ticks} million ticks a second.`
    : `Not the microcontroller’s: that is ${hashOf(given.script)}.`;
  return same;
}
