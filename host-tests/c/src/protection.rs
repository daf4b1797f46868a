//! Protection of motors and hand, as numbers.

use crate::felt::Felt;
use crate::pointers::{Plain, finite, flag};
use crate::status::Status;
use palpate_core::device::{Device, Endurance, PolarityCheck, Protection, SupplyRange};
use palpate_core::servo::{Config, Guard, Guarded, Servo, Surface, Unguarded};

/// Thermal limits of a motor's winding.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct EnduranceNumbers {
    pub continuous: f32,
    pub time_constant: f32,
}

/// Protection of a device; the numbers of joints that it does not have are ignored.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ProtectionNumbers {
    pub motors: [EnduranceNumbers; 3],
    pub max_joint_rates: [f32; 3],
    pub max_probe_speed: f32,
    pub watch_signs: u32,
    pub inertia: [f32; 3],
    pub watch_supply: u32,
    pub least_supply: u32,
    pub most_supply: u32,
}

// SAFETY: numbers alone.
unsafe impl Plain for ProtectionNumbers {}

/// Kind of protection of a loop.
pub trait Guarding<const JOINTS: usize> {
    /// The guard.
    type Guard: Guard<JOINTS> + Copy + 'static;

    /// The part of the motors' full torques, N·m, that they hold for long.
    fn holds(&self, full_n_m: [f32; JOINTS]) -> [f32; JOINTS] {
        full_n_m
    }

    /// The loop with its guard.
    fn servo<K, S: Surface>(
        &self,
        device: &'static Device<K, JOINTS>,
        body: &'static Felt<S>,
        config: Config<JOINTS>,
    ) -> Result<Servo<'static, Felt<S>, K, JOINTS, Self::Guard>, Status>
    where
        K: palpate_core::device::Kinematics<JOINTS>;
}

/// No protection.
pub struct Unprotected;

impl<const JOINTS: usize> Guarding<JOINTS> for Unprotected {
    type Guard = Unguarded;

    fn servo<K, S: Surface>(
        &self,
        device: &'static Device<K, JOINTS>,
        body: &'static Felt<S>,
        config: Config<JOINTS>,
    ) -> Result<Servo<'static, Felt<S>, K, JOINTS>, Status>
    where
        K: palpate_core::device::Kinematics<JOINTS>,
    {
        Ok(Servo::try_new(device, body, config)?)
    }
}

impl<const JOINTS: usize> Guarding<JOINTS> for ProtectionNumbers {
    type Guard = Guarded<JOINTS>;

    fn holds(&self, mut full_n_m: [f32; JOINTS]) -> [f32; JOINTS] {
        for (torque, motor) in full_n_m.iter_mut().zip(&self.motors) {
            *torque *= motor.continuous.min(1.0);
        }
        full_n_m
    }

    fn servo<K, S: Surface>(
        &self,
        device: &'static Device<K, JOINTS>,
        body: &'static Felt<S>,
        config: Config<JOINTS>,
    ) -> Result<Servo<'static, Felt<S>, K, JOINTS, Guarded<JOINTS>>, Status>
    where
        K: palpate_core::device::Kinematics<JOINTS>,
    {
        Ok(Servo::try_protected(device, body, self.protection()?, config)?)
    }
}

impl ProtectionNumbers {
    fn protection<const JOINTS: usize>(&self) -> Result<Protection<JOINTS>, Status> {
        let mut protection = Protection {
            motors: [Endurance { continuous: 0.0, time_constant_s: 0.0 }; JOINTS],
            max_joint_rates_rad_per_s: [0.0; JOINTS],
            max_probe_speed_m_per_s: self.max_probe_speed,
            supply: None,
            polarity: None,
        };
        let mut signs = PolarityCheck { inertia_kg_m2: [0.0; JOINTS] };
        // No device has more than three joints: the numbers reach.
        let joints =
            protection.motors.iter_mut().zip(&mut protection.max_joint_rates_rad_per_s).zip(&mut signs.inertia_kg_m2);
        let numbers = self.motors.iter().zip(&self.max_joint_rates).zip(&self.inertia);
        for (((motor, rate), inertia), ((given, max_rate), given_inertia)) in joints.zip(numbers) {
            *motor = Endurance { continuous: given.continuous, time_constant_s: given.time_constant };
            *rate = *max_rate;
            *inertia = *given_inertia;
        }
        if flag(self.watch_signs)? {
            protection.polarity = Some(signs);
        } else {
            finite(&signs.inertia_kg_m2).map_err(|_| Status::ProtectionInertia)?;
        }
        if flag(self.watch_supply)? {
            protection.supply = Some(SupplyRange { min_mv: self.least_supply, max_mv: self.most_supply });
        }
        Ok(protection)
    }
}
