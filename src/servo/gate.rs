//! The last thing before the motors: nothing that is not finite, in range and allowed passes.

use super::Fault;
use crate::device::{Duty, Motor};

/// The duties for these joint torques, N·m, and what the torques were scaled by.
///
/// Beyond full scale the whole vector is scaled, so that the force keeps its direction. Unless `drives`, the duties are
/// zero.
///
/// # Errors
/// [`Fault::NotFinite`] if a torque is not a finite number.
#[inline]
pub fn gate<const JOINTS: usize>(
    drives: bool,
    motors: &[Motor; JOINTS],
    torques: [f32; JOINTS],
) -> Result<([Duty; JOINTS], f32), Fault> {
    let mut fractions = [0.0; JOINTS];
    let (mut largest, mut sum) = (1.0_f32, 0.0);
    for ((fraction, motor), torque) in fractions.iter_mut().zip(motors).zip(torques) {
        *fraction = motor.fraction(torque);
        let size = fraction.abs();
        sum += size;
        largest = if size > largest { size } else { largest };
    }
    // Not finite where one of them is not, or where all together are beyond all bounds.
    if !sum.is_finite() {
        return Err(Fault::NotFinite);
    }
    if !drives {
        return Ok(([Duty::ZERO; JOINTS], 0.0));
    }
    let scale = 1.0 / largest;
    Ok((fractions.map(|fraction| Duty::from_fraction(fraction * scale)), scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTORS: [Motor; 3] = [Motor { torque_at_full: 1.0 }; 3];

    #[test]
    fn only_a_loop_that_drives_lets_a_duty_through() {
        let torques = [0.5, -0.5, 1.0];
        assert_eq!(gate(true, &MOTORS, torques), Ok(([Duty(16_384), Duty(-16_384), Duty::FULL], 1.0)));
        assert_eq!(gate(false, &MOTORS, torques), Ok(([Duty::ZERO; 3], 0.0)));
    }

    #[test]
    fn too_much_is_scaled_as_a_whole() {
        let gated = gate(true, &MOTORS, [4.0, -2.0, 0.0]);
        assert_eq!(gated, Ok(([Duty::FULL, Duty(-16_384), Duty::ZERO], 0.25)));
    }

    #[test]
    fn what_is_not_finite_is_a_fault_whether_it_drives_or_not() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for drives in [false, true] {
                for joint in 0..3 {
                    let mut torques = [0.1; 3];
                    torques[joint] = bad;
                    assert_eq!(gate(drives, &MOTORS, torques), Err(Fault::NotFinite));
                }
            }
        }
    }
}
