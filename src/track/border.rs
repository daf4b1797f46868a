//! The borders of `[0, 1]²`, and which of them hold a witness point.

/// The active constraints. Numbers 1 to 5 are those of Eq. (1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BoundaryMode {
    /// Held at `u = 0`, moving along the edge.
    LowerU = 1,
    /// Held at `u = 1`, moving along the edge.
    UpperU = 2,
    /// Held at `v = 0`, moving along the edge.
    LowerV = 3,
    /// Held at `v = 1`, moving along the edge.
    UpperV = 4,
    /// Free in both parameters.
    #[default]
    Interior = 5,
    /// Held at a vertex: both errors point outward. The paper does not list it.
    Corner = 6,
}

impl BoundaryMode {
    /// Every mode, in the order of its number, from 1.
    pub const ALL: [Self; 6] = [Self::LowerU, Self::UpperU, Self::LowerV, Self::UpperV, Self::Interior, Self::Corner];
}

/// Which border a parameter is at: −1 the lower, 1 the upper, 0 none. The sign of the changes it blocks.
#[derive(Clone, Copy)]
pub(super) struct Border(f32);

impl Border {
    #[inline]
    pub fn of(parameter: f32) -> Self {
        Self(if parameter <= 0.0 {
            -1.0
        } else if parameter >= 1.0 {
            1.0
        } else {
            0.0
        })
    }

    /// Whether a change of the parameter would leave `[0, 1]`.
    #[inline]
    pub fn blocks(self, change: f32) -> bool {
        self.0 * change > 0.0
    }

    #[inline]
    pub fn is_met(self) -> bool {
        self.0 != 0.0
    }

    #[inline]
    pub fn mode_along_u(self) -> BoundaryMode {
        if self.0 < 0.0 { BoundaryMode::LowerU } else { BoundaryMode::UpperU }
    }

    #[inline]
    pub fn mode_along_v(self) -> BoundaryMode {
        if self.0 < 0.0 { BoundaryMode::LowerV } else { BoundaryMode::UpperV }
    }
}

/// The mode at `(u, v)` with these parameters held.
#[inline]
pub(crate) fn mode_at([u, v]: [f32; 2], [is_u, is_v]: [bool; 2]) -> BoundaryMode {
    match (is_u, is_v) {
        (false, false) => BoundaryMode::Interior,
        (true, true) => BoundaryMode::Corner,
        (true, false) => Border::of(u).mode_along_u(),
        (false, true) => Border::of(v).mode_along_v(),
    }
}

/// Whether both parameters are farther from every border than the smallest normal number, so that no direction is
/// blocked. One comparison of bits each: the bits of a positive number rise with it, and a sign bit is larger than
/// all.
#[inline(always)]
pub fn is_inside([u, v]: [f32; 2]) -> bool {
    let is_free = |x: f32| x.to_bits().wrapping_sub(LEAST.to_bits()) < 1.0_f32.to_bits() - LEAST.to_bits();
    is_free(u) && is_free(v)
}

/// Whether `0 ≤ x ≤ 1`; false for −0. In the same way.
#[inline]
pub(super) fn is_within(x: f32) -> bool {
    x.to_bits() <= 1.0_f32.to_bits()
}

/// Not 0: both constants of the comparison then fit into an instruction.
const LEAST: f32 = f32::MIN_POSITIVE;
