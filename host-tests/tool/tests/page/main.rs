//! The page in headless Chromium, opened from a file as a reader would: beside the host, beside the emulated board.
//!
//! `cargo palpate test --page` sets up what this needs and runs it: `PALPATE_TOOL` is the tool, `PALPATE_CHROMIUM`
//! the browser.

mod browser;
mod closest;
mod files;
mod hands;
mod hash;
mod held;
mod knob;
mod live;
mod looks;
mod pictures;
mod regions;
mod replay;
mod shaped;
mod soft;
mod stylus;
mod tool;
