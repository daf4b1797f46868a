//! What commissioning found, as words to keep in the chip's flash, with a CRC-32.

use crate::patch::crc32;
use thiserror::Error;

/// First word of a record: says that there is one, and of which shape.
const MAGIC: u32 = 0x7061_6c01;

/// Where the joints are, and what the encoders are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration<const JOINTS: usize> {
    /// Joint angle per count of each encoder, radians.
    pub radians_per_count: [f32; JOINTS],
    /// Joint angle in the middle of count zero, radians: of absolute sensors, or at the reference pose.
    pub angle_at_zero: [f32; JOINTS],
    /// Torque of each motor at full duty, N·m.
    pub torque_at_full: [f32; JOINTS],
}

/// Why a record is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CalibrationError {
    /// There is none: flash that was erased, or another program's.
    #[error("no calibration is kept here")]
    Absent,
    /// It is of a device with another number of joints, or too short.
    #[error("the calibration kept here is of another device")]
    Shape,
    /// Its CRC is not that of its words.
    #[error("the calibration kept here is damaged")]
    Damaged,
    /// A number is not finite.
    #[error("the calibration kept here has a number that is not finite")]
    NotFinite,
}

impl<const JOINTS: usize> Calibration<JOINTS> {
    /// Words of a record.
    pub const WORDS: usize = 3 + 3 * JOINTS;

    /// Writes the record at the start of `words` and gives that part back; `None` if it is too short.
    pub fn write<'a>(&self, words: &'a mut [u32]) -> Option<&'a [u32]> {
        let record = words.get_mut(..Self::WORDS)?;
        let (content, crc) = record.split_at_mut_checked(Self::WORDS - 1)?;
        let numbers = self.radians_per_count.iter().chain(&self.angle_at_zero).chain(&self.torque_at_full);
        let head = [MAGIC, JOINTS as u32];
        let all = head.into_iter().chain(numbers.map(|number| number.to_bits()));
        for (word, value) in content.iter_mut().zip(all) {
            *word = value;
        }
        *crc.first_mut()? = content.iter().fold(0, |crc, word| crc32(crc, *word));
        Some(record)
    }

    /// Reads the record at the start of `words`.
    ///
    /// # Errors
    /// Why there is none that can be believed.
    pub fn read(words: &[u32]) -> Result<Self, CalibrationError> {
        if words.first() != Some(&MAGIC) {
            return Err(CalibrationError::Absent);
        }
        let record = words.get(..Self::WORDS).ok_or(CalibrationError::Shape)?;
        let Some(([_, joints, numbers @ ..], crc)) = record.split_last().map(|(crc, content)| (content, *crc)) else {
            return Err(CalibrationError::Shape);
        };
        if *joints != JOINTS as u32 {
            return Err(CalibrationError::Shape);
        }
        if record.iter().take(Self::WORDS - 1).fold(0, |crc, word| crc32(crc, *word)) != crc {
            return Err(CalibrationError::Damaged);
        }
        let mut rest = numbers.iter().map(|word| f32::from_bits(*word));
        let mut next = || [0.0; JOINTS].map(|_: f32| rest.next().unwrap_or(f32::NAN));
        let calibration = Self { radians_per_count: next(), angle_at_zero: next(), torque_at_full: next() };
        let finite = |numbers: &[f32; JOINTS]| numbers.iter().all(|number| number.is_finite());
        let all = [&calibration.radians_per_count, &calibration.angle_at_zero, &calibration.torque_at_full];
        if all.into_iter().all(finite) { Ok(calibration) } else { Err(CalibrationError::NotFinite) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEPT: Calibration<3> = Calibration {
        radians_per_count: [1e-4, -2e-4, 3e-4],
        angle_at_zero: [0.1, 0.2, -0.3],
        torque_at_full: [1.2, -0.9, 0.9],
    };

    #[test]
    fn what_was_written_is_read_and_nothing_else_is() {
        let mut words = [u32::MAX; 20];
        assert_eq!(Calibration::<3>::read(&words), Err(CalibrationError::Absent), "erased flash");
        assert_eq!(KEPT.write(&mut words).map(<[u32]>::len), Some(12));
        assert_eq!(Calibration::read(&words), Ok(KEPT));
        assert_eq!(Calibration::<2>::read(&words), Err(CalibrationError::Shape));
        assert_eq!(Calibration::<3>::read(&words[..11]), Err(CalibrationError::Shape));
        assert!(KEPT.write(&mut [0; 11]).is_none());
        // Every single bit.
        for bit in 0..12 * 32 {
            let mut spoilt = words;
            spoilt[bit / 32] ^= 1 << (bit % 32);
            assert!(Calibration::<3>::read(&spoilt).is_err(), "bit {bit}");
        }
        let mut infinite = [0; 12];
        Calibration { torque_at_full: [f32::INFINITY; 3], ..KEPT }.write(&mut infinite);
        assert_eq!(Calibration::<3>::read(&infinite), Err(CalibrationError::NotFinite));
    }
}
