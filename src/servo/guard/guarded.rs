//! A protection, ready to run.

use super::heat::{Heat, HeatModel};
use super::protection_error::{ProtectionError, check};
use super::sign::{SignState, Signs};
use super::supply::SupplyWatch;
use super::{Guard, Moving, Remembered};
use crate::device::{Duty, Motor, Protection};
use crate::render::Penalty;
use crate::servo::Fault;
use crate::servo::gate::{gate, gate_within};

/// A device's [`Protection`] for a loop's rate and gains.
#[derive(Clone, Copy, Debug)]
pub struct Guarded<const JOINTS: usize> {
    heat: [HeatModel; JOINTS],
    max_joint_rates: [f32; JOINTS],
    /// m²/s².
    max_squared_speed: f32,
    supply: Option<SupplyWatch>,
    signs: Option<Signs<JOINTS>>,
}

/// What [`Guarded`] remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardState<const JOINTS: usize> {
    /// How warm each winding may be.
    heat: [Heat; JOINTS],
    /// Whether any of them is so warm that its force folds back.
    folds: bool,
    /// Ticks since the supply was measured.
    supply_age: u32,
    signs: SignState<JOINTS>,
}

impl<const JOINTS: usize> GuardState<JOINTS> {
    /// How warm each motor's winding may be.
    pub const fn heat(&self) -> [Heat; JOINTS] {
        self.heat
    }

    /// How many contacts each joint has come through in the watch over signs that are wrong.
    pub const fn contacts_passed(&self) -> [u8; JOINTS] {
        self.signs.passed()
    }

    /// Whether a motor is so warm that it is given less than full scale.
    pub const fn folds(&self) -> bool {
        self.folds
    }
}

impl<const JOINTS: usize> Guarded<JOINTS> {
    /// # Errors
    /// The number that is refused.
    pub(in crate::servo) const fn try_new(
        protection: Protection<JOINTS>,
        rate: f32,
        penalty: &Penalty,
    ) -> Result<Self, ProtectionError> {
        if let Err(error) = check(&protection, rate) {
            return Err(error);
        }
        let mut heat = [HeatModel::new(protection.motors[0], rate); JOINTS];
        let mut joint = 1;
        while joint < JOINTS {
            heat[joint] = HeatModel::new(protection.motors[joint], rate);
            joint += 1;
        }
        Ok(Self {
            heat,
            max_joint_rates: protection.max_joint_rates,
            max_squared_speed: protection.max_probe_speed * protection.max_probe_speed,
            supply: match protection.supply {
                Some(range) => Some(SupplyWatch::new(range, rate)),
                None => None,
            },
            signs: match protection.signs {
                Some(watch) => Some(Signs::new(&watch, rate, penalty)),
                None => None,
            },
        })
    }

    fn folds(&self, heat: &[Heat; JOINTS]) -> bool {
        self.heat.iter().zip(heat).any(|(model, heat)| model.folds(*heat))
    }
}

impl<const JOINTS: usize> Guard<JOINTS> for Guarded<JOINTS> {
    type State = GuardState<JOINTS>;

    fn start(&self) -> GuardState<JOINTS> {
        let heat = self.heat.map(|model| model.start());
        GuardState { heat, folds: self.folds(&heat), supply_age: 0, signs: SignState::START }
    }

    fn measured(&self, state: &mut GuardState<JOINTS>, millivolts: u32) -> Result<(), Fault> {
        self.supply.map_or(Ok(()), |supply| supply.measured(&mut state.supply_age, millivolts))
    }

    #[inline]
    fn watch(&self, state: &mut GuardState<JOINTS>) -> Result<(), Fault> {
        self.supply.as_ref().map_or(Ok(()), |supply| supply.tick(&mut state.supply_age))
    }

    #[inline]
    fn is_busy(&self, state: &GuardState<JOINTS>) -> bool {
        state.signs.is_busy()
    }

    #[inline]
    fn motion(&self, state: &mut GuardState<JOINTS>, moving: &Moving<'_, JOINTS>) -> Result<f32, Fault> {
        let mut fast = moving.velocity.length_squared() > self.max_squared_speed;
        for joint in 0..JOINTS {
            fast |= moving.rates[joint].abs() > self.max_joint_rates[joint];
        }
        if fast {
            return Err(Fault::Overspeed);
        }
        match &self.signs {
            Some(signs) => signs.look(&mut state.signs, moving),
            None => Ok(1.0),
        }
    }

    #[inline]
    fn bounds(&self, state: &GuardState<JOINTS>) -> Option<[f32; JOINTS]> {
        if !state.folds {
            return None;
        }
        let mut bounds = [1.0; JOINTS];
        for ((bound, model), heat) in bounds.iter_mut().zip(&self.heat).zip(state.heat) {
            *bound = model.bound(heat);
        }
        Some(bounds)
    }

    #[inline]
    fn gate(
        &self,
        state: &GuardState<JOINTS>,
        drives: bool,
        motors: &[Motor; JOINTS],
        felt: [f32; JOINTS],
        weight: [f32; JOINTS],
    ) -> Result<([Duty; JOINTS], f32), Fault> {
        match self.bounds(state) {
            None => gate(drives, motors, felt, weight),
            Some(bounds) => gate_within(drives, motors, felt, weight, &bounds),
        }
    }

    #[inline]
    fn given(&self, state: &mut GuardState<JOINTS>, duties: &[Duty; JOINTS]) {
        let mut folds = false;
        for ((heat, model), duty) in state.heat.iter_mut().zip(&self.heat).zip(duties) {
            *heat = model.next(*heat, *duty);
            folds |= model.folds(*heat);
        }
        state.folds = folds;
    }
}

impl<const JOINTS: usize> Remembered for GuardState<JOINTS> {
    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for Heat(heat) in self.heat {
            take(heat as u32);
        }
        take(self.supply_age << 1 | u32::from(self.folds));
        self.signs.for_each_word(take);
    }
}
