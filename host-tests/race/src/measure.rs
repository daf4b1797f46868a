//! Running a contestant over all probes: by the clock, or query by query for an instruction counter.

use crate::contestant::{Answer, Contestant, Enter};
use crate::scene::{Probe, Scene};
use std::hint::black_box;
use std::time::Instant;

/// Runs by the clock; of each query the quickest run counts, for the machine does other things, too.
const RUNS: usize = 5;

/// One query. The instruction counter counts from entering this function to leaving it: `cargo palpate race` knows its
/// name.
#[inline(never)]
pub fn counted(contestant: &mut dyn Contestant, probe: &Probe) -> Answer {
    contestant.answer(probe)
}

/// Answers and nanoseconds, query by query. The clock's own time is taken off.
pub fn time(scene: &Scene, enter: Enter) -> anyhow::Result<Vec<(Answer, Option<u64>)>> {
    let clock = clock();
    let mut best: Vec<(Answer, Option<u64>)> = vec![(Answer::Nothing, Some(u64::MAX)); scene.probes.len()];
    for _ in 0..RUNS {
        let mut contestant = enter(scene)?;
        for (probe, (answer, least)) in scene.probes.iter().zip(&mut best) {
            let start = Instant::now();
            *answer = black_box(counted(black_box(contestant.as_mut()), black_box(probe)));
            let taken = (start.elapsed().as_nanos() as u64).saturating_sub(clock);
            *least = least.map(|least| least.min(taken));
        }
    }
    Ok(best)
}

/// Answers all queries without timing; counts one query in every `stride` of the scene.
pub fn count(scene: &Scene, enter: Enter) -> anyhow::Result<Vec<(Answer, Option<u64>)>> {
    let mut contestant = enter(scene)?;
    let answer = |(row, probe): (usize, &Probe)| {
        let (contestant, probe) = (black_box(contestant.as_mut()), black_box(probe));
        let answer = if row % scene.stride == 0 { counted(contestant, probe) } else { contestant.answer(probe) };
        (black_box(answer), None)
    };
    Ok(scene.probes.iter().enumerate().map(answer).collect())
}

/// Nanoseconds between two readings of the clock, the minimum of many.
fn clock() -> u64 {
    let look = |_| {
        let start = Instant::now();
        start.elapsed().as_nanos() as u64
    };
    (0..10_000).map(look).min().unwrap_or(0)
}
