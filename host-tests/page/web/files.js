// Files that a reader opens or drops: a body, a device, a recording, or a table of places.

import { Vector3 } from "three";
import { read } from "bodies";
import { along, open, places } from "recording";
import { number } from "choices";

const KINDS =
  "the page takes a body (.palp), a device (.toml), a recording (.json) or a table (.csv); " +
  "models and CAD (.step) are baked first, on a computer: cargo palpate bake";

/** Opens a file by what its name ends in; whether it was taken. */
export async function openFile(page, file) {
  const { name } = file;
  const refuse = (why) => (page.refuse(`${name}: ${why}`), false);
  // What is opened is felt; the knob's panel shows neither it nor why not.
  if (page.panel === "knob") page.turnTo("feel");
  if (!/\.(palp|toml|json|csv|step|stp)$/i.test(name)) return refuse(KINDS);
  if (!file.size) return refuse("the file is empty");
  if (/\.palp$/i.test(name)) return page.take(body(file, name));
  const text = await file.text();
  if (/\.(step|stp)$/i.test(name) || /^\s*\[\[patch\]\]/m.test(text)) {
    const baked = name.replace(/\.\w+$/, ".palp");
    return refuse(`a model, not baked yet; run on a computer: cargo palpate bake ${name} --out ${baked}`);
  }
  if (/\.toml$/i.test(name)) return page.held.open(text, name);
  return /\.csv$/i.test(name) ? openTable(page, text, name) : openRecording(page, text, name);
}

async function body(file, name) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  try {
    return await read(bytes, name.replace(/\.palp$/i, ""));
  } catch (error) {
    throw new Error(`${name}: ${error.message}`);
  }
}

/** Shows a recording, from its text. */
export async function openRecording(page, text, name) {
  let found;
  const opened = await page.take((async () => (found = await open(text, name)).body)());
  if (opened) page.player.open(found);
  if (opened) page.room.look(new Vector3(...page.player.front));
  return opened;
}

async function openTable(page, text, title) {
  try {
    const table = { ...places(text, page.held.numbers.name), title },
      name = table.of?.replace(/\.\w+$/, "");
    if (name && name !== page.body.name) {
      if (!page.has(name)) throw new Error(`${title}: a run on ${table.of}, and “${page.body.name}” is selected: open its body, ${name}.palp, first`);
      if (!(await page.take(page.named(name)))) return false;
    }
    // With the settings of the sliders, not of a recording.
    page.player.close();
    page.choose();
    page.player.open(along(table, page.body.device, number("rate")));
    page.refuse(null);
    return true;
  } catch (error) {
    page.refuse(error.message);
    return false;
  }
}
