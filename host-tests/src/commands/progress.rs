//! Progress at the terminal; silent where nobody watches.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A bar that counts ticks, and goes when dropped.
pub struct Ticks(ProgressBar);

/// A bar for a run of so many ticks.
pub fn ticks(length: u32) -> Ticks {
    let bar = ProgressBar::new(u64::from(length));
    let style = ProgressStyle::with_template("  {bar:40} {pos}/{len} ticks, {eta} left");
    bar.set_style(style.expect("the template is a constant"));
    bar.enable_steady_tick(Duration::from_millis(200));
    Ticks(bar)
}

impl Ticks {
    /// So many are done.
    pub fn tell(&self, done: u32) {
        // Redrawing costs more than a tick does.
        if done.is_multiple_of(64) {
            self.0.set_position(u64::from(done));
        }
    }
}

impl Drop for Ticks {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
