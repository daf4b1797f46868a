//! Which number of a protection is refused.

use crate::device::{Protection, SupplyRange};
use thiserror::Error;

/// Which number is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ProtectionError {
    /// A motor's continuous torque is not above zero, or not finite.
    #[error("a motor's continuous torque must be a positive share of full duty")]
    Continuous,
    /// A motor's time constant is below 100 ticks, above ten minutes, or not a number.
    #[error("a winding's time constant must be between 100 ticks and ten minutes")]
    TimeConstant,
    /// A speed is not above zero.
    #[error("the maximum speeds must be positive")]
    Speed,
    /// The supply's range holds nothing.
    #[error("the supply's minimum voltage must be below its maximum")]
    Supply,
    /// An inertia is not positive and finite.
    #[error("the joints' inertias must be positive and finite")]
    Inertia,
}

/// Checks a protection for a loop of `rate`, Hz.
pub(super) const fn check<const JOINTS: usize>(
    protection: &Protection<JOINTS>,
    rate: f32,
) -> Result<(), ProtectionError> {
    let mut joint = 0;
    while joint < JOINTS {
        let motor = protection.motors[joint];
        let bears = motor.continuous > 0.0 && motor.continuous < f32::INFINITY;
        if !bears {
            return Err(ProtectionError::Continuous);
        }
        let lasts = motor.time_constant_s * rate >= 100.0 && motor.time_constant_s <= 600.0;
        if !lasts {
            return Err(ProtectionError::TimeConstant);
        }
        let moves = protection.max_joint_rates_rad_per_s[joint] > 0.0;
        if !moves {
            return Err(ProtectionError::Speed);
        }
        if let Some(signs) = &protection.polarity {
            let turns = signs.inertia_kg_m2[joint] > 0.0 && signs.inertia_kg_m2[joint] < f32::INFINITY;
            if !turns {
                return Err(ProtectionError::Inertia);
            }
        }
        joint += 1;
    }
    let moves = protection.max_probe_speed_m_per_s > 0.0;
    if !moves {
        return Err(ProtectionError::Speed);
    }
    if let Some(SupplyRange { min_mv: least, max_mv: most }) = protection.supply
        && least >= most
    {
        return Err(ProtectionError::Supply);
    }
    Ok(())
}
