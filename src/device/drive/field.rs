//! The field of a motor with three phases.

use crate::device::{Duty, ElectricalAngle};

/// The field of a motor with three phases: where the vector of its voltage points, and how much of that drives no
/// current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Field {
    /// Where it points.
    pub angle: ElectricalAngle,
    /// The part of the duty that compensates back-EMF.
    pub back_emf: Duty,
}

impl Field {
    /// A field whose whole voltage drives current, as in a motor at rest.
    pub const fn at_rest(angle: ElectricalAngle) -> Self {
        Self { angle, back_emf: Duty::ZERO }
    }
}
