//! Velocity from encoder positions, by one of two estimators.
//!
//! Measured on a simulated hand's motion at 4 kHz and 57.6 µm a count, slow (20 mm/s at most); the stiffest wall is
//! that of the WoodenHaptics arm along one direction at 8 N·s/m (the servo test `velocity` of `host-tests` prints it):
//!
//! | method | delay | noise | stiffest wall | instructions a joint, about |
//! |---|---|---|---|---|
//! | [`VelocityFilter`], 200 Hz: difference and low-pass | 0.75 ms | 11 mm/s | 15.1 kN/m | 5 |
//! | [`BetweenCounts`], 80 Hz: observer with play, for position and velocity | 2.1 ms | 5.0 mm/s | 4.1 kN/m | 20 |
//!
//! The default is the low-pass: delay limits the stiffness of a wall, and the low-pass has the smaller delay.
//! [`BetweenCounts`] is for a wall that feels smooth: the loop also takes the observer's position in place of the
//! counts, so that a spring on it does not buzz. That costs the wall the observer's delay: see
//! [`crate::render::bounds`].

/// Which estimator a loop uses.
///
/// ```
/// use palpate::device::VelocityMethod;
/// use palpate::servo::Rendering;
///
/// // Less noise, and a delay that costs stiffness.
/// const QUIET: Rendering = Rendering { velocity: VelocityMethod::BetweenCounts, ..Rendering::PLAIN };
/// assert_eq!(VelocityMethod::default(), VelocityMethod::LowPass);
/// # let _ = QUIET;
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum VelocityMethod {
    /// Difference and low-pass.
    #[default]
    LowPass,
    /// Tracking observer with half a count of play, whose position the loop takes, too.
    BetweenCounts,
}

/// One joint's velocity estimator, ready to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityEstimator {
    /// Difference and low-pass.
    LowPass(VelocityFilter),
    /// Tracking observer with half a count of play.
    BetweenCounts(BetweenCounts),
}

/// The state of one joint's estimator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityState {
    /// The middle of the last count less the observer's position; 0 for the low-pass.
    pub lag: f32,
    /// The last velocity.
    pub velocity: f32,
}

impl VelocityEstimator {
    /// An estimator for positions sampled at `rate` (Hz). `corner` (Hz) sets the delay of either method to the same
    /// `1/(2π corner)`; `count` is one encoder count in the unit of position, the observer's play.
    pub const fn new(method: VelocityMethod, corner: f32, rate: f32, count: f32) -> Self {
        match method {
            VelocityMethod::LowPass => Self::LowPass(VelocityFilter::new(corner, rate)),
            VelocityMethod::BetweenCounts => Self::BetweenCounts(BetweenCounts::new(2.0 * corner, rate, count)),
        }
    }

    /// The state at rest.
    pub const fn start(&self) -> VelocityState {
        VelocityState { lag: 0.0, velocity: 0.0 }
    }

    /// The velocity, after a period in which the position moved by `moved`.
    #[inline]
    pub fn next(&self, state: &mut VelocityState, moved: f32) -> f32 {
        match self {
            Self::LowPass(filter) => state.velocity = filter.next(state.velocity, moved),
            Self::BetweenCounts(observer) => {
                (state.lag, state.velocity) = observer.next(state.lag, state.velocity, moved);
            }
        }
        state.velocity
    }
}

/// `y += α (Δx / h − y)` with `α = 2π f h / (1 + 2π f h)`, the backward-Euler low-pass of corner frequency `f`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityFilter {
    rate: f32,
    alpha: f32,
}

impl VelocityFilter {
    /// A filter of corner frequency `corner` for positions sampled at `rate`, both Hz.
    pub const fn new(corner: f32, rate: f32) -> Self {
        let omega = core::f32::consts::TAU * corner / rate;
        Self { rate, alpha: omega / (1.0 + omega) }
    }

    /// The next velocity, from the last one and how far the position moved in this period.
    #[inline]
    pub fn next(&self, last: f32, moved: f32) -> f32 {
        last + self.alpha * (moved * self.rate - last)
    }
}

/// The tracking observer with play: `x̂' = v̂ + 2ω e`, `v̂' = ω² e`, where `e` is how far the estimate lies outside of
/// the count that was read, and 0 within it.
///
/// A count says between which two lines the joint is, nothing more. So nothing is corrected while the estimate is
/// there: a joint that rests does not flicker, and one that moves steadily is followed along the edge of its count
/// without a ripple. The play costs trust: the estimate and the joint may lie at opposite edges of a count, so that the
/// position may be wrong by a whole one, where a count's middle is wrong by half. Both that and the delay count in the
/// bounds of a wall ([`crate::render::bounds::DeviceFriction::between_counts`],
/// [`crate::render::bounds::between_counts_delay`]). At a steady speed the position has no delay; the velocity lags by
/// `2/ω`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetweenCounts {
    period: f32,
    /// `2 ω h`.
    position_gain: f32,
    /// `ω² h`.
    velocity_gain: f32,
    /// Half a count.
    play: f32,
}

impl BetweenCounts {
    /// An observer of corner frequency `corner` for positions of `count` a step, in the unit of position, sampled at
    /// `rate`; both Hz. `ω h` is held to 0.5, where the discrete loop is
    /// still well damped: `z² − (2 − 2ωh − ω²h²) z + 1 − 2ωh` is stable for `ωh < 0.83`.
    pub const fn new(corner: f32, rate: f32, count: f32) -> Self {
        let omega_period = core::f32::consts::TAU * corner / rate;
        let omega_period = if omega_period < 0.5 { omega_period } else { 0.5 };
        Self {
            period: 1.0 / rate,
            position_gain: 2.0 * omega_period,
            velocity_gain: omega_period * omega_period * rate,
            play: 0.5 * count.abs(),
        }
    }

    /// The next lag (of the estimate behind the middle of the count that was read) and velocity, from the last ones and
    /// how far that middle moved in this period: finite, as the difference of two readings is.
    #[inline]
    pub fn next(&self, lag: f32, velocity: f32, moved: f32) -> (f32, f32) {
        let away = lag + moved - velocity * self.period;
        let error = if away > self.play {
            away - self.play
        } else if away < -self.play {
            away + self.play
        } else {
            return (away, velocity);
        };
        (away - self.position_gain * error, velocity + self.velocity_gain * error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_velocity_is_followed_as_the_closed_form() {
        let (corner, rate, speed) = (100.0_f64, 4_000.0_f64, 0.2_f64);
        let filter = VelocityFilter::new(corner as f32, rate as f32);
        // 1 − (1 − α)ⁿ with 1 − α = 1/(1 + 2π f h).
        let left = 1.0 / (1.0 + core::f64::consts::TAU * corner / rate);
        let (mut velocity, mut remaining) = (0.0, 1.0);
        for step in 0..400 {
            velocity = filter.next(velocity, (speed / rate) as f32);
            remaining *= left;
            let error = (f64::from(velocity) - speed * (1.0 - remaining)).abs();
            // Each step rounds a few times, 6e-8 of 0.2 m/s, and the filter forgets in 1/α = 7 steps.
            assert!(error < 7.0 * 4.0 * 6e-8 * speed, "step {step}: {error:e}");
        }
    }

    #[test]
    fn standing_still_it_falls_to_zero() {
        let filter = VelocityFilter::new(100.0, 4_000.0);
        let velocity = (0..1_000).fold(1.0, |velocity, _| filter.next(velocity, 0.0));
        // 0.864 to the power of 1,000 is below the least f32.
        assert!(velocity.abs() < 1e-37, "{velocity:e}");
    }

    const RATE: f32 = 4_000.0;
    const COUNT: f32 = 57.6e-6;

    /// Follows a position, m by tick, through counts: the position believed, and the velocity.
    fn follow(corner: f32, position: impl Fn(u32) -> f32, mut look: impl FnMut(u32, f32, f32)) {
        let observer = BetweenCounts::new(corner, RATE, COUNT);
        // The middle of the count that is read; no position here is negative, so that a cast rounds down.
        let read = |tick: u32| ((position(tick) / COUNT) as i32 as f32 + 0.5) * COUNT;
        let (mut lag, mut velocity, mut last) = (0.0, 0.0, read(0));
        for tick in 1..8_000 {
            let now = read(tick);
            (lag, velocity) = observer.next(lag, velocity, now - last);
            last = now;
            look(tick, now - lag, velocity);
        }
    }

    #[test]
    fn a_steady_motion_is_followed_without_a_ripple() {
        for speed in [0.01_f32, 0.03, 0.1, 0.3] {
            let (mut least, mut most) = (f32::MAX, f32::MIN);
            follow(
                200.0,
                |tick| tick as f32 * speed / RATE,
                |tick, _, velocity| {
                    if tick >= 6_000 {
                        least = if velocity < least { velocity } else { least };
                        most = if velocity > most { velocity } else { most };
                    }
                },
            );
            // A count in a period is 230 mm/s to a difference. Here what is left is a twentieth of the speed.
            assert!(least > 0.95 * speed && most < 1.05 * speed, "{speed}: {least} to {most}");
        }
    }

    #[test]
    fn at_rest_nothing_flickers_on_the_line_between_two_counts() {
        // A motion of a tenth of a count over a line: every other tick another count.
        let line = 100.0 * COUNT;
        let place = |tick: u32| line + if tick.is_multiple_of(2) { 0.05 * COUNT } else { -0.05 * COUNT };
        let (mut least, mut most) = (f32::MAX, f32::MIN);
        follow(200.0, place, |tick, believed, velocity| {
            if tick > 2_000 {
                least = if believed < least { believed } else { least };
                most = if believed > most { believed } else { most };
                // Rounding of 6 mm.
                assert!(velocity.abs() < 1e-5, "{tick}: {velocity}");
            }
        });
        assert!(most - least < 2e-9, "{}", most - least);
    }

    #[test]
    fn it_is_never_off_by_more_than_a_count_in_a_hand_s_motion() {
        // 20 mm at 1.6 Hz: 0.2 m/s and 2 m/s².
        let place = |tick: u32| 0.03 + 0.02 * crate::math::sin_cos(tick as f32 * 10.0 / RATE).0;
        follow(200.0, place, |tick, believed, _| {
            // Beside the count, what an acceleration of 2 m/s² leaves behind: a/ω², 1.3 µm; rounding of 30 mm.
            let off = (believed - place(tick)).abs();
            assert!(tick < 200 || off < COUNT + 2.0e-6, "{tick}: {off:e}");
        });
    }
}
