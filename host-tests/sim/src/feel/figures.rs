//! Figures of a recording: the hand's sensations.

use super::record::{Recording, Tick};
use super::sensation::Sensation;
use super::spectrum::{BANDS, Spectrum};
use super::threshold::Threshold;
use crate::plant::Vector;

/// Time after the start of a contact, and around its end, within which a step counts as theirs, s.
const AROUND: f64 = 0.01;

/// The largest steps of force from one tick to the next, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steps {
    /// In the 10 ms from the tick in which contact started.
    pub contact: f64,
    /// In the 10 ms before the force ended, and in the tick in which it ended.
    pub release: f64,
    /// Anywhere.
    pub any: f64,
}

/// The figures of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// The largest steps.
    pub steps: Steps,
    /// Ripple of the force in the measured window after subtraction of its linear trend, peak to peak, N.
    pub ripple: f64,
    /// Peak of a tone with the ripple's power in each of the [`BANDS`], N.
    pub bands: [f64; BANDS.len()],
    /// The spectrum of the probe's displacement, all directions together.
    pub displacement: Spectrum,
    /// The most noticeable component of the displacement.
    pub sensation: Sensation,
    /// Mean length of the force, N.
    pub force: f64,
    /// Mean depth of the probe in the loop's view, m; 0 without contact.
    pub depth: f64,
    /// Mean force against the hand's motion, N.
    pub drag: f64,
    /// Number of contacts that started.
    pub touches: usize,
    /// The longest time with force on a probe in front of the surface, s.
    pub afterglow: f64,
}

impl Recording {
    /// The figures; the ripple is measured from one time to another, s.
    pub fn figures(&self, looked_at: [f64; 2], threshold: &Threshold) -> Figures {
        let window = self.between(looked_at);
        let along = |axis: usize, of: fn(&Tick) -> Vector| window.iter().map(|tick| of(tick)[axis]).collect::<Vec<_>>();
        let spectrum = |of: fn(&Tick) -> Vector| {
            let [x, y, z] = [0, 1, 2].map(|axis| Spectrum::of(&along(axis, of), self.rate));
            x.plus(&y).plus(&z)
        };
        let force = spectrum(|tick| tick.force);
        let displacement = spectrum(|tick| tick.probe);
        let lengths: Vec<f64> = window.iter().map(|tick| length(tick.force)).collect();
        Figures {
            steps: self.steps(),
            ripple: peak_to_peak(&lengths),
            bands: BANDS.map(|band| force.peak(band.range)),
            sensation: Sensation::of(&displacement, threshold),
            displacement,
            force: mean(&lengths),
            depth: mean(&window.iter().map(|tick| if tick.is_touching { -tick.gap } else { 0.0 }).collect::<Vec<_>>()),
            drag: self.drag(window),
            touches: self.ticks.windows(2).filter(|pair| !pair[0].is_touching && pair[1].is_touching).count(),
            afterglow: self.afterglow(),
        }
    }

    /// The ticks from one time to another, s.
    pub fn between(&self, [from, to]: [f64; 2]) -> &[Tick] {
        let index = |time: f64| ((time * self.rate).max(0.0) as usize).min(self.ticks.len());
        &self.ticks[index(from)..index(to).max(index(from))]
    }

    /// The largest steps of force.
    pub fn steps(&self) -> Steps {
        let around = (AROUND * self.rate).round() as usize;
        let mut steps = Steps::default();
        let mut since_contact = usize::MAX;
        // The largest steps of the last ticks, for what turns out to have been a release.
        let mut last: std::collections::VecDeque<f64> = std::collections::VecDeque::new();
        for pair in self.ticks.windows(2) {
            let [before, now] = [pair[0], pair[1]];
            since_contact = if now.is_touching && !before.is_touching { 0 } else { since_contact.saturating_add(1) };
            let step = length(core::array::from_fn(|axis| now.force[axis] - before.force[axis]));
            steps.any = steps.any.max(step);
            if since_contact < around {
                steps.contact = steps.contact.max(step);
            }
            last.push_back(step);
            if last.len() > around {
                last.pop_front();
            }
            if length(before.force) > 0.0 && length(now.force) == 0.0 {
                steps.release = last.iter().copied().fold(steps.release, f64::max);
            }
        }
        steps
    }

    fn drag(&self, window: &[Tick]) -> f64 {
        let mut sum = (0.0, 0.0);
        for pair in window.windows(2) {
            let moved: Vector = core::array::from_fn(|axis| pair[1].probe[axis] - pair[0].probe[axis]);
            sum.0 += (0..3).map(|axis| pair[0].hand[axis] * moved[axis]).sum::<f64>();
            sum.1 += length(moved);
        }
        if sum.1 > 0.0 { sum.0 / sum.1 } else { 0.0 }
    }

    fn afterglow(&self) -> f64 {
        let (mut longest, mut now) = (0_usize, 0_usize);
        for tick in &self.ticks {
            now = if !tick.is_touching && length(tick.force) > 0.0 { now + 1 } else { 0 };
            longest = longest.max(now);
        }
        longest as f64 / self.rate
    }

    /// How far the probe went while the direction of the force turned from a tenth to nine tenths of its way between
    /// two directions, m; `None` where it did not.
    pub fn turn(&self, [from, to]: [Vector; 2], looked_at: [f64; 2]) -> Option<f64> {
        let full = angle(from, to);
        let mut travelled = 0.0;
        let mut begun = None;
        for pair in self.between(looked_at).windows(2) {
            travelled += length(core::array::from_fn(|axis| pair[1].probe[axis] - pair[0].probe[axis]));
            if length(pair[1].force) == 0.0 {
                continue;
            }
            let share = angle(from, pair[1].force) / full;
            if share < 0.1 {
                begun = Some(travelled);
            }
            if share > 0.9 {
                return begun.map(|begun| travelled - begun);
            }
        }
        None
    }
}

/// The angle between two directions, rad.
pub fn angle(a: Vector, b: Vector) -> f64 {
    let product: f64 = (0..3).map(|axis| a[axis] * b[axis]).sum();
    (product / (length(a) * length(b))).clamp(-1.0, 1.0).acos()
}

pub fn length(vector: Vector) -> f64 {
    vector.iter().map(|coordinate| coordinate * coordinate).sum::<f64>().sqrt()
}

fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// Difference of maximum and minimum.
fn peak_to_peak(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    if values.is_empty() { 0.0 } else { high - low }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A force along z by tick, touching where it is not zero.
    fn recording(forces: &[f64]) -> Recording {
        let tick = |force: &f64| Tick { force: [0.0, 0.0, *force], is_touching: *force > 0.0, ..Tick::default() };
        Recording { rate: 1_000.0, ticks: forces.iter().map(tick).collect(), ..Recording::default() }
    }

    #[test]
    fn steps_belong_to_the_contact_that_began_or_ended() {
        let mut forces = vec![0.0; 20];
        forces.push(0.3);
        forces.extend((0..40).map(|n| 0.3 + 0.01 * f64::from(n)));
        // In the middle, more than 10 ms from either end.
        forces.push(1.5);
        forces.extend([1.5; 30]);
        forces.extend([1.0, 0.0, 0.0]);
        let steps = recording(&forces).steps();
        // Rounding of sums of tenths.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(steps.contact, 0.3) && near(steps.release, 1.0) && near(steps.any, 1.0), "{steps:?}");
    }

    #[test]
    fn ripple_and_its_bands_are_those_of_a_known_signal() {
        let signal = |n: usize| 1.0 + 0.05 * (std::f64::consts::TAU * 150.0 * n as f64 / 4_000.0).sin();
        let mut recording = recording(&(0..4_000).map(signal).collect::<Vec<_>>());
        recording.rate = 4_000.0;
        let figures = recording.figures([0.0, 1.0], &Threshold::approximate());
        // A 27th of a period between ticks misses the peak by (π/27)²/2 at most.
        assert!((figures.ripple - 0.1).abs() < 0.1 * 0.007, "{}", figures.ripple);
        assert!((figures.bands[2] - 0.05).abs() < 1e-4, "{:?}", figures.bands);
        assert!(figures.bands[0] < 1e-4 && figures.bands[3] < 1e-4, "{:?}", figures.bands);
        assert!((figures.force - 1.0).abs() < 1e-9, "{}", figures.force);
    }

    #[test]
    fn a_direction_turns_over_the_way_that_the_probe_went() {
        // A quarter of a turn over 1 mm, in 100 steps of 10 µm.
        let tick = |n: usize| {
            let turned = std::f64::consts::FRAC_PI_2 * n as f64 / 100.0;
            Tick { probe: [1e-5 * n as f64, 0.0, 0.0], force: [turned.sin(), 0.0, turned.cos()], ..Tick::default() }
        };
        let recording = Recording { rate: 1_000.0, ticks: (0..=100).map(tick).collect(), ..Recording::default() };
        let turn = recording.turn([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], [0.0, 1.0]);
        // From a tenth to nine tenths, a step more or less at either end.
        assert!(turn.is_some_and(|way| (way - 0.8e-3).abs() < 2.5e-5), "{turn:?}");
        assert_eq!(recording.turn([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], [0.0, 1.0]), None);
    }

    #[test]
    fn a_force_on_a_probe_that_touches_nothing_is_counted_in_seconds() {
        let mut recording = recording(&[0.0, 1.0, 1.0, 0.6, 0.3, 0.0]);
        recording.ticks[3].is_touching = false;
        recording.ticks[4].is_touching = false;
        let figures = recording.figures([0.0, 0.006], &Threshold::approximate());
        assert!((figures.afterglow - 0.002).abs() < 1e-12 && figures.touches == 1, "{figures:?}");
    }
}
