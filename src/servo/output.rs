//! What the motors get: the one thing that a board looks at.

use super::{Phase, ServoState};
use crate::device::Duty;

/// What the motors get after a tick. A board does as it says, whatever the phase: while homing looks for stops, in
/// [`Phase::Running`], and while damping after a fault the motors are driven; otherwise they are off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Output<const JOINTS: usize> {
    /// Nothing: every stage disabled.
    Off,
    /// These duties.
    Drive([Duty; JOINTS]),
}

impl<const JOINTS: usize, W, G> ServoState<JOINTS, W, G> {
    /// What the motors now get.
    #[inline]
    pub const fn output(&self) -> Output<JOINTS> {
        let drives = match self.phase {
            Phase::Running => true,
            Phase::Calibrate | Phase::Fault => self.drives,
            Phase::Reset | Phase::Armed => false,
        };
        if drives { Output::Drive(self.duties) } else { Output::Off }
    }
}
