//! From encoder counts to validated joint angles.

use super::Fault;
use super::state::Sensors;
use crate::device::{Counts, Device, Encoder, Kinematics, VelocityEstimator};

/// Number of turns within which an endless joint's angle stays. Beyond them whole turns are taken out of it, eight at a
/// time: its rounding stays below 1 % of a count of 14 bits.
const WINDOW: i32 = 8;

/// The result of a tick's counts.
pub(super) struct Sensed {
    /// How far the joints are from their stops, [`Device::to_stop`].
    pub to_stop: f32,
    /// Whether whole turns were taken out of a joint's angle.
    pub turned: bool,
}

/// Takes this tick's counts into the state: joint angles and rates. Unless the angles are `placed`, for homing is under
/// way, only their changes mean something.
///
/// # Errors
/// The fault, if an angle lies outside the joint's range or jumped faster than the device can move (the state keeps its
/// last good counts then).
#[inline]
pub(super) fn sense<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    estimators: &[VelocityEstimator; JOINTS],
    max_move: f32,
    (placed, endless): (bool, bool),
    sensors: &mut Sensors<JOINTS>,
    counts: [Counts; JOINTS],
) -> Result<Sensed, Fault>
where
    K: Kinematics<JOINTS>,
{
    let (shown, turned) = if endless { unwound(device, sensors, counts) } else { (counts, false) };
    let mut angles = [0.0; JOINTS];
    let encoders = device.encoders.iter().zip(sensors.angles_at_zero);
    for ((angle, (encoder, angle_at_zero)), count) in angles.iter_mut().zip(encoders).zip(shown) {
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
    Ok(Sensed { to_stop, turned })
}

/// The counts without whole turns, of a device some of whose joints turn without end, and whether turns were taken out.
#[inline(never)]
fn unwound<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    sensors: &mut Sensors<JOINTS>,
    counts: [Counts; JOINTS],
) -> ([Counts; JOINTS], bool) {
    let (mut shown, mut turned) = (counts, false);
    for (joint, count) in shown.iter_mut().enumerate() {
        let Some(per_turn) = device.endless(joint) else { continue };
        *count = within(device, joint, sensors.turns[joint], counts[joint]);
        if !(per_turn.wrapping_mul(-WINDOW)..=per_turn.wrapping_mul(WINDOW)).contains(&count.0) {
            turned = true;
            take_out(device, joint, per_turn, sensors, counts[joint]);
            *count = within(device, joint, sensors.turns[joint], counts[joint]);
        }
    }
    (shown, turned)
}

/// A joint's count without the whole turns that were taken out of it. Over the wrap of 32 bits the difference is right.
#[inline]
fn within<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    joint: usize,
    turns: i32,
    Counts(count): Counts,
) -> Counts {
    match device.endless(joint) {
        Some(per_turn) => Counts(count.wrapping_sub(turns.wrapping_mul(per_turn))),
        None => Counts(count),
    }
}

/// Takes eight turns, or as many more as the first counts need, out of a joint's angle and out of all that is compared
/// with it. Once in eight turns.
#[cold]
fn take_out<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    joint: usize,
    per_turn: i32,
    sensors: &mut Sensors<JOINTS>,
    count: Counts,
) {
    let Counts(inside) = within(device, joint, sensors.turns[joint], count);
    let whole = if per_turn == 0 { 0 } else { inside / per_turn / WINDOW * WINDOW };
    sensors.turns[joint] = sensors.turns[joint].wrapping_add(whole);
    if let Some(last) = sensors.counts {
        let encoder = Encoder { angle_at_zero_rad: sensors.angles_at_zero[joint], ..device.encoders[joint] };
        // By the counts: a difference of large angles would be rounded.
        sensors.angles[joint] = encoder.angle(within(device, joint, sensors.turns[joint], last[joint]));
    }
}
