//! Velocity from position: first difference and a one-pole low-pass.

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
