//! What a user chooses about safety.

use thiserror::Error;

/// What the motors do once a fault has been seen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SafeOutput {
    /// Nothing.
    Zero,
    /// They brake the probe with this damping, N·s/m, in every tick whose sensors can be believed; nothing in the
    /// others. It helps where the device would fall.
    Damping(f32),
}

/// When a joint sensor counts as stuck: its joint carries a load and its count stays the same, while another joint
/// moves.
///
/// A hand cannot hold a joint to a single count against a force while it moves the others, but the joint's own dry friction
/// can, and a parallel mechanism has motions that leave a joint where it is. So it is off unless chosen, for a device on which
/// it has been tried. A device with one joint has no others: there this finds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StuckLimits {
    /// The least share of full duty that is a load, 0 to 1.
    pub load: f32,
    /// How far another joint moves meanwhile, radians.
    pub travel: f32,
}

/// Limits and reactions of the loop. Begin with [`Safety::DEFAULT`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Safety {
    /// What the motors do after a fault.
    pub output: SafeOutput,
    /// How many ticks in a row may overrun before it is a fault.
    pub overruns_allowed: u32,
    /// Seconds of silence after which the host's link is lost; infinite where no host watches.
    pub link_timeout: f32,
    /// Ticks of believable sensors before the loop is armed.
    pub settle_ticks: u32,
    /// Whether the loop waits for [`super::Event::Homed`] before it is armed.
    pub wait_for_homing: bool,
    /// When a sensor is stuck.
    pub stuck: Option<StuckLimits>,
    /// CRC-32 of the patch's table ([`crate::patch::SplinePatch::table_crc`]): checked whole before the loop is armed,
    /// and again and again after, a few words a tick. `None` checks nothing.
    pub table_crc: Option<u32>,
}

/// Which limit is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SafetyError {
    /// The damping is negative, not finite or above the device's.
    #[error("the safe damping must be between 0 and the device's greatest")]
    Damping,
    /// The link's timeout is not above zero.
    #[error("the link's timeout must be positive")]
    LinkTimeout,
    /// The load or the travel is not above zero.
    #[error("the load and travel of a stuck sensor must be positive")]
    Stuck,
}

impl Safety {
    /// Zero output, no overrun allowed, no host, no watch for stuck sensors, no table check.
    pub const DEFAULT: Self = Self {
        output: SafeOutput::Zero,
        overruns_allowed: 0,
        link_timeout: f32::INFINITY,
        settle_ticks: 1,
        wait_for_homing: false,
        stuck: None,
        table_crc: None,
    };

    /// Checks the limits against a device's greatest damping (N·s/m).
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self, greatest_damping: f32) -> Result<(), SafetyError> {
        if let SafeOutput::Damping(damping) = self.output {
            let sensible = damping >= 0.0 && damping <= greatest_damping;
            if !sensible {
                return Err(SafetyError::Damping);
            }
        }
        let lasts = self.link_timeout > 0.0;
        if !lasts {
            return Err(SafetyError::LinkTimeout);
        }
        if let Some(StuckLimits { load, travel }) = self.stuck {
            let sensible = load > 0.0 && travel > 0.0;
            if !sensible {
                return Err(SafetyError::Stuck);
            }
        }
        Ok(())
    }
}

impl Default for Safety {
    fn default() -> Self {
        Self::DEFAULT
    }
}
