//! The weakest vibration of a held stylus that people feel, by frequency.

use thiserror::Error;

/// A detection threshold: peak displacement, metres, by frequency, straight between its points in decibels over the
/// logarithm of the frequency, and level beyond its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Threshold {
    points: Vec<[f64; 2]>,
}

/// Why a table is no threshold.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ThresholdError {
    /// There is no point.
    #[error("a threshold needs at least one point")]
    Empty,
    /// A frequency or a displacement that is not positive and finite.
    #[error("point {0} of the threshold is not positive and finite")]
    NotPositive(usize),
    /// Frequencies that do not rise.
    #[error("the frequencies of the threshold do not rise at point {0}")]
    Order(usize),
}

/// Decibels for a factor of ten in amplitude.
const DECIBELS_A_DECADE: f64 = 20.0;
/// 12 dB an octave, as an exponent of the frequency.
const STEEP: f64 = 2.0;

impl Threshold {
    /// A table of frequency, Hz, and peak displacement, m.
    ///
    /// # Errors
    /// A fault of the table.
    pub fn try_new(points: Vec<[f64; 2]>) -> Result<Self, ThresholdError> {
        if points.is_empty() {
            return Err(ThresholdError::Empty);
        }
        let is_positive = |number: &f64| *number > 0.0 && number.is_finite();
        if let Some(index) = points.iter().position(|point| !point.iter().all(is_positive)) {
            return Err(ThresholdError::NotPositive(index));
        }
        if let Some(index) = points.windows(2).position(|pair| pair[0][0] >= pair[1][0]) {
            return Err(ThresholdError::Order(index + 1));
        }
        Ok(Self { points })
    }

    /// The default threshold: **approximated**, not copied from a table of measurements, because none was available.
    ///
    /// Only its shape is published. With a large contactor it is level up to 40 Hz and falls from there by 12 dB an
    /// octave (Gescheider and Verrillo 1979, of Verrillo 1963); for vibration through an object in the hand it is a U
    /// with its minimum between 150 and 200 Hz (Brisben, Hsiao and Johnson 1999). Here it is level from 200 Hz to 250
    /// Hz, where others find the minimum, and rises as steeply as it fell. Its **level**, 0.1 µm at the minimum, is a
    /// round number assumed for a pen-held stylus: Brisben and others found less than 0.01 µm for the most sensitive
    /// subjects who gripped a whole cylinder. If you have the curve of Israr, Choi and Tan 2006, of the hand in
    /// pen-hold from 10 to 500 Hz, use it instead.
    pub fn approximate() -> Self {
        let least: f64 = 1e-7;
        let at = |frequency: f64| {
            let below = (200.0 / frequency.max(40.0)).max(1.0);
            let above = (frequency / 250.0).max(1.0);
            [frequency, least * (below * above).powf(STEEP)]
        };
        Self { points: [10.0, 40.0, 200.0, 250.0, 1_000.0].map(at).to_vec() }
    }

    /// The threshold at a frequency, Hz: peak displacement, m.
    pub fn at(&self, frequency: f64) -> f64 {
        let after = self.points.partition_point(|point| point[0] <= frequency);
        let (Some(from), Some(to)) = (after.checked_sub(1).and_then(|at| self.points.get(at)), self.points.get(after))
        else {
            let end = if after == 0 { self.points.first() } else { self.points.last() };
            return end.map_or(f64::INFINITY, |point| point[1]);
        };
        let share = (frequency / from[0]).ln() / (to[0] / from[0]).ln();
        from[1] * (to[1] / from[1]).powf(share)
    }

    /// Sensation level, dB: how far a vibration of this peak displacement, m, lies above the threshold.
    pub fn level(&self, frequency: f64, displacement: f64) -> f64 {
        DECIBELS_A_DECADE * (displacement / self.at(frequency)).log10()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_approximate_curve_has_the_published_shape() {
        let threshold = Threshold::approximate();
        let decibels = |from: f64, to: f64| 20.0 * (threshold.at(to) / threshold.at(from)).log10();
        // Rounding of logarithms and powers.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(decibels(10.0, 40.0), 0.0), "level up to 40 Hz");
        // An octave is 20·log10(4) = 12.04 dB at the second power.
        let octave = 20.0 * 4.0_f64.log10();
        assert!(near(decibels(50.0, 100.0), -octave) && near(decibels(300.0, 600.0), octave));
        assert!((10..1_000).all(|hertz| threshold.at(f64::from(hertz)) >= threshold.at(200.0) * (1.0 - 1e-12)));
        assert!(near(threshold.at(220.0) * 1e7, 1.0));
    }

    #[test]
    fn a_level_counts_from_the_threshold() {
        let threshold = Threshold::try_new(vec![[100.0, 1e-6], [200.0, 1e-7]]).unwrap();
        assert!(threshold.level(100.0, 1e-6).abs() < 1e-9);
        assert!((threshold.level(200.0, 1e-6) - 20.0).abs() < 1e-9);
        // Half way in octaves, half way in decibels; level beyond both ends.
        let middle = (100.0_f64 * 200.0).sqrt();
        assert!((threshold.level(middle, 1e-6) - 10.0).abs() < 1e-9);
        assert!(threshold.level(10.0, 1e-6).abs() < 1e-9 && (threshold.level(900.0, 1e-6) - 20.0).abs() < 1e-9);
    }

    #[test]
    fn a_table_that_makes_no_sense_is_refused_by_its_point() {
        assert_eq!(Threshold::try_new(vec![]), Err(ThresholdError::Empty));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let table = |point| Threshold::try_new(vec![[10.0, 1e-6], point]);
            assert_eq!(table([bad, 1e-6]), Err(ThresholdError::NotPositive(1)));
            assert_eq!(table([20.0, bad]), Err(ThresholdError::NotPositive(1)));
        }
        assert_eq!(Threshold::try_new(vec![[20.0, 1e-6], [20.0, 1e-6]]), Err(ThresholdError::Order(1)));
    }
}
