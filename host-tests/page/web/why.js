// Short explanations of words: on hover, on focus, and on a tap.

const bubble = document.getElementById("why");

function show(word) {
  bubble.textContent = word.dataset.why;
  bubble.hidden = false;
  const { left, bottom, top } = word.getBoundingClientRect(),
    { offsetWidth: width, offsetHeight: height } = bubble;
  bubble.style.left = `${Math.max(8, Math.min(left, innerWidth - width - 8))}px`;
  bubble.style.top = `${bottom + height + 8 > innerHeight ? top - height - 6 : bottom + 6}px`;
}

const hide = () => (bubble.hidden = true);

/** Begins. */
export function explain() {
  for (const word of document.querySelectorAll("[data-why]")) {
    word.tabIndex = 0;
    word.setAttribute("aria-describedby", "why");
    // A finger that scrolls enters words, too: its tap gives the focus.
    word.addEventListener("pointerenter", ({ pointerType }) => pointerType === "mouse" && show(word));
    word.addEventListener("focus", () => show(word));
    // A finger that has tapped is gone at once; the word keeps the focus until the next tap.
    word.addEventListener("pointerleave", ({ pointerType }) => pointerType === "mouse" && hide());
    word.addEventListener("blur", hide);
    // The word of a row explains itself; only the rest of the row goes to its slider.
    word.addEventListener("click", (event) => (event.preventDefault(), show(word)));
  }
  addEventListener("keydown", ({ key }) => key === "Escape" && hide());
  // One that a tap opened would stay where it is while its word goes; a key scrolls to its word.
  addEventListener("scroll", () => document.activeElement?.matches("[data-why]:not(:focus-visible)") && hide(), true);
  addEventListener("pointerdown", ({ target }) => target.closest?.("[data-why]") ?? hide());
}
