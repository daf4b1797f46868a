//! Progress display of long steps: a spinner on a terminal, plain lines elsewhere.

use indicatif::{ProgressBar, ProgressStyle};
use std::env;
use std::io::{IsTerminal, stderr};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// Prints the current step on standard error.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    spins: bool,
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}

impl Progress {
    /// A spinner on a terminal; lines where there is none, or in continuous integration.
    pub fn new() -> Self {
        Self { spins: stderr().is_terminal() && env::var_os("CI").is_none() }
    }

    /// Says something.
    pub fn say(&self, line: &str) {
        eprintln!("{line}");
    }

    /// Does some work, named in the present ("building the image"), and says how long it took; where there is no
    /// spinner, also every half minute that it is still at work.
    pub fn during<T>(&self, what: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = if self.spins {
            let spinner = ProgressBar::new_spinner().with_message(what.to_owned());
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
                spinner.set_style(style);
            }
            spinner.enable_steady_tick(Duration::from_millis(100));
            let result = work();
            spinner.finish_and_clear();
            result
        } else {
            self.say(&format!("{what} ..."));
            while_telling(what, start, work)
        };
        self.say(&format!("{what}: {:.1} s", start.elapsed().as_secs_f32()));
        result
    }
}

/// Time between two lines where there is no spinner.
const EVERY: Duration = Duration::from_secs(30);

fn while_telling<T>(what: &str, start: Instant, work: impl FnOnce() -> T) -> T {
    let (done, waits) = mpsc::channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            // The sender is dropped when the work ends, also by a panic.
            while waits.recv_timeout(EVERY) == Err(RecvTimeoutError::Timeout) {
                eprintln!("{what}: {:.0} s so far", start.elapsed().as_secs_f32());
            }
        });
        let result = work();
        drop(done);
        result
    })
}

/// Shows the importer's lines of progress, at a terminal as one line, elsewhere one every ten seconds, and returns the
/// others.
pub fn told(lines: impl Iterator<Item = String>) -> String {
    const EVERY: Duration = Duration::from_secs(10);
    let bar = ProgressBar::new_spinner();
    let (mut others, mut last) = (Vec::new(), Instant::now());
    for line in lines {
        let Some(state) = line.strip_prefix("progress: ") else {
            others.push(line);
            continue;
        };
        if stderr().is_terminal() {
            bar.set_message(format!("dividing {state}"));
            bar.tick();
        } else if last.elapsed() >= EVERY {
            last = Instant::now();
            eprintln!("dividing {state}");
        }
    }
    bar.finish_and_clear();
    others.join("\n").trim().to_owned()
}
