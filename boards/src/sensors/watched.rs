//! Sensors that are never quite still, watched for one that has frozen.

use super::{BadFrame, Sensors};
use palpate::device::Counts;
use palpate::device::sensor::Frozen;

/// Sensors whose last bits are never quiet, magnetic ones: a reading that stays the very same for too long is a bad
/// frame.
#[derive(Debug)]
pub struct Watched<S, const JOINTS: usize> {
    sensors: S,
    frozen: [Frozen; JOINTS],
}

impl<S, const JOINTS: usize> Watched<S, JOINTS> {
    /// These sensors, watched so.
    pub const fn new(sensors: S, frozen: Frozen) -> Self {
        Self { sensors, frozen: [frozen; JOINTS] }
    }
}

impl<S: Sensors<JOINTS>, const JOINTS: usize> Sensors<JOINTS> for Watched<S, JOINTS> {
    #[inline]
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        let counts = self.sensors.read()?;
        for (frozen, Counts(count)) in self.frozen.iter_mut().zip(counts) {
            if frozen.is_frozen(count as u32) {
                return Err(BadFrame::Damaged);
            }
        }
        Ok(counts)
    }

    #[inline]
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        self.sensors.marks()
    }
}
