//! Progress at the terminal; silent where nobody watches.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A bar that counts ticks, and goes when dropped.
pub struct Ticks(ProgressBar);

/// A bar for a run of this many ticks.
pub fn ticks(length: u32) -> Ticks {
    let bar = ProgressBar::new(u64::from(length));
    let style = ProgressStyle::with_template("  {bar:40} {pos}/{len} ticks, {eta} left");
    bar.set_style(style.expect("the template is a constant"));
    bar.enable_steady_tick(Duration::from_millis(200));
    Ticks(bar)
}

/// A progress bar for work whose length is set as it proceeds; removed when dropped.
pub struct Work(ProgressBar);

/// A progress bar for work that is about to start.
pub fn work() -> Work {
    let bar = ProgressBar::no_length();
    let style = ProgressStyle::with_template("  {bar:40} {pos}/{len} {msg}, {eta} left");
    bar.set_style(style.expect("the template is a constant"));
    Work(bar)
}

impl Work {
    /// So much is done, of so much, of this.
    pub fn tell(&self, what: &str, done: usize, all: usize) {
        if self.0.message() != what {
            self.0.reset();
            self.0.set_message(what.to_owned());
        }
        self.0.set_length(all as u64);
        self.0.set_position(done as u64);
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

impl Ticks {
    /// Sets the number of finished steps.
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
