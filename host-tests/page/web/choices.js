// The sliders: what the loop feels like, and how fast time goes.

const by = (id) => document.getElementById(id);
const SLIDERS = ["stiffness", "friction", "rate", "slow", "law", "rendering"];

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
});

/** Puts the sliders to what a device is recommended with. */
export function setChoices({ stiffness, rendering }) {
  Object.assign(by("rate"), { value: 4000 });
  Object.assign(by("stiffness"), { value: stiffness });
  Object.assign(by("rendering"), { value: rendering });
}

/** Says beside each slider what it stands on. */
export function say() {
  const { rate, stiffness, friction } = choices();
  for (const [id, text] of [
    ["rate", `${rate} Hz`],
    ["stiffness", `${stiffness} N/m`],
    ["friction", friction ? friction.toFixed(2) : "none"],
    ["slow", number("slow") === 0 ? "real" : `1 / ${Math.round(1 / pace())}`],
  ]) {
    by(id).nextElementSibling.textContent = text;
  }
}

/** Calls whenever one is moved. */
export const whenChosen = (call) => SLIDERS.forEach((id) => by(id).addEventListener("input", call));
