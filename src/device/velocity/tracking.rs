//! Tracking observer: a phase-locked loop on the position.

use crate::math::saturate;

/// `x̂' = v̂ + 2ω e`, `v̂' = ω² e` with `e = x − x̂`: critically damped, integrated a period at a time.
///
/// From position to velocity it is a differentiator and a low-pass of second order with corner `ω`; its delay is `2/ω`.
/// Against noise it equals the low-pass of the same delay, but a count makes it swell and fade instead of jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingObserver {
    period: f32,
    /// `2 ω h`.
    position_gain: f32,
    /// `ω² h`.
    velocity_gain: f32,
}

impl TrackingObserver {
    /// An observer of corner frequency `corner` for positions sampled at `rate`, both Hz.
    ///
    /// `ω h` is held to 0.5, where the discrete loop is still well damped: `z² − (2 − 2ωh − ω²h²) z + 1 − 2ωh` is
    /// stable for `ωh < 0.83`.
    pub const fn new(corner: f32, rate: f32) -> Self {
        let omega_period = core::f32::consts::TAU * corner / rate;
        let omega_period = if omega_period < 0.5 { omega_period } else { 0.5 };
        Self {
            period: 1.0 / rate,
            position_gain: 2.0 * omega_period,
            velocity_gain: omega_period * omega_period * rate,
        }
    }

    /// The next lag and velocity, from the last ones and how far the position moved in this period.
    #[inline]
    pub fn next(&self, lag: f32, velocity: f32, moved: f32) -> (f32, f32) {
        // A lag that is not finite would stay so for ever.
        let error = saturate(lag + moved - velocity * self.period, -f32::MAX, f32::MAX);
        (error - self.position_gain * error, velocity + self.velocity_gain * error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_velocity_is_met_without_error() {
        for (corner, rate) in [(50.0, 1_000.0), (100.0, 4_000.0), (400.0, 8_000.0), (5_000.0, 1_000.0)] {
            let observer = TrackingObserver::new(corner, rate);
            let (mut lag, mut velocity) = (0.0, 0.0);
            for _ in 0..2_000 {
                (lag, velocity) = observer.next(lag, velocity, 0.2 / rate);
            }
            // The loop ends where its correction falls below the rounding of 0.2.
            assert!((velocity - 0.2).abs() < 1e-6, "{corner} {rate}: {velocity}");
        }
    }

    #[test]
    fn it_lags_a_steady_acceleration_by_two_over_omega() {
        let (corner, rate, acceleration) = (100.0_f32, 4_000.0_f32, 3.0_f32);
        let observer = TrackingObserver::new(corner, rate);
        let (mut lag, mut velocity, mut true_velocity) = (0.0, 0.0, 0.0);
        for _ in 0..4_000 {
            let moved = (true_velocity + 0.5 * acceleration / rate) / rate;
            true_velocity += acceleration / rate;
            (lag, velocity) = observer.next(lag, velocity, moved);
        }
        let delay = (true_velocity - velocity) / acceleration;
        let expected = 2.0 / (core::f32::consts::TAU * corner);
        // A velocity is the mean over a period, so a period more or less.
        assert!((delay - expected).abs() < 1.0 / rate, "{delay} s, expected {expected} s");
    }
}
