//! The last thing before the motors: nothing that is not finite, in range and in phase passes.

use super::{Fault, Phase};
use crate::device::{Duty, Motor};

/// The duties for these joint torques, N·m.
///
/// Beyond full scale the whole vector is scaled, so that the force keeps its direction. In any phase but running the
/// duties are zero.
///
/// # Errors
/// [`Fault::NotFinite`] if a torque is not a finite number.
#[inline]
pub fn gate<const JOINTS: usize>(
    phase: Phase,
    motors: &[Motor; JOINTS],
    torques: [f32; JOINTS],
) -> Result<[Duty; JOINTS], Fault> {
    let mut fractions = [0.0; JOINTS];
    let mut largest = 1.0_f32;
    for ((fraction, motor), torque) in fractions.iter_mut().zip(motors).zip(torques) {
        *fraction = motor.fraction(torque);
        if !fraction.is_finite() {
            return Err(Fault::NotFinite);
        }
        if fraction.abs() > largest {
            largest = fraction.abs();
        }
    }
    if phase != Phase::Running {
        return Ok([Duty::ZERO; JOINTS]);
    }
    let scale = 1.0 / largest;
    Ok(fractions.map(|fraction| Duty::from_fraction(fraction * scale)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTORS: [Motor; 3] = [Motor { torque_at_full: 1.0 }; 3];

    #[test]
    fn only_running_lets_a_duty_through() {
        let torques = [0.5, -0.5, 1.0];
        assert_eq!(gate(Phase::Running, &MOTORS, torques), Ok([Duty(16_384), Duty(-16_384), Duty::FULL]));
        for phase in [Phase::Standby, Phase::Fault] {
            assert_eq!(gate(phase, &MOTORS, torques), Ok([Duty::ZERO; 3]));
        }
    }

    #[test]
    fn too_much_is_scaled_as_a_whole() {
        let duties = gate(Phase::Running, &MOTORS, [4.0, -2.0, 0.0]).unwrap();
        assert_eq!(duties, [Duty::FULL, Duty(-16_384), Duty::ZERO]);
    }

    #[test]
    fn what_is_not_finite_is_a_fault_in_every_phase() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for phase in [Phase::Standby, Phase::Running, Phase::Fault] {
                for joint in 0..3 {
                    let mut torques = [0.1; 3];
                    torques[joint] = bad;
                    assert_eq!(gate(phase, &MOTORS, torques), Err(Fault::NotFinite));
                }
            }
        }
    }
}
