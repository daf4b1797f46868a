//! From encoder counts to validated joint angles.

use super::Fault;
use super::state::Sensors;
use crate::device::{Counts, Device, Encoder, Kinematics, VelocityEstimator, VelocityState};

/// Number of turns within which an endless joint's angle stays. Beyond them whole turns are taken out of it, eight at a
/// time: its rounding stays below 1 % of a count of 14 bits.
const WINDOW: i32 = 8;

/// The result of a tick's counts.
pub(super) struct Sensed {
    /// How far the joints are from their stops, [`Device::to_stop`].
    pub to_stop: f32,
    /// Whether whole turns were taken out of the joint's angle.
    pub turned: bool,
}

/// Takes this tick's counts into the state: joint angles and rates. Unless the angles are `placed`, for homing is under
/// way, only their changes mean something. `per_turn` is [`Device::endless`], computed once.
///
/// # Errors
/// The fault, if an angle lies outside the joint's range or jumped faster than the device can move (the state keeps its
/// last angles then).
#[inline]
pub(super) fn sense<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    estimators: &[VelocityEstimator; JOINTS],
    max_move: f32,
    per_turn: Option<i32>,
    placed: bool,
    sensors: &mut Sensors<JOINTS>,
    counts: [Counts; JOINTS],
) -> Result<Sensed, Fault>
where
    K: Kinematics<JOINTS>,
{
    let mut angles = [0.0; JOINTS];
    let encoders = device.encoders.iter().zip(sensors.angles_at_zero);
    for ((angle, (encoder, angle_at_zero)), count) in angles.iter_mut().zip(encoders).zip(counts) {
        *angle = Encoder { angle_at_zero_rad: angle_at_zero, ..*encoder }.angle(count);
    }
    let mut turned = false;
    if JOINTS == 1
        && let Some(per_turn) = per_turn
    {
        turned = wind(device, per_turn, sensors, counts[0], &mut angles[0]);
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
        let moves = || angles.iter().zip(&before).map(|(angle, last)| (angle - last).abs());
        // The usual case, by one comparison: a rounded sum is not below any of its terms.
        let in_all = moves().fold(0.0, |sum, each| sum + each);
        if !(in_all <= max_move || moves().all(|each| each <= max_move)) {
            return Err(Fault::JointJumped);
        }
        let memories = sensors.rates.iter_mut().zip(&mut sensors.lags).zip(estimators);
        for (((rate, lag), estimator), (angle, last)) in memories.zip(angles.iter().zip(before)) {
            let mut memory = VelocityState { lag: *lag, velocity: *rate };
            estimator.next(&mut memory, angle - last);
            VelocityState { lag: *lag, velocity: *rate } = memory;
        }
    }
    sensors.counts = Some(counts);
    sensors.angles = angles;
    Ok(Sensed { to_stop, turned })
}

/// The angle of an only joint that turns without end, without the whole turns that were taken out of it; where it has
/// left its window eight more turns are taken out, or as many as the first counts need, of all that is compared with it
/// too. Returns whether that was so. By the counts: a difference of large angles would be rounded; over the wrap of 32
/// bits the difference of counts is right.
#[inline]
fn wind<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    per_turn: i32,
    sensors: &mut Sensors<JOINTS>,
    Counts(count): Counts,
    angle: &mut f32,
) -> bool {
    let encoder = Encoder { angle_at_zero_rad: sensors.angles_at_zero[0], ..device.encoders[0] };
    let mut inside = count.wrapping_sub(sensors.turns.wrapping_mul(per_turn));
    let window = per_turn.wrapping_mul(WINDOW);
    let turned = inside > window || inside < window.wrapping_neg();
    if turned {
        let whole = if per_turn > 0 { inside / per_turn / WINDOW * WINDOW } else { 0 };
        sensors.turns = sensors.turns.wrapping_add(whole);
        let out = sensors.turns.wrapping_mul(per_turn);
        inside = count.wrapping_sub(out);
        if let Some(last) = sensors.counts {
            sensors.angles[0] = encoder.angle(Counts(last[0].0.wrapping_sub(out)));
        }
    }
    *angle = encoder.angle(Counts(inside));
    turned
}
