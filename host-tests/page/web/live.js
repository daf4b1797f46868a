// A device on a serial port, where the browser has Web Serial: the frames that `palpate monitor` reads, and parts of a
// knob's feel.

import { Orders } from "orders";

/** The speed that `palpate monitor` takes by default, Bd. */
const SPEED = 500_000;

/** Asks for a port, and opens it. */
async function connect() {
  if (!navigator.serial) throw new Error("this browser has no Web Serial: Chromium and Edge on a computer have it");
  const port = await navigator.serial.requestPort();
  await port.open({ baudRate: SPEED });
  return port;
}

/** Tells of each chunk's last record and of a knob's words until the port is closed, and then of nothing; what closes it. */
function listen(port, device, tell) {
  const reader = port.readable.getReader();
  let reads = true;
  (async () => {
    while (reads) {
      const { value, done } = await reader.read();
      if (done) break;
      tell(device.monitor(value), device.heardOfKnob());
    }
  })()
    .catch(() => {})
    .finally(async () => {
      reader.releaseLock();
      await port.close();
      tell(null, null);
    });
  return () => {
    reads = false;
    reader.cancel();
  };
}

/** Shows what a device says, or leaves the one that is shown. */
export async function toggle(page) {
  const by = (id) => document.getElementById(id);
  if (page.live) return page.live.stop();
  const { device } = page.body;
  const buttons = [by("serial"), by("knob-serial")];
  const tell = (record, heard) => {
    if (!heard) {
      page.live.orders.stop();
      page.live = null;
      buttons.forEach((button) => (button.textContent = "Connect a device…"));
      by("knob-said").textContent = "";
      return;
    }
    page.live.dial = heard.dial;
    if (!record) return;
    // A knob's record is of no body.
    if (!heard.dial) page.live.view = seen(record, device);
    by("live").textContent =
      `${record.records} records, ${record.damaged} damaged; a tick took ${(record.took * 1e6).toFixed(1)} µs`;
  };
  try {
    const port = await connect();
    // Before the first byte is read.
    page.live = { view: null, dial: null };
    const write = async (bytes) => {
      const writer = port.writable.getWriter();
      await writer.write(bytes).finally(() => writer.releaseLock());
    };
    page.live.orders = new Orders(device, write, (refusal) => {
      by("knob-said").textContent = refusal || "the device has it";
      if (refusal) page.knob.refuse(refusal);
    });
    page.live.stop = listen(port, device, tell);
    buttons.forEach((button) => (button.textContent = "Disconnect"));
  } catch (error) {
    // Whoever closes the browser's list of ports has chosen none.
    if (error.name === "NotFoundError") return undefined;
    // Beside the button as well: on a phone the picture is far above it.
    for (const id of ["live", "knob-said"]) by(id).textContent = error.message;
    page.refuse(error.message);
  }
  return undefined;
}

/** A record as a view of the loop: the closest point lies a gap away from the probe, and the force shows the way. */
function seen(record, device) {
  const found = device.closest(record.probe);
  const away = record.probe.map((coordinate, axis) => coordinate - found.point[axis]);
  const length = Math.hypot(...away) || 1,
    side = record.gap < 0 ? -1 : 1;
  return {
    ...record,
    target: record.probe,
    point: found.point,
    u: found.u,
    v: found.v,
    normal: away.map((coordinate) => (side * coordinate) / length),
    anchor: found.point,
    gain: 0,
    error: 0,
    evaluations: 0,
    held: 0,
    slips: 0,
    tooDeep: 0,
    rejected: 0,
  };
}
