//! What a user chooses about safety.

use super::ContactLimits;
use thiserror::Error;

/// What the motors do from the tick in which a fault is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SafeOutput {
    /// Nothing.
    Zero,
    /// They brake the probe with this damping, N·s/m, in every tick whose sensors can be believed; nothing in the
    /// others, nor after a fault of a drive, of the supply or of a sign ([`super::Fault::leaves_damping`]), nor where
    /// signs are watched and not all joints have been seen to follow their motors. It helps where the device would
    /// fall.
    Damping(f32),
}

/// When a joint sensor counts as stuck: the force that the hand feels loads its joint beyond dry friction, and its
/// count stays the same, while another joint moves far.
///
/// A joint at rest under load proves nothing: the hand may hold it. But a hand that moves another joint by `travel`
/// meanwhile would have to balance the load on this one to within its dry friction all the way, on the one curve on
/// which it does not turn. Below friction no hand is needed for that, so what is below counts as no load. A device with
/// one joint has no others: there this finds nothing. One joint is looked at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StuckLimits {
    /// The least load, as a multiple of the joint's [`crate::device::Device::dry_friction`]; at least 1.
    pub load: f32,
    /// How far another joint moves meanwhile, radians.
    pub travel_rad: f32,
}

impl StuckLimits {
    /// Five times dry friction, so that a hand would have to balance the load to a fifth of it, while another joint
    /// comes 0.6 rad, some 60 mm at the probe. Where simulated hands slide about under load, a Falcon's joint stays
    /// where it is over 0.5 rad under its own friction and over 0.28 rad under three times that, but never over 0.01
    /// rad under five times; a joint of a device with little friction turns back while another goes on for 0.27 rad at
    /// most, of Polhem's short crank.
    pub const DEFAULT: Self = Self { load: 5.0, travel_rad: 0.6 };
}

/// Limits and reactions of the loop. Begin with [`Safety::DEFAULT`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Safety {
    /// What the motors do after a fault.
    pub output: SafeOutput,
    /// How many ticks in a row may overrun before it is a fault.
    pub max_overruns: u32,
    /// Seconds of silence after which the host's link is lost; infinite where no host watches.
    pub link_timeout_s: f32,
    /// Ticks of believable sensors before the loop is armed.
    pub settle_ticks: u32,
    /// Whether the loop waits for [`super::Event::Homed`] before it is armed.
    pub wait_for_homing: bool,
    /// When a sensor counts as stuck; `None` does not watch.
    pub stuck: Option<StuckLimits>,
    /// When contact counts as lost; `None` does not watch.
    pub contact: Option<ContactLimits>,
    /// Whether tables that carry the CRC they were baked with are checked: whole before the first tick, and again and
    /// again after, a word every second tick; not while a guard withholds the force of a contact.
    pub checks_tables: bool,
}

/// Which limit is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SafetyError {
    /// The damping is negative, not finite or above the device's.
    #[error("the safe damping must be between 0 and the device's maximum")]
    Damping,
    /// The link's timeout is not above zero.
    #[error("the link's timeout must be positive")]
    LinkTimeout,
    /// The load is below dry friction, or the travel is not above zero.
    #[error("the load of a stuck sensor must be dry friction at least, and the travel positive")]
    Stuck,
    /// The depth is not above that of the greatest force, or a time is negative or not finite.
    #[error("contact limits must be deeper than the maximum force reaches, and their times not negative")]
    Contact,
}

impl Safety {
    /// Zero output, no overrun allowed, no host, stuck sensors and lost contact watched for, tables checked.
    pub const DEFAULT: Self = Self {
        output: SafeOutput::Zero,
        max_overruns: 0,
        link_timeout_s: f32::INFINITY,
        settle_ticks: 1,
        wait_for_homing: false,
        stuck: Some(StuckLimits::DEFAULT),
        contact: Some(ContactLimits::DEFAULT),
        checks_tables: true,
    };

    /// Checks the limits against a device's greatest damping (N·s/m).
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self, max_damping: f32) -> Result<(), SafetyError> {
        if let SafeOutput::Damping(damping) = self.output {
            let sensible = damping >= 0.0 && damping <= max_damping;
            if !sensible {
                return Err(SafetyError::Damping);
            }
        }
        let lasts = self.link_timeout_s > 0.0;
        if !lasts {
            return Err(SafetyError::LinkTimeout);
        }
        if let Some(StuckLimits { load, travel_rad: travel }) = self.stuck {
            let sensible = load >= 1.0 && travel > 0.0;
            if !sensible {
                return Err(SafetyError::Stuck);
            }
        }
        if let Some(contact) = &self.contact
            && !contact.is_valid()
        {
            return Err(SafetyError::Contact);
        }
        Ok(())
    }
}

impl Default for Safety {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_that_protect_nobody_are_refused() {
        const MAX_DAMPING: f32 = 5.0;
        assert_eq!(Safety::DEFAULT.check(MAX_DAMPING), Ok(()));
        for (damping, good) in [(0.0, true), (5.0, true), (5.001, false), (-0.001, false), (f32::NAN, false)] {
            let safety = Safety { output: SafeOutput::Damping(damping), ..Safety::DEFAULT };
            assert_eq!(safety.check(MAX_DAMPING), if good { Ok(()) } else { Err(SafetyError::Damping) }, "{damping}");
        }
        for (link_timeout, good) in
            [(1e-3, true), (f32::INFINITY, true), (0.0, false), (-1.0, false), (f32::NAN, false)]
        {
            let safety = Safety { link_timeout_s: link_timeout, ..Safety::DEFAULT };
            assert_eq!(safety.check(MAX_DAMPING), if good { Ok(()) } else { Err(SafetyError::LinkTimeout) });
        }
        for (load, travel, good) in
            [(1.0, 0.1, true), (0.99, 0.1, false), (5.0, 0.0, false), (f32::NAN, 0.1, false), (5.0, f32::NAN, false)]
        {
            let safety = Safety { stuck: Some(StuckLimits { load, travel_rad: travel }), ..Safety::DEFAULT };
            assert_eq!(
                safety.check(MAX_DAMPING),
                if good { Ok(()) } else { Err(SafetyError::Stuck) },
                "{load} {travel}"
            );
        }
        assert_eq!(Safety { stuck: None, ..Safety::DEFAULT }.check(MAX_DAMPING), Ok(()));
    }
}
