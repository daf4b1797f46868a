//! The result of commissioning, as a record for the chip's flash.

use super::{CalibrationError, Wiring};
use crate::device::drive::{Feed, VoltageFeed};
use crate::device::{Device, Encoder, Kinematics, Motor, ZeroOf};
use crate::patch::crc32;
use core::f32::consts::TAU;

/// First word of a record: `palc`.
const MAGIC: u32 = u32::from_le_bytes(*b"palc");
/// Which record this is: another version may mean something else by its words.
const VERSION: u32 = 2;
/// A word of flash that was erased.
const BLANK: u32 = u32::MAX;
/// Words before the joints: magic, version and number of joints, inputs and outputs.
const HEAD: usize = 3;
/// Words of a joint.
const OF_JOINT: usize = 4;
/// Encoders may be finer or coarser than the device was built with by this factor: lines that were taken for counts
/// are a factor of four.
const ENCODER_WITHIN: f32 = 5.0;
/// Motors may be stronger or weaker by this factor. More is another motor: a force would be as much too great.
const TORQUE_WITHIN: f32 = 2.0;
/// Maximum dry friction of a joint, as a fraction of the torque with which the device's maximum force loads the joint
/// in the middle of the joints' ranges. The polarity check ([`crate::device::PolarityCheck`]) pulses with at most a
/// quarter of that force, and half of a pulse must remain to move the joint. A joint with more friction would never
/// follow its motor visibly: the loop would give neither force nor a fault.
pub(crate) const FRICTION_WITHIN: f32 = 0.125;

/// A resulting force, stiffness or damping may exceed the device's limit by this factor: torque constants of motors of one
/// type differ by a tenth (data sheets give ±10 %).
const SCALE_WITHIN: f32 = 1.1;

/// The maximum gains of a loop. A wrong calibration scales them: an encoder that is taken for coarser than it is makes
/// every wall as much stiffer, a motor that is taken for weaker makes every force as much stronger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Maximum stiffness of any surface, N/m.
    pub stiffness_n_per_m: f32,
    /// Maximum damping, N·s/m.
    pub damping_n_s_per_m: f32,
    /// Maximum force, N.
    pub force_n: f32,
}

impl Gains {
    /// The device's own limits: of a loop whose host may ask for them.
    pub const fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>) -> Self {
        Self {
            stiffness_n_per_m: device.max_stiffness_n_per_m,
            damping_n_s_per_m: device.max_damping_n_s_per_m,
            force_n: device.max_force_n,
        }
    }
}

/// The measured values of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct JointCalibration {
    /// Which of the board's encoder inputs it is on, from 0.
    pub input: u8,
    /// Which of the board's motor outputs it is on, from 0.
    pub output: u8,
    /// Joint angle a count, radians; negative where the encoder counts the other way.
    pub radians_per_count: f32,
    /// The reference of `angle_at_zero_rad`.
    pub zero_of: ZeroOf,
    /// Joint angle there, radians: in the middle of count zero, in the pose, or at the mark.
    pub angle_at_zero_rad: f32,
    /// Joint torque at full duty, N·m; negative where the motor turns the joint the other way.
    pub torque_at_full_n_m: f32,
    /// Dry friction, N·m.
    pub dry_friction_n_m: f32,
}

/// The measured values of a device: those that differ from unit to unit. The mechanism is not among them.
///
/// ```
/// use palpate::commission::{Calibration, CalibrationError, JointCalibration};
///
/// let joint = JointCalibration { radians_per_count: 2.4e-4, torque_at_full_n_m: 0.52, ..JointCalibration::default() };
/// let words = Calibration([joint]).to_words();
/// assert_eq!(Calibration::from_words(&words), Ok(Calibration([joint])));
///
/// let erased_flash = [u32::MAX; Calibration::<1>::WORDS];
/// assert_eq!(Calibration::<1>::from_words(&erased_flash), Err(CalibrationError::Absent));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration<const JOINTS: usize>(
    /// Of each joint.
    pub [JointCalibration; JOINTS],
);

impl<const JOINTS: usize> Calibration<JOINTS> {
    /// Words of a record, little-endian, of one joint or three. The last is the CRC-32 of the others.
    pub const WORDS: usize = HEAD + 3 * OF_JOINT + 1;

    /// The record.
    pub fn to_words(&self) -> [u32; HEAD + 3 * OF_JOINT + 1] {
        const { assert!(JOINTS >= 1 && JOINTS <= 3, "a device has one to three joints") };
        let mut words = [0; HEAD + 3 * OF_JOINT + 1];
        let channels =
            self.0.iter().enumerate().fold(0, |channels, (joint, JointCalibration { input, output, .. })| {
                channels | (u32::from(*input) | u32::from(*output) << 16) << (4 * joint)
            });
        let zeroes =
            self.0.iter().enumerate().fold(0, |zeroes, (joint, found)| zeroes | (found.zero_of as u32) << (2 * joint));
        let head = [MAGIC, VERSION | (JOINTS as u32) << 16 | zeroes << 24, channels];
        let numbers = self.0.iter().flat_map(|joint| {
            [joint.radians_per_count, joint.angle_at_zero_rad, joint.torque_at_full_n_m, joint.dry_friction_n_m]
                .map(f32::to_bits)
        });
        for (word, value) in words.iter_mut().zip(head.into_iter().chain(numbers)) {
            *word = value;
        }
        let [content @ .., crc] = &mut words;
        *crc = crc_of(content);
        words
    }

    /// The CRC-32 of its record.
    pub fn crc(&self) -> u32 {
        let [.., crc] = self.to_words();
        crc
    }

    /// Reads a record.
    ///
    /// # Errors
    /// Why there is no record, or no valid one. [`Device::calibrated`] checks whether it can belong to a device.
    pub fn from_words(words: &[u32; HEAD + 3 * OF_JOINT + 1]) -> Result<Self, CalibrationError> {
        let [magic, shape, channels, numbers @ .., crc] = words;
        if words.iter().all(|word| *word == BLANK) {
            return Err(CalibrationError::Absent);
        }
        // The first words are written last.
        if *magic == BLANK && *shape == BLANK {
            return Err(CalibrationError::Interrupted);
        }
        let [content @ .., _] = words;
        if *magic != MAGIC || crc_of(content) != *crc {
            return Err(CalibrationError::Damaged);
        }
        let (version, joints, zeroes) = (shape & 0xffff, shape >> 16 & 0xff, shape >> 24);
        if version != VERSION {
            return Err(CalibrationError::Version { version: version as u16 });
        }
        if joints != JOINTS as u32 {
            return Err(CalibrationError::Joints { joints: joints as u16 });
        }
        let (mut found, (joints, _)) = ([JointCalibration::default(); JOINTS], numbers.as_chunks::<OF_JOINT>());
        for (joint, (found, words)) in found.iter_mut().zip(joints).enumerate() {
            let [radians_per_count, angle_at_zero, torque_at_full, dry_friction] = words.map(f32::from_bits);
            let [input, output] = [0, 16].map(|side| (channels >> (side + 4 * joint) & 15) as u8);
            let zero_of = match zeroes >> (2 * joint) & 3 {
                0 => ZeroOf::Count,
                1 => ZeroOf::Pose,
                2 => ZeroOf::Mark,
                _ => return Err(CalibrationError::Damaged),
            };
            *found = JointCalibration {
                input,
                output,
                radians_per_count,
                zero_of,
                angle_at_zero_rad: angle_at_zero,
                torque_at_full_n_m: torque_at_full,
                dry_friction_n_m: dry_friction,
            };
        }
        Ok(Self(found))
    }

    /// Checks that the zeroes have the reference by which a device is homed ([`crate::device::Homing::zero_of`]).
    /// `None` accepts every zero: that homing measures them at each start.
    ///
    /// # Errors
    /// [`CalibrationError::ZeroOf`], with the first joint whose zero has another reference.
    pub fn check_zeroes(&self, homed_by: Option<ZeroOf>) -> Result<(), CalibrationError> {
        let is_other = |joint: &JointCalibration| homed_by.is_some_and(|wanted| joint.zero_of != wanted);
        match self.0.iter().position(is_other) {
            Some(joint) => Err(CalibrationError::ZeroOf { joint: joint as u8 }),
            None => Ok(()),
        }
    }

    /// Checks what comes of a loop's gains if the device is as it was built and this is wrong: stiffness and damping
    /// times the maximum ratio of the encoders and that of the motors, the force times that of the motors. `built` was
    /// checked against this before ([`Device::calibrated`]).
    ///
    /// # Errors
    /// The limit of the device that a result exceeds by more than a tenth.
    pub fn check_gains<K>(&self, built: &Device<K, JOINTS>, gains: &Gains) -> Result<(), CalibrationError> {
        let (mut coarser, mut weaker, mut weakest) = (0.0_f32, 0.0_f32, 0);
        for (index, joint) in self.0.iter().enumerate() {
            coarser = coarser.max((joint.radians_per_count / built.encoders[index].radians_per_count).abs());
            let ratio = (built.motors[index].torque_at_full_n_m / joint.torque_at_full_n_m).abs();
            if ratio > weaker {
                (weaker, weakest) = (ratio, index as u8);
            }
        }
        let exceeds = |gain: f32, scale: f32, limit: f32| gain.min(limit) * scale > SCALE_WITHIN * limit;
        if exceeds(gains.force_n, weaker, built.max_force_n) {
            return Err(CalibrationError::Force { joint: weakest });
        }
        if exceeds(gains.stiffness_n_per_m, coarser * weaker, built.max_stiffness_n_per_m) {
            return Err(CalibrationError::Stiffness);
        }
        if exceeds(gains.damping_n_s_per_m, coarser * weaker, built.max_damping_n_s_per_m) {
            return Err(CalibrationError::Damping);
        }
        Ok(())
    }

    /// Which input and output each joint is on.
    ///
    /// # Errors
    /// [`CalibrationError::Channels`], if one has none, or another's.
    pub fn wiring(&self) -> Result<Wiring<JOINTS>, CalibrationError> {
        Wiring::try_new(self.0.map(|joint| joint.input), self.0.map(|joint| joint.output))
            .ok_or(CalibrationError::Channels)
    }
}

fn crc_of(words: &[u32]) -> u32 {
    words.iter().fold(0, |crc, word| crc32(crc, *word))
}

/// Whether a number is another one's to within this factor, whatever their signs. False for NaN and 0.
fn is_within(found: f32, built: f32, factor: f32) -> bool {
    let ratio = (found / built).abs();
    ratio >= 1.0 / factor && ratio <= factor
}

/// The feed of a motor whose measured torque is `factor` times the torque in the compiled-in preset.
///
/// The compensated back-EMF never grows: more of it than the motor generates would accelerate the motor. A torque
/// constant that is higher by a factor generates more back-EMF by that factor; a supply that is higher by a factor
/// compensates more by that factor; the measurement cannot tell the two apart. So the compensation is reduced by the
/// factor in both cases, and the uncompensated rest brakes.
fn fed(feed: Feed, factor: f32) -> Feed {
    let Feed::Voltage(built) = feed else { return feed };
    let size = factor.abs();
    let less = if size > 1.0 { 1.0 / size } else { size };
    Feed::Voltage(VoltageFeed { ratio: built.ratio * if factor < 0.0 { -less } else { less }, ..built })
}

impl<K: Kinematics<JOINTS> + Copy, const JOINTS: usize> Device<K, JOINTS> {
    /// The same device with the values that commissioning measured: encoders, motors and dry friction. Its mechanism,
    /// ranges and limits stay.
    ///
    /// # Errors
    /// A value that cannot belong to this device: a number that is not finite, a joint without an input or output of
    /// its own; an encoder more than five times as fine or as coarse as in the preset, or whose zero lies more than a
    /// turn outside of the joint's range; a motor more than twice as strong or as weak; a friction of more than an
    /// eighth of the torque with which the maximum force loads the joint, or one that the motor does not overcome.
    pub fn calibrated(&self, found: &Calibration<JOINTS>) -> Result<Self, CalibrationError> {
        found.wiring()?;
        let loads = self.max_loads();
        let mut device = *self;
        for (index, joint) in found.0.iter().enumerate() {
            let JointCalibration {
                radians_per_count,
                angle_at_zero_rad: angle_at_zero,
                torque_at_full_n_m: torque_at_full,
                dry_friction_n_m: dry_friction,
                ..
            } = *joint;
            let named = index as u8;
            if ![radians_per_count, angle_at_zero, torque_at_full, dry_friction].iter().all(|number| number.is_finite())
            {
                return Err(CalibrationError::NotFinite { joint: named });
            }
            if !is_within(radians_per_count, self.encoders[index].radians_per_count, ENCODER_WITHIN) {
                return Err(CalibrationError::Encoder { joint: named });
            }
            let [least, most] = self.joint_range_rad[index];
            if angle_at_zero < least - TAU || angle_at_zero > most + TAU {
                return Err(CalibrationError::Zero { joint: named });
            }
            if !is_within(torque_at_full, self.motors[index].torque_at_full_n_m, TORQUE_WITHIN) {
                return Err(CalibrationError::Torque { joint: named });
            }
            let most = FRICTION_WITHIN * loads[index].unwrap_or(torque_at_full.abs());
            if !(0.0..=most).contains(&dry_friction) || dry_friction >= torque_at_full.abs() {
                return Err(CalibrationError::Friction { joint: named });
            }
            device.encoders[index] = Encoder { radians_per_count, angle_at_zero_rad: angle_at_zero };
            device.feeds[index] = fed(self.feeds[index], torque_at_full / self.motors[index].torque_at_full_n_m);
            device.motors[index] = Motor { torque_at_full_n_m: torque_at_full };
            device.dry_friction_n_m[index] = dry_friction;
        }
        Ok(device)
    }

    /// The torques that the maximum force can load each joint with in the middle of the joints' ranges, N·m; `None`
    /// where the mechanism is not in its workspace there.
    fn max_loads(&self) -> [Option<f32>; JOINTS] {
        let middle = |[low, high]: [f32; 2]| if high < f32::INFINITY { 0.5 * (low + high) } else { 0.0 };
        let pose = self.kinematics.pose(self.joint_range_rad.map(middle));
        match pose.filter(|pose| pose.singularity_margin() >= self.min_margin_m_per_rad) {
            Some(pose) => pose.jacobian.map(|column| Some(self.max_force_n * column.length())),
            None => [None; JOINTS],
        }
    }
}

#[cfg(test)]
mod tests;
