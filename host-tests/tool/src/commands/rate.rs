//! The servo rate of a run on a board: the highest at which no tick takes longer than the board has, unless a rate is
//! asked for.

use super::options::{RATES, Scene, SceneOptions};
use crate::report::Summary;
use crate::simulation::Trace;
use palpate::servo::Fault;

/// Runs a scene, and again at the next lower of [`RATES`] as long as the run ends with a tick that took too long.
///
/// # Errors
/// A run's error, or a scene that cannot run at a rate.
pub fn in_time<R>(
    options: &SceneOptions,
    scene: &mut Scene,
    mut run: impl FnMut(&Scene) -> anyhow::Result<R>,
    trace: impl Fn(&R) -> &Trace,
) -> anyhow::Result<R> {
    let mut done = run(scene)?;
    while let Some((tick, rate)) = lower(scene.settings.rate_hz, options.rate, Summary::new(trace(&done)).fault) {
        eprintln!(
            "at {} Hz tick {tick} takes longer than the board has: again at {rate} Hz (--rate)",
            scene.settings.rate_hz
        );
        options.change_rate(scene, rate)?;
        done = run(scene)?;
    }
    Ok(done)
}

/// The tick that was too long at a rate, and the rate to go down to: none if a rate was asked for, nor from the lowest.
fn lower(rate: f32, asked: Option<f32>, fault: Option<(Fault, u32)>) -> Option<(u32, f32)> {
    let Some((Fault::Overrun, tick)) = fault else { return None };
    let next = RATES.into_iter().find(|lower| *lower < rate)?;
    asked.is_none().then_some((tick, next))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_that_is_too_long_takes_a_run_down_rate_by_rate() {
        let overrun = Some((Fault::Overrun, 7));
        let mut rates = vec![RATES[0]];
        while let Some((7, rate)) = lower(rates[rates.len() - 1], None, overrun) {
            rates.push(rate);
        }
        assert_eq!(rates, RATES);
    }

    #[test]
    fn nothing_else_changes_the_rate() {
        let overrun = Some((Fault::Overrun, 7));
        assert_eq!(lower(4_000.0, Some(4_000.0), overrun), None, "a rate that was asked for");
        assert_eq!(lower(4_000.0, None, None), None, "a run without a fault");
        assert_eq!(lower(4_000.0, None, Some((Fault::Overspeed, 7))), None, "another fault");
    }
}
