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

/// Instructions in a second of the chip that the emulated boards time a tick by.
const INSTRUCTIONS_PER_SECOND: f64 = 62.5e6;

/// If a run ended with a tick that took too long: what takes too long, by how much, and the remedy.
pub fn too_expensive(scene: &Scene, summary: &Summary) -> Option<String> {
    let tool = scene.tool.map_or_else(String::new, |tool| format!("the tool ({}) on ", tool.shape()));
    verdict(&format!("{tool}{}", scene.model_name()), summary)
}

fn verdict(what: &str, summary: &Summary) -> Option<String> {
    let (Some((Fault::Overrun, tick)), Some(counted)) = (summary.fault, summary.instructions) else { return None };
    let (rate, worst) = (summary.rate, counted.largest);
    Some(format!(
        "{what} is too expensive for the emulated board at {rate} Hz: the worst tick took {worst} instructions, and a \
         period has {:.0}; the motors are off from tick {tick} on. Take a simpler tool or body, or a lower rate: --rate \
         {:.0} has time for that tick",
        (INSTRUCTIONS_PER_SECOND / rate).floor(),
        (INSTRUCTIONS_PER_SECOND / f64::from(worst)).floor()
    ))
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
    use crate::simulation::Sample;

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
    fn a_tick_that_is_too_long_at_every_rate_is_a_verdict_with_a_remedy() {
        let report = |fault, instructions| palpate::wire::Report { fault, instructions, ..Default::default() };
        let summary = |fault: Option<Fault>| {
            let sample = |instructions| Sample {
                time: 0.0,
                sensors: Default::default(),
                report: report(fault.map_or(0, Fault::code), instructions),
                probe: [0.0; 3],
            };
            let samples = [700, 64_927].map(sample).to_vec();
            Summary::new(&Trace { rate: 1_000.0, samples, confirmed: None, contacts_lost: None })
        };
        let said = verdict("the tool on s09", &summary(Some(Fault::Overrun))).unwrap_or_default();
        // 62,500,000 / 64,927 is 962.6.
        for part in ["the tool on s09 is too expensive", "64927 instructions", "has 62500;", "--rate 962 "] {
            assert!(said.contains(part), "{part}: {said}");
        }
        assert_eq!(verdict("s09", &summary(None)), None);
        assert_eq!(verdict("s09", &summary(Some(Fault::Overspeed))), None);
        let timer = include_str!("../../../../boards/emulated/src/timer.rs");
        assert!(timer.contains("CHIP_INSTRUCTIONS_PER_SECOND: u32 = 62_500_000;"), "the boards' deadline");
    }

    #[test]
    fn nothing_else_changes_the_rate() {
        let overrun = Some((Fault::Overrun, 7));
        assert_eq!(lower(4_000.0, Some(4_000.0), overrun), None, "a rate that was asked for");
        assert_eq!(lower(4_000.0, None, None), None, "a run without a fault");
        assert_eq!(lower(4_000.0, None, Some((Fault::Overspeed, 7))), None, "another fault");
    }
}
