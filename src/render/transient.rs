//! What a hard thing gives back when it is struck: a pulse that rings, as strong as the blow.

/// A pulse on top of the wall's own force: `A e^(−t/τ) (1 − cos ωt)/2`, with `A` in proportion to the speed of the
/// blow.
///
/// Sinusoids that decay, scaled by the speed of impact, are what a tapped material gives (A. M. Okamura, M. R.
/// Cutkosky, J. T. Dennerlein, *Reality-based models for vibration feedback in virtual environments*, IEEE/ASME Trans.
/// Mechatronics 6(3), 2001), and make a virtual wall feel as hard (J. P. Fiene, K. J. Kuchenbecker, *Shaping
/// event-based haptic transients via an improved understanding of real contact dynamics*, World Haptics 2007). Here it
/// is raised so that it only ever pushes: from the front, as the wall does. It begins with 0 and without a slope, so
/// that it makes no step of its own: `A (π f + 1/τ)` is its steepest, N/s.
///
/// It is active: what it gives to a probe that is on its way out by then is at most `A τ` times the fastest speed out,
/// for `∫ e^(−t/τ) = τ`. A passivity controller sees it as it sees any force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transient {
    /// `A` by the speed of the blow, N·s/m.
    pub gain: f32,
    /// The greatest `A`, N.
    pub max_force: f32,
    /// How often it rings, Hz.
    pub frequency: f32,
    /// In what time it fades to a third (`1/e`), s.
    pub decay: f32,
}

/// A [`Transient`] ready to run at a rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Struck {
    gain: f32,
    max_force: f32,
    /// What a period leaves of the pulse's height.
    left: f32,
    /// The same times cosine and sine of the angle by which it goes on.
    turn: [f32; 2],
}

/// What still rings: height, N, and height times cosine and sine of the phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ring {
    height: f32,
    phase: [f32; 2],
}

impl Transient {
    /// Wood, struck: assumed, dull and short. At 0.3 m/s 0.3 N. With [`super::Ease::RINGING`], which lets it by.
    pub const WOOD: Self = Self { gain: 1.0, max_force: 0.5, frequency: 100.0, decay: 0.012 };

    /// Steel, struck: assumed, higher and longer.
    pub const STEEL: Self = Self { gain: 1.0, max_force: 0.5, frequency: 150.0, decay: 0.03 };

    /// Ready to run at a rate, Hz; `None` for what is negative or not finite, or too fast for the rate: eight ticks
    /// make a ring at least, and two the decay.
    pub const fn at(&self, rate: f32) -> Option<Struck> {
        let Self { gain, max_force, frequency, decay } = *self;
        let strong = gain >= 0.0 && gain < f32::INFINITY && max_force >= 0.0 && max_force < f32::INFINITY;
        let slow = frequency >= 0.0 && frequency <= rate / 8.0 && decay * rate >= 2.0 && decay < f32::INFINITY;
        if !(strong && slow) {
            return None;
        }
        // Both by the trapezoidal rule: at an eighth of the rate it rings 5 % low.
        let half_angle = core::f32::consts::PI * frequency / rate;
        let left = (2.0 * decay * rate - 1.0) / (2.0 * decay * rate + 1.0);
        let scale = left / (1.0 + half_angle * half_angle);
        let turn = [scale * (1.0 - half_angle * half_angle), scale * 2.0 * half_angle];
        Some(Struck { gain, max_force, left, turn })
    }
}

impl Struck {
    /// A blow at a speed towards the surface, m/s: the ring that it begins. What is not positive, or no number, begins
    /// none.
    #[inline]
    pub fn blow(&self, speed: f32) -> Ring {
        let asked = self.gain * speed;
        let height = if asked < self.max_force { asked } else { self.max_force };
        let is_blow = speed > 0.0;
        if is_blow { Ring { height, phase: [height, 0.0] } } else { Ring::default() }
    }

    /// The ring a period later.
    #[inline]
    pub fn next(&self, ring: Ring) -> Ring {
        let ([cosine, sine], [along, across]) = (ring.phase, self.turn);
        Ring {
            height: ring.height * self.left,
            phase: [cosine * along - sine * across, cosine * across + sine * along],
        }
    }
}

impl Ring {
    /// The push, N: never negative.
    #[inline]
    pub fn push(&self) -> f32 {
        let raised = 0.5 * (self.height - self.phase[0]);
        if raised > 0.0 { raised } else { 0.0 }
    }

    /// Its words, for a hash.
    pub(crate) const fn words(&self) -> [u32; 3] {
        [self.height.to_bits(), self.phase[0].to_bits(), self.phase[1].to_bits()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    const RATE: f32 = 4_000.0;

    fn rings(speed: f32, transient: Transient) -> impl Iterator<Item = f32> {
        let struck = transient.at(RATE).unwrap();
        core::iter::successors(Some(struck.blow(speed)), move |ring| Some(struck.next(*ring))).map(|ring| ring.push())
    }

    #[test]
    fn it_is_the_closed_form_begins_with_nothing_and_only_pushes() {
        for transient in [Transient::WOOD, Transient::STEEL] {
            let (mut last, mut sum) = (0.0, 0.0);
            let height = 0.3 * transient.gain;
            let steepest = height * (core::f32::consts::PI * transient.frequency + 1.0 / transient.decay) / RATE;
            for (tick, push) in rings(0.3, transient).take(1_000).enumerate() {
                let time = tick as f32 / RATE;
                let cosine = sin_cos(core::f32::consts::TAU * transient.frequency * time).1;
                // e^(−t/τ) as (1 + t/(τ n))^(−n).
                let left = (0..10).fold(1.0 + time / transient.decay / 1_024.0, |power, _| power * power).recip();
                let closed = 0.5 * height * left * (1.0 - cosine);
                // It rings 0.5 % low at 150 Hz: 0.13 rad after a decay of 30 ms, of half of what is left then; n is
                // finite.
                assert!((push - closed).abs() < 0.03 * height, "{tick}: {push} {closed}");
                assert!((0.0..=height).contains(&push) && (push - last).abs() <= steepest, "{tick}: {push}");
                (last, sum) = (push, sum + push / RATE);
            }
            // What it can give at 1 m/s, J: below A τ, and about half of it.
            assert!(sum < height * transient.decay && sum > 0.4 * height * transient.decay, "{sum}");
            assert!(last < 1e-3 * height, "it fades: {last}");
        }
    }

    #[test]
    fn a_harder_blow_is_stronger_up_to_its_bound() {
        let most = |speed: f32| rings(speed, Transient::WOOD).take(80).fold(0.0, f32::max);
        assert!((most(0.2) / most(0.1) - 2.0).abs() < 1e-5);
        assert!(most(10.0) <= Transient::WOOD.max_force && most(f32::INFINITY) == most(10.0));
        for none in [0.0, -0.3, f32::NAN] {
            assert_eq!(most(none), 0.0, "{none}");
        }
    }

    #[test]
    fn what_makes_no_sense_or_is_too_fast_is_refused() {
        let wood = Transient::WOOD;
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            assert!(Transient { gain: bad, ..wood }.at(RATE).is_none());
            assert!(Transient { max_force: bad, ..wood }.at(RATE).is_none());
            assert!(Transient { frequency: bad, ..wood }.at(RATE).is_none());
            assert!(Transient { decay: bad, ..wood }.at(RATE).is_none());
        }
        assert!(Transient { frequency: 501.0, ..wood }.at(RATE).is_none());
        assert!(Transient { decay: 4e-4, ..wood }.at(RATE).is_none());
    }
}
