//! How far a vibration lies above what people feel.

use super::spectrum::{RANGE, Spectrum};
use super::threshold::Threshold;

/// A third of an octave either side of which a band's middle lies: half of it.
const HALF_THIRD: f64 = 1.0 / 6.0;

/// The strongest sensation of a vibration.
///
/// In each third of an octave the power is taken together, weighted by the threshold at its frequency, and given as the
/// level of the tone that has as much: a tone of known peak has its own level, and noise a level that does not depend
/// on how finely it was analysed. (S. Choi and H. Z. Tan, *Perceived instability of virtual haptic texture I*, Presence
/// 13(4), 2004, give spectra of what the hand gets in dB above its threshold; the bands are ours.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensation {
    /// dB above the threshold; below 0 it is not felt.
    pub level: f64,
    /// At which frequency, Hz.
    pub frequency: f64,
}

impl Sensation {
    /// No vibration at all.
    pub const NONE: Self = Self { level: f64::NEG_INFINITY, frequency: 0.0 };

    /// The strongest of a spectrum of displacements, m².
    pub fn of(displacement: &Spectrum, threshold: &Threshold) -> Self {
        let thirds = displacement.bins.iter().map(|[frequency, _]| {
            let half = 2_f64.powf(HALF_THIRD);
            Self {
                level: level_within(displacement, threshold, [frequency / half, frequency * half]),
                frequency: *frequency,
            }
        });
        thirds.fold(Self::NONE, |most, third| if third.level > most.level { third } else { most })
    }

    /// Of two, the stronger.
    pub fn or(self, other: Self) -> Self {
        if other.level > self.level { other } else { self }
    }

    /// Whether it is below the threshold.
    pub fn is_below(self) -> bool {
        self.level <= 0.0
    }
}

/// The level, dB, of all that lies from one frequency to the other, Hz.
pub fn level_within(displacement: &Spectrum, threshold: &Threshold, [from, to]: [f64; 2]) -> f64 {
    let inside = displacement.bins.iter().filter(|bin| from <= bin[0] && bin[0] <= to);
    let weighted: f64 = inside.map(|[frequency, square]| 2.0 * square / threshold.at(*frequency).powi(2)).sum();
    10.0 * weighted.log10()
}

/// Levels by third of an octave, for drawing: frequency, Hz, and level, dB.
pub fn thirds(displacement: &Spectrum, threshold: &Threshold) -> Vec<[f64; 2]> {
    let half = 2_f64.powf(HALF_THIRD);
    let count = (3.0 * (RANGE[1] / RANGE[0]).log2()) as usize;
    (0..=2 * count)
        .map(|index| RANGE[0] * 2_f64.powf(index as f64 / 6.0))
        .map(|middle| [middle, level_within(displacement, threshold, [middle / half, middle * half])])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn tone(frequency: f64, peak: f64) -> Vec<f64> {
        (0..4_000).map(|n| peak * (TAU * frequency * f64::from(n) / 4_000.0).sin()).collect()
    }

    #[test]
    fn a_tone_planted_at_the_threshold_is_found_there_and_nothing_without_it() {
        let threshold = Threshold::approximate();
        let planted = tone(150.0, threshold.at(150.0));
        let found = Sensation::of(&Spectrum::of(&planted, 4_000.0), &threshold);
        // The lobe's bins, 8 Hz either way, see a threshold that falls by 12 dB an octave: 0.1 dB.
        assert!(found.level.abs() < 0.2 && (found.frequency - 150.0).abs() <= 24.0, "{found:?}");
        let silent = Sensation::of(&Spectrum::of(&vec![0.0; 4_000], 4_000.0), &threshold);
        assert_eq!(silent, Sensation::NONE);
    }

    #[test]
    fn twice_the_force_is_six_decibels_more() {
        let threshold = Threshold::approximate();
        let level =
            |peak: f64| Sensation::of(&Spectrum::of(&tone(130.0, peak), 4_000.0).moving(0.0624), &threshold).level;
        // By hand: 12 mN move 62.4 g by F/(m ω²) at 130 Hz, and the threshold there is 0.1 µm · (200/130)².
        let moved = 0.012 / (0.0624 * (TAU * 130.0_f64).powi(2));
        let expected = 20.0 * (moved / (1e-7 * (200.0_f64 / 130.0).powi(2))).log10();
        // As above; here force and threshold fall alike and their slopes cancel.
        assert!((level(0.012) - expected).abs() < 0.2, "{} {expected}", level(0.012));
        assert!((level(0.024) - level(0.012) - 20.0 * 2_f64.log10()).abs() < 1e-9);
    }

    #[test]
    fn noise_has_one_level_however_finely_it_is_analysed() {
        // Flat power over bins of 4 Hz, or of 2 Hz with half as much in each.
        let spectrum = |step: f64, square: f64| Spectrum {
            bins: (0..(980.0 / step) as usize).map(|bin| [20.0 + bin as f64 * step, square]).collect(),
        };
        let threshold = Threshold::approximate();
        let coarse = Sensation::of(&spectrum(4.0, 1e-14), &threshold).level;
        let fine = Sensation::of(&spectrum(2.0, 0.5e-14), &threshold).level;
        // A bin more or less of a dozen in a third of an octave.
        assert!((coarse - fine).abs() < 0.5, "{coarse} {fine}");
    }
}
