//! The race: the same surface and the same probes for palpate, for Newton's method and for what people use today, with
//! answers judged by golden points. The contestants are a package of their own (`host-tests/race`), run once by the
//! clock and once under valgrind, which counts instructions exactly.

mod budget;
mod callgrind;
mod judge;
pub mod on_target;
mod path;
mod plot;
mod program;
mod scene;
mod table;

pub use crate::spread::Spread;
pub use budget::{Budget, Excess, excesses};
pub use judge::Score;
pub use plot::draw;
pub use program::{Counted, Program, Who};
pub use scene::{Query, Scene, Task};
pub use table::{csv, text};

use crate::firmware::Progress;
use anyhow::Context as _;

/// Times, counts and judges all contestants of a program on a scene.
///
/// # Errors
/// A contestant that cannot be run or says what cannot be read.
pub fn race(program: &Program, scene: &Scene, progress: &Progress) -> anyhow::Result<Vec<Score>> {
    let what = |how: &str| format!("{how} {} ({} queries)", scene.title(), scene.queries.len());
    let timed = progress.during(&what("timing"), || program.time(scene, &[]))?;
    let counts = progress.during(&what("counting"), || program.count(scene, &[]))?;
    timed
        .iter()
        .map(|run| {
            let counted = counts.iter().find(|counted| counted.contestant == run.contestant);
            let counted = counted.with_context(|| format!("{} was not counted", run.contestant))?;
            Ok(judge::score(scene, run, counted))
        })
        .collect()
}

/// Whether valgrind is there.
pub fn is_set_up() -> bool {
    callgrind::is_set_up()
}

/// Installs valgrind if it is missing.
///
/// # Errors
/// Why it cannot be had.
pub fn set_up(progress: &Progress) -> anyhow::Result<()> {
    callgrind::set_up(progress)
}
