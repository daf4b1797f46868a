//! The field of a motor with three phases.

use crate::device::{Duty, ElectricalAngle};

/// The voltage on a motor with three phases: where its vector points, and how long it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Field {
    /// Where it points.
    pub angle: ElectricalAngle,
    /// How long it is; negative points the other way.
    pub duty: Duty,
}
