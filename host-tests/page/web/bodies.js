// Bodies: those that came with the page, and files.

import { decode, Device } from "firmware";

export const given = JSON.parse(document.getElementById("given").textContent);

const ABSENT = 0xffffffff;

/** A body by the bytes of its file: a device on it, and what its notes call model and faces. */
export async function read(bytes, name, modes) {
  const device = await Device.on(bytes);
  if (modes) device.soften(modes);
  const notes = notesOf(bytes);
  return { device, bytes, name, title: notes.model || name, units: notes.units, faces: notes.faces };
}

export const shipped = (name) => {
  const found = given.bodies.find((body) => body.name === name) ?? given.bodies[0];
  return read(decode(found.palp), found.name, found.modes && decode(found.modes));
};

const FACE_RECORD = 156;

// docs/reference/body-file.md, FACE and NOTE. The file has been checked: its CRC covers both.
function notesOf(bytes) {
  const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const faceRecords = section(data, "FACE");
  let { at, end } = section(data, "NOTE");
  const word = () => data.getUint32((at += 4) - 4, true);
  const text = () => {
    const length = word();
    if (length === ABSENT) return null;
    const found = new TextDecoder().decode(bytes.subarray(at, at + length));
    at += padded(length);
    return found;
  };
  const [units, count] = [word(), word()];
  const model = text();
  const patches = Array.from({ length: count }, (_, index) => text() ?? `patch ${index}`);
  const faces = [];
  for (let face = faceRecords.at; face < faceRecords.end && at < end; face += FACE_RECORD) {
    faces.push(patches[word()] ?? `face ${faces.length}`);
    const inner = data.getUint16(face + 4, true) + data.getUint16(face + 6, true) - 4;
    at += 32 + padded(inner);
  }
  return { units, model, faces };
}

const padded = (length) => Math.ceil(length / 4) * 4;

function section(data, name) {
  let at = 12;
  while (at + 8 < data.byteLength) {
    const found = String.fromCharCode(...[0, 1, 2, 3].map((index) => data.getUint8(at + index)));
    const end = at + 8 + data.getUint32(at + 4, true);
    if (found === name) return { at: at + 8, end };
    at = end;
  }
  return { at, end: at };
}
