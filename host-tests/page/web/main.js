// The page begins: what is clicked, dropped and chosen goes to it, and a frame follows the other.

import { given, shipped } from "bodies";
import { Page } from "page";
import { openFile, openRecording } from "files";
import { Script } from "script";
import { toggle } from "live";
import { number, whenChosen } from "choices";
import { verify } from "proof";
import { explain } from "why";
import { keepScrolled, whenFree } from "free";

const by = (id) => document.getElementById(id);
const page = new Page();

function wire() {
  by("no-webgl").hidden = page.room.renderer !== null;
  for (const { name, title } of given.bodies) by("body").add(new Option(title, name));
  by("body").addEventListener("change", ({ target: { value } }) => page.take(page.named(value)));
  whenChosen(() => page.choose());
  by("height").addEventListener("input", () => page.pointer.holdAt(number("height") / 100));
  by("refusal").addEventListener("click", () => page.refuse(null));
  by("hand").addEventListener("change", () => page.pointer.moveIn(by("hand").value, page.loop.place));
  document
    .querySelectorAll("[role=tab]")
    .forEach((button) => button.addEventListener("click", () => page.turnTo(button.dataset.tab)));
  by("open").addEventListener("click", () => by("file").click());
  by("file").addEventListener("change", ({ target: { files } }) => files[0] && openFile(page, files[0]));
  by("look").addEventListener("click", () => page.room.look(page.room.from));
  by("verify").addEventListener("click", verify);
  by("table1").addEventListener("click", () => page.take(shipped("table1")));
  by("leave").addEventListener("click", () => page.leave());
  for (const button of ["serial", "knob-serial"]) by(button).addEventListener("click", () => toggle(page));
  explain();
  keepScrolled();
  for (const [words, address] of given.links ?? [])
    by("links").append(Object.assign(document.createElement("a"), { textContent: words, href: address, target: "_blank" }));
  addEventListener("resize", () => page.room.resize());
  whenFree(() => page.room.resize());
  addEventListener("dragover", (event) => (event.preventDefault(), (by("drop").hidden = false)));
  addEventListener("dragleave", (event) => event.relatedTarget ?? (by("drop").hidden = true));
  addEventListener("drop", (event) => {
    event.preventDefault();
    by("drop").hidden = true;
    if (event.dataTransfer.files[0]) openFile(page, event.dataTransfer.files[0]);
  });
}

function frame(now) {
  requestAnimationFrame(frame);
  page.frame(now);
}

async function begin() {
  wire();
  await page.take(shipped(given.first));
  requestAnimationFrame(frame);
  if (given.recording) await openRecording(page, JSON.stringify(given.recording), "the recording");
  return true;
}

window.palpate = new Script(page);
window.palpate.ready = begin();
