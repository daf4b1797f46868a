//! What the loop is doing.

/// The phase of the loop, in the order in which it goes through them; at most one step a tick.
///
/// Force comes from [`Phase::Running`] alone. A fault leads from any phase to [`Phase::Fault`], where the motors are at
/// zero or, if [`super::SafeOutput`] says so and the sensors can be believed, damp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Phase {
    /// Nothing has been sensed yet.
    #[default]
    Reset = 0,
    /// The sensors settle, the device is homed and the tables are checked, as far as [`super::Safety`] asks for it.
    Calibrate = 1,
    /// Tracking, with the motors at zero, until force is asked for.
    Armed = 2,
    /// Rendering force.
    Running = 3,
    /// Stopped by a fault, which is latched: only a reset leaves this phase.
    Fault = 4,
}

impl Phase {
    /// Every phase, in the order of its number.
    pub const ALL: [Self; 5] = [Self::Reset, Self::Calibrate, Self::Armed, Self::Running, Self::Fault];
}
