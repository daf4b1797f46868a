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

/// When a joint sensor counts as stuck: the force that the hand feels loads its joint beyond dry friction, and its count stays
/// the same, while another joint moves far.
///
/// That a joint rests under load says nothing: the hand may hold it. But a hand that moves another joint by `travel` meanwhile
/// would have to balance the load on this one to within its dry friction all the way, on the one curve on which it does not
/// turn. Below friction no hand is needed for that, so what is below counts as no load. A device with one joint has no others:
/// there this finds nothing. One joint is looked at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StuckLimits {
    /// The least load, as a multiple of the joint's [`crate::device::Device::dry_friction`]; at least 1.
    pub load: f32,
    /// How far another joint moves meanwhile, radians.
    pub travel: f32,
}

impl StuckLimits {
    /// Five times dry friction, so that a hand would have to balance the load to a fifth of it, while another joint comes 0.6 rad,
    /// some 60 mm at the probe. Where simulated hands slide about under load, a Falcon's joint stays where it is over 0.5 rad
    /// under its own friction and over 0.28 rad under three times that, but never over 0.01 rad under five times; a joint of a
    /// device with little friction turns back while another goes on for 0.27 rad at most, of Polhem's short crank.
    pub const DEFAULT: Self = Self { load: 5.0, travel: 0.6 };
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
    /// When a sensor counts as stuck; `None` does not watch.
    pub stuck: Option<StuckLimits>,
    /// CRC-32 of the tables, that their source has as `TABLE_CRC`: checked whole before the first tick, and again and again after, a word a
    /// tick. `None` checks nothing.
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
    /// The load is below dry friction, or the travel is not above zero.
    #[error("the load of a stuck sensor must be dry friction at least, and the travel positive")]
    Stuck,
}

impl Safety {
    /// Zero output, no overrun allowed, no host, stuck sensors watched for, no table check.
    pub const DEFAULT: Self = Self {
        output: SafeOutput::Zero,
        overruns_allowed: 0,
        link_timeout: f32::INFINITY,
        settle_ticks: 1,
        wait_for_homing: false,
        stuck: Some(StuckLimits::DEFAULT),
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
            let sensible = load >= 1.0 && travel > 0.0;
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
