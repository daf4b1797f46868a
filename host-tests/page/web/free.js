// Where a picture may be: between the words at the head and at the foot of the stage.

const by = (id) => document.getElementById(id);

/** The stage's size and its free part, px from its top left corner; words at the head may stand beside what is `narrow`. */
export function free(narrow = false) {
  const { left, top, width, height } = by("stage").getBoundingClientRect(),
    head = document.querySelector("header").getBoundingClientRect(),
    foot = by("foot").getBoundingClientRect();
  const from = narrow && head.right - left < 0.45 * width ? 0 : head.bottom - top;
  return { width, height, top: from, bottom: Math.max(foot.top - top, from + 1) };
}

/** Calls whenever the stage or its words have another size. */
export function whenFree(call) {
  const observer = new ResizeObserver(call);
  for (const element of [by("stage"), document.querySelector("header"), by("foot")]) observer.observe(element);
}

/** A slider that a finger moved before its stroke became a scroll goes back to where it was. */
export function keepScrolled() {
  let slider, value;
  addEventListener("pointerdown", ({ target }) => ((slider = target.type === "range" ? target : null), (value = target.value)), true);
  addEventListener("pointercancel", () => {
    if (!slider || slider.value === value) return;
    slider.value = value;
    for (const kind of ["input", "change"]) slider.dispatchEvent(new Event(kind, { bubbles: true }));
  });
}

/** A length of one rem, px: letters that are drawn are as large as those beside them. */
export const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize);
