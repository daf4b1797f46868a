//! The last stage before the motors: passes only duties that are finite, in range and permitted.

use super::Fault;
use crate::device::{Duty, Motor};

/// The duties for joint torques, N·m: those of the contact force, `felt`, plus those of gravity compensation, `weight`.
/// Also returns the scale of the contact torques.
///
/// Gravity compensation has priority, or the arm would sag just where it presses hardest. The motors' remaining range,
/// on either side, bounds the contact torques; beyond it they are scaled, all together, so that the contact force keeps
/// its direction. (A gravity compensation beyond full scale by itself is scaled as a whole, and a force that would add
/// to it is zero.) Unless `drives`, the duties are zero.
///
/// # Errors
/// [`Fault::NotFinite`] if a torque is not a finite number.
#[inline]
pub fn gate<const JOINTS: usize>(
    drives: bool,
    motors: &[Motor; JOINTS],
    felt: [f32; JOINTS],
    weight: [f32; JOINTS],
) -> Result<([Duty; JOINTS], f32), Fault> {
    let mut fractions = [0.0; JOINTS];
    let mut sum = 0.0;
    for (((fraction, motor), felt), weight) in fractions.iter_mut().zip(motors).zip(felt).zip(weight) {
        *fraction = motor.fraction(felt + weight);
        sum += fraction.abs();
    }
    // A sum is finite only where each of its terms is; all together beyond all bounds is as bad.
    if !sum.is_finite() {
        return Err(Fault::NotFinite);
    }
    if !drives {
        return Ok(([Duty::ZERO; JOINTS], 0.0));
    }
    // The usual case: the sum of all fits into one motor's range.
    if sum <= 1.0 {
        return Ok((fractions.map(Duty::within_scale), 1.0));
    }
    let limits = core::array::from_fn(|joint| motors[joint].torque_at_full_n_m.abs());
    let (weight, scale) = fit(felt, weight, limits);
    let mut duties = [Duty::ZERO; JOINTS];
    for ((duty, motor), (felt, weight)) in duties.iter_mut().zip(motors).zip(felt.into_iter().zip(weight)) {
        // Beyond full scale by roundings at most, which the duty's own rounding takes back.
        *duty = Duty::within_scale(motor.fraction(felt * scale + weight));
    }
    Ok((duties, scale))
}

/// As [`gate`], where each motor may be given only so much torque, N·m: full scale at most.
///
/// # Errors
/// As [`gate`]'s.
#[inline]
pub fn gate_within<const JOINTS: usize>(
    drives: bool,
    motors: &[Motor; JOINTS],
    felt: [f32; JOINTS],
    weight: [f32; JOINTS],
    limits: [f32; JOINTS],
) -> Result<([Duty; JOINTS], f32), Fault> {
    let (weight, scale) = fit(felt, weight, limits);
    let mut duties = [Duty::ZERO; JOINTS];
    let mut sum = 0.0;
    for ((duty, motor), (felt, weight)) in duties.iter_mut().zip(motors).zip(felt.into_iter().zip(weight)) {
        let fraction = motor.fraction(felt * scale + weight);
        sum += fraction.abs();
        *duty = Duty::from_number(fraction);
    }
    if !sum.is_finite() {
        return Err(Fault::NotFinite);
    }
    if drives { Ok((duties, scale)) } else { Ok(([Duty::ZERO; JOINTS], 0.0)) }
}

/// Torques within these limits, N·m: the gravity compensation, and the scale of the contact torques, the largest that the
/// remaining range permits. A joint within its limit at full scale stays within at any.
#[inline(always)]
fn fit<const JOINTS: usize>(felt: [f32; JOINTS], weight: [f32; JOINTS], limits: [f32; JOINTS]) -> ([f32; JOINTS], f32) {
    let is_heavy = weight.iter().zip(&limits).any(|(weight, limit)| weight.abs() > *limit);
    let weight = if is_heavy { relieved(weight, &limits) } else { weight };
    let mut scale = 1.0;
    for ((felt, weight), limit) in felt.into_iter().zip(weight).zip(limits) {
        let torque = felt + weight;
        if torque.abs() > limit {
            let most = (if torque > 0.0 { limit - weight } else { -limit - weight }) / felt;
            scale = if most < scale { most } else { scale };
        }
    }
    (weight, scale)
}

/// A gravity compensation beyond the motors' limits, scaled as a whole to fit.
#[cold]
fn relieved<const JOINTS: usize>(weight: [f32; JOINTS], limits: &[f32; JOINTS]) -> [f32; JOINTS] {
    let mut heaviest = 1.0;
    for (weight, limit) in weight.iter().zip(limits) {
        let share = weight.abs() / limit;
        heaviest = if share > heaviest { share } else { heaviest };
    }
    // Short of the limit by more than rounding errors, so that the range left for the force is never negative.
    let scale = 0.999_999 / heaviest;
    weight.map(|weight| weight * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTORS: [Motor; 3] = [Motor { torque_at_full_n_m: 1.0 }; 3];
    const NONE: [f32; 3] = [0.0; 3];

    #[test]
    fn only_a_loop_that_drives_lets_a_duty_through() {
        let torques = [0.5, -0.5, 1.0];
        assert_eq!(gate(true, &MOTORS, torques, NONE), Ok(([Duty(16_384), Duty(-16_384), Duty::FULL], 1.0)));
        assert_eq!(gate(false, &MOTORS, torques, NONE), Ok(([Duty::ZERO; 3], 0.0)));
    }

    #[test]
    fn too_much_is_scaled_as_a_whole() {
        let gated = gate(true, &MOTORS, [4.0, -2.0, 0.0], NONE);
        assert_eq!(gated, Ok(([Duty::FULL, Duty(-16_384), Duty::ZERO], 0.25)));
    }

    #[test]
    fn the_weight_is_carried_and_what_is_felt_gets_what_is_left() {
        // Left above the weight: 0.5 up for the first, 1.25 down for the second. 1.0 and −2.0 fit at 0.5.
        let gated = gate(true, &MOTORS, [1.0, -2.0, 0.0], [0.5, 0.25, -0.125]);
        assert_eq!(gated, Ok(([Duty::FULL, Duty::from_fraction(-0.75), Duty::from_fraction(-0.125)], 0.5)));
        // Against the weight there is more than all of a motor.
        assert_eq!(
            gate(true, &MOTORS, [-1.5, 0.0, 0.0], [0.5, 0.0, 0.0]),
            Ok(([-1.0, 0.0, 0.0].map(Duty::from_fraction), 1.0))
        );
    }

    #[test]
    fn whatever_is_asked_what_is_felt_keeps_its_direction_and_the_weight_its_size() {
        let mut seed = 1_u32;
        let mut draw = |size: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 * size - size
        };
        for _ in 0..100_000 {
            let (felt, weight) = ([(); 3].map(|()| draw(5.0)), [(); 3].map(|()| draw(1.0)));
            let (duties, scale) = gate(true, &MOTORS, felt, weight).unwrap();
            assert!((0.0..=1.0).contains(&scale));
            for joint in 0..3 {
                let left = duties[joint].fraction() - weight[joint];
                // Half a step of duty, 1.5e-5, and roundings.
                assert!((left - felt[joint] * scale).abs() < 1.7e-5, "{felt:?} {weight:?} {duties:?} {scale}");
            }
        }
    }

    #[test]
    fn a_motor_that_may_not_give_all_of_its_scale_does_not() {
        let mut seed = 1_u32;
        let mut draw = |size: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 * size - size
        };
        for _ in 0..100_000 {
            let (felt, weight) = ([(); 3].map(|()| draw(2.0)), [(); 3].map(|()| draw(1.5)));
            // A third of them nothing at all.
            let scales = [(); 3].map(|()| draw(1.0)).map(|scale| if scale.abs() > 0.67 { 0.0 } else { scale.abs() });
            let (duties, scale) = gate_within(true, &MOTORS, felt, weight, scales).unwrap();
            assert!((0.0..=1.0).contains(&scale), "{felt:?} {weight:?} {scales:?}");
            for (duty, most) in duties.iter().zip(scales) {
                // Half a step of duty.
                assert!(duty.fraction().abs() <= most + 1.6e-5, "{felt:?} {weight:?} {scales:?} {duties:?}");
            }
        }
    }

    #[test]
    fn a_motor_at_its_bound_never_turns_round() {
        let mut seed = 1_u32;
        let mut draw = |size: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 * size - size
        };
        for _ in 0..1_000_000 {
            let motors = [(); 3].map(|()| Motor { torque_at_full_n_m: draw(3.0) });
            let torques = motors.map(|motor| motor.torque_at_full_n_m * draw(4.0));
            let weight = motors.map(|motor| motor.torque_at_full_n_m * draw(1.5));
            let bounds = [1.0, 0.999_999_94, draw(1.0).abs()];
            let limits = core::array::from_fn(|joint| bounds[joint] * motors[joint].torque_at_full_n_m.abs());
            let (duties, scale) = gate_within(true, &motors, torques, weight, limits).unwrap();
            let is_heavy = weight.iter().zip(limits).any(|(weight, limit)| weight.abs() > limit);
            for (joint, duty) in duties.iter().enumerate() {
                let wanted = (torques[joint] * scale + weight[joint]) / motors[joint].torque_at_full_n_m;
                // Half a step of duty, and roundings of numbers up to 4.
                assert!(is_heavy || (duty.fraction() - wanted).abs() < 1.7e-5, "{duty:?} {wanted}");
                assert!(duty.fraction().abs() <= bounds[joint] + 1.6e-5, "{duty:?} {bounds:?}");
            }
        }
    }

    #[test]
    fn a_motor_at_full_scale_never_turns_round() {
        let mut seed = 1_u32;
        let mut draw = |size: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 * size - size
        };
        for round in 0..1_000_000 {
            let size = [1.0, 4.0, 1e3, 1e9][round % 4];
            let motors = [(); 3].map(|()| Motor { torque_at_full_n_m: draw(3.0) });
            let felt = motors.map(|motor| motor.torque_at_full_n_m * draw(size));
            let weight = motors.map(|motor| motor.torque_at_full_n_m * draw(1.0));
            let (duties, scale) = gate(true, &motors, felt, weight).unwrap();
            for (joint, duty) in duties.iter().enumerate() {
                let wanted = (felt[joint] * scale + weight[joint]) / motors[joint].torque_at_full_n_m;
                // Half a step of duty, and roundings of numbers near 1.
                assert!((duty.fraction() - wanted).abs() < 1.7e-5, "{duty:?} {wanted}");
            }
        }
    }

    #[test]
    fn a_weight_that_no_motor_carries_stops_at_full_scale_and_is_not_added_to() {
        let (duties, scale) = gate(true, &MOTORS, [0.5, 0.5, 0.0], [2.0, 1.0, 0.0]).unwrap();
        assert_eq!(duties, [1.0, 0.5, 0.0].map(Duty::from_fraction));
        // The millionth that keeps the range from being negative, of half of full scale.
        assert!((0.0..=2.1e-6).contains(&scale), "{scale}");
    }

    #[test]
    fn what_is_not_finite_is_a_fault_whether_it_drives_or_not() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for drives in [false, true] {
                for joint in 0..3 {
                    let mut torques = [0.1; 3];
                    torques[joint] = bad;
                    assert_eq!(gate(drives, &MOTORS, torques, NONE), Err(Fault::NotFinite));
                    assert_eq!(gate(drives, &MOTORS, NONE, torques), Err(Fault::NotFinite));
                    // Whatever their sum.
                    assert_eq!(gate(drives, &MOTORS, torques, torques.map(|torque| -torque)), Err(Fault::NotFinite));
                    for bounds in [[0.5; 3], [0.0; 3]] {
                        assert_eq!(gate_within(drives, &MOTORS, torques, NONE, bounds), Err(Fault::NotFinite));
                        assert_eq!(gate_within(drives, &MOTORS, NONE, torques, bounds), Err(Fault::NotFinite));
                    }
                }
            }
        }
    }
}
