//! From encoder counts to validated joint angles.

use super::Fault;
use super::state::Sensors;
use crate::device::{Counts, Device, Encoder, Kinematics, VelocityEstimator};

/// Takes this tick's counts into the state: joint angles and rates. Returns how far they are from the joints' stops,
/// [`Device::to_stop`]. Unless the angles are `placed`, for homing is under way, only their changes mean something.
///
/// # Errors
/// The fault, if an angle lies outside the joint's range or jumped faster than the device can move (the state keeps its
/// last good counts then).
#[inline]
pub(super) fn sense<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    estimators: &[VelocityEstimator; JOINTS],
    max_move: f32,
    placed: bool,
    sensors: &mut Sensors<JOINTS>,
    counts: [Counts; JOINTS],
) -> Result<f32, Fault>
where
    K: Kinematics<JOINTS>,
{
    let mut angles = [0.0; JOINTS];
    let encoders = device.encoders.iter().zip(sensors.angles_at_zero);
    for ((angle, (encoder, angle_at_zero)), count) in angles.iter_mut().zip(encoders).zip(counts) {
        *angle = Encoder { angle_at_zero_rad: angle_at_zero, ..*encoder }.angle(count);
    }
    let to_stop = device.to_stop(&angles);
    let in_range = to_stop >= 0.0;
    if placed && !in_range {
        return Err(Fault::JointOutOfRange);
    }
    let before = sensors.angles;
    // The first counts have nothing to have moved from.
    let first = sensors.counts.is_none();
    if !first {
        let believable = |(angle, last): (&f32, &f32)| (angle - last).abs() <= max_move;
        if !angles.iter().zip(&before).all(believable) {
            return Err(Fault::JointJumped);
        }
        let memories = sensors.rates.iter_mut().zip(&mut sensors.velocities).zip(estimators);
        for (((rate, memory), estimator), (angle, last)) in memories.zip(angles.iter().zip(before)) {
            *rate = estimator.next(memory, angle - last);
        }
    }
    sensors.counts = Some(counts);
    sensors.angles = angles;
    Ok(to_stop)
}
