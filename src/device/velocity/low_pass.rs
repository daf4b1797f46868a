//! First difference and a one-pole low-pass.

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
}
