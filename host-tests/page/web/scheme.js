// Light or dark, as the reader prefers: the colours of style.css for what is drawn.

const prefers = matchMedia("(prefers-color-scheme: light)");
let found = {};
prefers.addEventListener("change", () => (found = {}));

/** A colour by its name there. */
export const colour = (name) =>
  (found[name] ??= getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());

/** Calls now, and whenever the colours are others. */
export function withColours(call) {
  call();
  prefers.addEventListener("change", call);
}
