// Files that a reader opens or drops: a body, a device, a recording, or a table of places.

import { read } from "bodies";
import { open, places } from "recording";

/** Opens a file by what its name ends in; whether it was taken. */
export async function openFile(page, file) {
  const { name } = file;
  if (/\.palp$/i.test(name)) return page.take(body(file, name));
  const text = await file.text();
  if (/\.(step|stp)$/i.test(name) || /^\s*\[\[patch\]\]/m.test(text)) {
    page.refuse(`${name}: a model, not baked yet: cargo palpate bake ${name} --out ${name.replace(/\.\w+$/, "")}.palp`);
    return false;
  }
  if (/\.toml$/i.test(name)) return page.held.open(text, name);
  return /\.csv$/i.test(name) ? openTable(page, text) : openRecording(page, text, name);
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
  return opened;
}

function openTable(page, text) {
  try {
    page.loop.follow(places(text, page.body.device.centre, page.held.numbers.name));
    page.refuse(null);
    return true;
  } catch (error) {
    page.refuse(error.message);
    return false;
  }
}
