//! Homing: from raw counts to calibrated encoders.

mod field_search;
mod reference;
mod refusal;
mod state;
mod stop_search;
#[cfg(test)]
mod tests;
mod tick;

pub use field_search::FieldSearch;
pub use reference::{Reference, ZeroOf};
pub use refusal::Refusal;
pub use state::HomingState;
pub use stop_search::StopSearch;

use super::{Counts, Encoder};
use thiserror::Error;

/// How a device finds its joint angles. Constant, in flash.
///
/// ```
/// use palpate::device::{Homing, Reference, presets::WOODEN_HAPTICS_2016 as DEVICE};
/// use palpate::servo::Config;
///
/// /// The user holds the arm in its calibration pose: still for 1 s to within 2 counts, 60 s after the start at the
/// /// latest, at 4 kHz.
/// const HOMING: Homing<3> =
///     Homing::new(DEVICE.encoders, Reference::Pose(DEVICE.angles_at_zero()), 4_000, 2, 240_000);
/// const CONFIG: Config<3> = Config { homing: Some(HOMING), ..Config::DEFAULT };
/// assert!(!HOMING.drives(), "no motor moves");
/// # let _ = CONFIG;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homing<const JOINTS: usize> {
    encoders: [Encoder; JOINTS],
    reference: Reference<JOINTS>,
    still_ticks: u32,
    still_counts: u32,
    timeout_ticks: u32,
    when_asked: bool,
}

/// Which number of the homing is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum HomingError {
    /// A reference angle is not finite.
    #[error("a reference angle is not finite")]
    Angle,
    /// It must hold still for at least a tick.
    #[error("it must hold still for at least a tick")]
    StillTicks,
    /// A search for a stop has a number that is not finite, or not positive.
    #[error("a search for a stop needs finite numbers, a speed, and a positive torque, clearance and travel")]
    Stop,
    /// The time allowed is too short to hold still in.
    #[error("the timeout is not longer than the time to hold still")]
    TimeoutTicks,
    /// A search for a field has a number that makes no sense, or takes longer than is allowed.
    #[error("a search for a field needs a positive torque, times, and more time than it takes")]
    Field,
    /// A search for a field has a commutation that makes no sense ([`crate::device::Commutation::is_valid`]).
    #[error("a commutation needs 1 to 256 pole pairs, and at least 64 counts a turn for each of them")]
    PolePairs,
}

/// The input of a tick of homing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingInput<const JOINTS: usize> {
    /// This tick's counts; `None` if a sensor failed.
    pub counts: Option<[Counts; JOINTS]>,
    /// The counts at which a joint passed its index mark, if it did since the last tick.
    pub index: [Option<Counts>; JOINTS],
    /// Joint rates as estimated, rad/s.
    pub rates: [f32; JOINTS],
    /// The time since the last tick, s.
    pub period: f32,
}

/// How far homing has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HomingProgress<const JOINTS: usize> {
    /// Not there yet.
    Waiting,
    /// The encoders, calibrated.
    Done([Encoder; JOINTS]),
    /// It will not be done.
    Refused(Refusal),
}

impl<const JOINTS: usize> Homing<JOINTS> {
    /// Homing of a device with these encoders, whose angles at zero counts are found out. Held still is: within
    /// `still_counts` of one reading for `still_ticks` ticks; `timeout_ticks` after the start it is too late.
    ///
    /// # Errors
    /// The number that makes no sense.
    pub const fn try_new(
        encoders: [Encoder; JOINTS],
        reference: Reference<JOINTS>,
        still_ticks: u32,
        still_counts: u32,
        timeout_ticks: u32,
    ) -> Result<Self, HomingError> {
        let mut joint = 0;
        while joint < JOINTS {
            match &reference {
                Reference::Pose(angles) | Reference::KnownPose { angles, .. } | Reference::Index(angles) => {
                    if !angles[joint].is_finite() {
                        return Err(HomingError::Angle);
                    }
                }
                Reference::Stops(searches) => {
                    if !searches[joint].is_valid() {
                        return Err(HomingError::Stop);
                    }
                }
                Reference::Fields(searches) => {
                    if !searches[joint].commutation.is_valid() {
                        return Err(HomingError::PolePairs);
                    }
                    if !searches[joint].is_valid() || searches[joint].ticks() >= timeout_ticks {
                        return Err(HomingError::Field);
                    }
                }
            }
            joint += 1;
        }
        if still_ticks == 0 {
            return Err(HomingError::StillTicks);
        }
        if timeout_ticks <= still_ticks {
            return Err(HomingError::TimeoutTicks);
        }
        Ok(Self { encoders, reference, still_ticks, still_counts, timeout_ticks, when_asked: false })
    }

    /// [`Self::try_new`] for a `static`: invalid numbers are compile errors.
    ///
    /// # Panics
    /// At compile time, naming the number.
    pub const fn new(
        encoders: [Encoder; JOINTS],
        reference: Reference<JOINTS>,
        still_ticks: u32,
        still_counts: u32,
        timeout_ticks: u32,
    ) -> Self {
        match Self::try_new(encoders, reference, still_ticks, still_counts, timeout_ticks) {
            Ok(homing) => homing,
            Err(HomingError::Angle) => panic!("a reference angle"),
            Err(HomingError::StillTicks) => panic!("still_ticks"),
            Err(HomingError::Stop) => panic!("a search for a stop"),
            Err(HomingError::TimeoutTicks) => panic!("timeout_ticks"),
            Err(HomingError::Field) => panic!("a search for a field: torque, ticks, turns, or the timeout"),
            Err(HomingError::PolePairs) => panic!("pole_pairs: 1 to 256, each of at least 64 of counts_per_turn"),
        }
    }

    /// The same, but it runs only while force is requested, as a search for stops or fields always does: the user
    /// confirms the reference pose with the enable button.
    pub const fn when_asked(self) -> Self {
        Self { when_asked: true, ..self }
    }

    /// The same with encoders that were measured. Of a pose or a mark that the counters know nothing of, their
    /// [`Encoder::angle_at_zero_rad`] is the joint's angle there; of a known pose, whose counts are known, it is that
    /// at count zero, and the pose's angles follow from it. Stops stay where they are.
    pub(crate) fn of_encoders(self, encoders: [Encoder; JOINTS]) -> Self {
        let mut homing = Self { encoders, ..self };
        match &mut homing.reference {
            Reference::Pose(angles) | Reference::Index(angles) => {
                *angles = encoders.map(|encoder| encoder.angle_at_zero_rad);
            }
            Reference::KnownPose { angles, counts, .. } => {
                for ((angle, encoder), counts) in angles.iter_mut().zip(&encoders).zip(counts) {
                    *angle = encoder.angle(*counts);
                }
            }
            Reference::Stops(_) | Reference::Fields(_) => {}
        }
        homing
    }

    /// The place whose angle is the encoders' [`Encoder::angle_at_zero_rad`]; `None` if homing finds it each time.
    pub const fn zero_of(&self) -> Option<ZeroOf> {
        match &self.reference {
            Reference::Pose(_) => Some(ZeroOf::Pose),
            Reference::Index(_) => Some(ZeroOf::Mark),
            Reference::KnownPose { .. } | Reference::Fields(_) => Some(ZeroOf::Count),
            Reference::Stops(_) => None,
        }
    }

    /// Whether it runs only while force is requested.
    pub const fn waits_for_enable(&self) -> bool {
        self.when_asked || self.drives()
    }

    /// Whether the motors move the joints.
    pub const fn drives(&self) -> bool {
        matches!(self.reference, Reference::Stops(_) | Reference::Fields(_))
    }

    /// Whether it leads fields round ([`Reference::Fields`]).
    #[inline]
    pub(crate) const fn leads_fields(&self) -> bool {
        matches!(self.reference, Reference::Fields(_))
    }
}
