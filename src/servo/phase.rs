//! What the loop is doing, and why it stopped.

/// The phase of the loop. Only [`Phase::Running`] lets a duty through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Phase {
    /// Tracking, with the motors at zero, until force is asked for.
    #[default]
    Standby = 0,
    /// Rendering force.
    Running = 1,
    /// Stopped by a fault, which is latched: only a reset leaves this phase.
    Fault = 2,
}

/// What stopped the loop. The number is the code in a report; 0 there means none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[repr(u8)]
pub enum Fault {
    /// No sensor frame came for a tick, or one for another tick.
    #[error("sensor frame lost or late")]
    FrameLost = 1,
    /// A sensor frame came damaged.
    #[error("sensor frame damaged")]
    FrameDamaged = 2,
    /// A joint angle is outside the device's range.
    #[error("joint angle out of range")]
    JointOutOfRange = 3,
    /// A joint angle jumped faster than any hand moves.
    #[error("joint angle jumped")]
    JointJumped = 4,
    /// A force or torque came out that is not a finite number.
    #[error("force not finite")]
    NotFinite = 5,
}

impl Fault {
    /// Every fault, in the order of its code.
    pub const ALL: [Self; 5] =
        [Self::FrameLost, Self::FrameDamaged, Self::JointOutOfRange, Self::JointJumped, Self::NotFinite];

    /// The code in a report, from 1.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The fault of a code; `None` for 0 and for codes that are not ours.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| fault.code() == code)
    }
}
