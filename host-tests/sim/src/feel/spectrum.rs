//! Power by frequency: Welch's mean over windows of a quarter of a second.

use std::f64::consts::TAU;

/// Length of a window, s. Bins are 4 Hz apart: a third of an octave at 20 Hz still holds one.
const WINDOW: f64 = 0.25;
/// Minimum and maximum frequency of the measurement, Hz: below, the hand itself moves; above, nobody feels anything.
pub const RANGE: [f64; 2] = [20.0, 1_000.0];

/// A band of frequencies, Hz, in which ripple has a distinct feel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Name in tables.
    pub name: &'static str,
    /// From and to, Hz.
    pub range: [f64; 2],
}

/// Flutter, the run-up of the most sensitive receptors, their best, and what lies above.
pub const BANDS: [Band; 4] = [
    Band { name: "20-60 Hz", range: [20.0, 60.0] },
    Band { name: "60-120 Hz", range: [60.0, 120.0] },
    Band { name: "120-350 Hz", range: [120.0, 350.0] },
    Band { name: "350-1000 Hz", range: [350.0, 1_000.0] },
];

/// Mean square of a signal by frequency: each bin's frequency, Hz, and its share of the mean square.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Frequency, Hz, and mean square of the bin.
    pub bins: Vec<[f64; 2]>,
}

impl Spectrum {
    /// Of a signal sampled at `rate`, Hz, the mean of Hann windows that overlap by half, each after its straight line
    /// of least squares is taken off. A signal shorter than a window has no spectrum.
    ///
    /// P. D. Welch, *The use of fast Fourier transform for the estimation of power spectra*, IEEE Trans. Audio and
    /// Electroacoustics 15(2), 1967; the transform itself is done bin by bin, for there are few.
    pub fn of(signal: &[f64], rate: f64) -> Self {
        let length = (WINDOW * rate).round() as usize;
        if signal.len() < length || length < 8 {
            return Self::default();
        }
        let hann: Vec<f64> = (0..length).map(|n| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos()).collect();
        let power: f64 = hann.iter().map(|weight| weight * weight).sum();
        let last = ((RANGE[1] * WINDOW).round() as usize).min(length / 2 - 1);
        let first = (RANGE[0] * WINDOW).round() as usize;
        let mut bins: Vec<[f64; 2]> = (first..=last).map(|bin| [bin as f64 / WINDOW, 0.0]).collect();
        let starts: Vec<usize> = (0..=signal.len() - length).step_by(length / 2).collect();
        for start in &starts {
            let window = straightened(&signal[*start..start + length]);
            let weighted: Vec<f64> = window.iter().zip(&hann).map(|(value, weight)| value * weight).collect();
            for (bin, [_, sum]) in (first..).zip(&mut bins) {
                let (mut real, mut imaginary) = (0.0, 0.0);
                let (turn_sine, turn_cosine) = (TAU * bin as f64 / length as f64).sin_cos();
                let (mut sine, mut cosine) = (0.0, 1.0);
                for value in &weighted {
                    real += value * cosine;
                    imaginary -= value * sine;
                    (sine, cosine) = (sine * turn_cosine + cosine * turn_sine, cosine * turn_cosine - sine * turn_sine);
                }
                // Both signs of the frequency; divided by the window's power, bins add up to the mean square.
                *sum += 2.0 * (real * real + imaginary * imaginary) / (power * length as f64) / starts.len() as f64;
            }
        }
        Self { bins }
    }

    /// Bin by bin the sum of two spectra of the same bins: of two directions.
    pub fn plus(mut self, other: &Self) -> Self {
        self.bins.iter_mut().zip(&other.bins).for_each(|(sum, more)| sum[1] += more[1]);
        self
    }

    /// The peak of the tone that has as much power as there is from one frequency to the other, Hz.
    pub fn peak(&self, [from, to]: [f64; 2]) -> f64 {
        let inside = self.bins.iter().filter(|bin| from <= bin[0] && bin[0] < to);
        (2.0 * inside.fold(0.0, |sum, bin| sum + bin[1])).sqrt()
    }

    /// From the spectrum of a force, N, to that of the displacement of a free mass, kg, under it: `x = F/(m ω²)`.
    pub fn moving(mut self, mass: f64) -> Self {
        for [frequency, square] in &mut self.bins {
            let omega = TAU * *frequency;
            *square /= (mass * omega * omega).powi(2);
        }
        self
    }
}

/// Less its straight line of least squares.
fn straightened(signal: &[f64]) -> Vec<f64> {
    let count = signal.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = signal.iter().sum::<f64>() / count;
    let away = |index: usize| index as f64 - middle;
    let square: f64 = (0..signal.len()).map(|index| away(index).powi(2)).sum();
    let slope = signal.iter().enumerate().map(|(index, value)| away(index) * value).sum::<f64>() / square;
    signal.iter().enumerate().map(|(index, value)| value - mean - slope * away(index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(frequency: f64, peak: f64, rate: f64, seconds: f64) -> Vec<f64> {
        (0..(seconds * rate) as usize).map(|n| peak * (TAU * frequency * n as f64 / rate + 0.3).sin()).collect()
    }

    #[test]
    fn a_tone_of_known_peak_is_found_with_it_at_its_frequency_and_nowhere_else() {
        for rate in [1_000.0, 4_000.0, 10_000.0] {
            for frequency in [23.0, 50.0, 137.0, 150.0, 301.0] {
                let spectrum = Spectrum::of(&tone(frequency, 0.02, rate, 1.0), rate);
                // A window's main lobe is four bins wide; its side lobes hold less than a thousandth.
                let found = spectrum.peak([frequency - 12.0, frequency + 12.0]);
                assert!((found / 0.02 - 1.0).abs() < 2e-3, "{rate} {frequency}: {found}");
                let elsewhere = spectrum.peak([frequency + 40.0, 480.0]);
                assert!(elsewhere < 0.02 * 2e-3, "{rate} {frequency}: {elsewhere}");
            }
        }
    }

    #[test]
    fn white_noise_has_its_mean_square_whatever_the_bins() {
        // A linear congruential generator: 12 of its numbers have variance one.
        let mut seed = 1_u64;
        let mut draw = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let noise: Vec<f64> = (0..40_000).map(|_| (0..12).map(|_| draw()).sum::<f64>() - 6.0).collect();
        let found = Spectrum::of(&noise, 4_000.0).peak([20.0, 1_000.0]);
        // 980 of 2,000 Hz; 79 windows of 245 bins leave 1 % of chance.
        let expected = (2.0_f64 * 980.0 / 2_000.0).sqrt();
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }

    #[test]
    fn a_line_is_no_vibration_and_a_short_signal_has_no_spectrum() {
        let line: Vec<f64> = (0..4_000).map(|n| 1.0 + 0.5 * f64::from(n)).collect();
        // Rounding of 2,000 summed over a thousand terms.
        assert!(Spectrum::of(&line, 4_000.0).peak(RANGE) < 1e-9);
        assert_eq!(Spectrum::of(&line[..500], 4_000.0), Spectrum::default());
    }

    #[test]
    fn a_free_mass_follows_a_force_as_newton_says() {
        let moved = Spectrum::of(&tone(100.0, 0.5, 4_000.0, 1.0), 4_000.0).moving(0.06);
        let expected = 0.5 / (0.06 * (TAU * 100.0_f64).powi(2));
        // The lobe's bins, 8 Hz either way, are weighted by their own frequencies.
        assert!((moved.peak([80.0, 120.0]) / expected - 1.0).abs() < 0.02);
    }
}
