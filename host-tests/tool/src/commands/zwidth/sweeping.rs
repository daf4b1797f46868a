//! The sweep behind a progress bar, and the best of what it finds.

use indicatif::{ProgressBar, ProgressStyle};
use palpate_sim::zwidth::{DAMPINGS, Limit, Loop, Slice, SoftWall, sweep};

pub(super) fn sweep_with_bar(
    slice: &Slice,
    rates: &[f64],
    delays: &[f64],
    like: Loop,
    soft: Option<&[SoftWall]>,
) -> anyhow::Result<Vec<Limit>> {
    let progress = ProgressBar::new((rates.len() * delays.len() * DAMPINGS.len()) as u64);
    progress.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} walls, {eta} left")?);
    let limits = sweep(slice, rates, delays, like, soft, || progress.inc(1));
    progress.finish_and_clear();
    Ok(limits)
}

/// The maximum stiffness at a rate and a delay, of any damping: simulated, and passive.
pub(super) fn best(limits: &[Limit], rate: f64, delay: f64) -> [f64; 2] {
    let here = limits.iter().filter(|limit| limit.rate == rate && limit.delay_periods == delay);
    here.fold([0.0, 0.0], |[simulated, passive], limit| {
        [f64::max(simulated, limit.simulated), f64::max(passive, limit.passive)]
    })
}
