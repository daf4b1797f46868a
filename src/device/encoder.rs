//! Encoder counts to joint angles.

/// A position as an incremental encoder counts it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts(pub i32);

/// An encoder on a motor shaft, seen through the transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Joint angle per count, radians; negative where the encoder counts the other way.
    pub radians_per_count: f32,
    /// Joint angle at zero counts, radians.
    pub angle_at_zero: f32,
}

impl Encoder {
    /// An encoder of `counts_per_revolution` (after quadrature) on a motor geared down `ratio : 1` to the joint.
    /// A negative ratio turns the direction round.
    pub const fn geared(counts_per_revolution: f32, ratio: f32, angle_at_zero: f32) -> Self {
        Self { radians_per_count: core::f32::consts::TAU / (counts_per_revolution * ratio), angle_at_zero }
    }

    /// The joint angle, radians.
    #[inline]
    pub fn angle(&self, counts: Counts) -> f32 {
        counts.0 as f32 * self.radians_per_count + self.angle_at_zero
    }
}
