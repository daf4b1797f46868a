// The sliders: what the loop feels like, and how fast time goes.

const by = (id) => document.getElementById(id);
const SLIDERS = ["stiffness", "friction", "rate", "slow", "law", "rendering"];

/** The settings of the recording that is shown, and the chosen ones to which the sliders return after it. */
let recorded = null,
  kept = null;

/** A number that a slider stands on. */
export const number = (id) => Number(by(id).value);

/** Seconds of the loop that pass in a second. */
export const pace = () => 10 ** -number("slow");

/** What is chosen, as the loop takes it. */
export const choices = (damping = 2) => ({
  rate: number("rate"),
  stiffness: number("stiffness"),
  damping,
  friction: number("friction"),
  law: number("law"),
  rendering: number("rendering"),
  ...recorded,
});

const put = (values) => Object.entries(values).forEach(([id, value]) => (by(id).value = value));
const able = (ids, is) => ids.forEach((id) => (by(id).disabled = !is));

/** Shows the settings of a recording; the sliders do not move until `endRecorded`. */
export function showRecorded(settings) {
  endRecorded();
  kept = Object.fromEntries(Object.keys(settings).map((id) => [id, by(id).value]));
  recorded = settings;
  put(settings);
  able(Object.keys(settings), false);
  say();
}

export function endRecorded() {
  if (!recorded) return;
  put(kept);
  able(Object.keys(kept), true);
  recorded = kept = null;
}

/** Puts the sliders to what a device is recommended with. */
export function setChoices({ stiffness, rendering }) {
  const values = { rate: 4000, stiffness, rendering };
  if (recorded) Object.assign(kept, values);
  else put(values);
}

/** Says beside each slider what it stands on. */
export function say() {
  const { rate, stiffness, friction } = choices();
  for (const [id, text] of [
    ["rate", `${rate} Hz`],
    ["stiffness", stiffness === null ? "each body’s" : `${stiffness} N/m`],
    ["friction", friction ? friction.toFixed(2) : "none"],
    ["slow", number("slow") === 0 ? "real" : `1 / ${Math.round(1 / pace())}`],
  ]) {
    by(id).nextElementSibling.textContent = text;
  }
}

/** Calls whenever one is moved. */
export const whenChosen = (call) => SLIDERS.forEach((id) => by(id).addEventListener("input", call));
