//! A protection, ready to run.

use super::heat::{Heat, HeatModel, Winding};
use super::polarity::{Polarities, PolarityState};
use super::release::{ReleaseState, ReleaseWatch};
use super::{Guard, Motion, Remembered};
use crate::device::{Duty, Encoder, Motor, Protection, SupplyRange};
use crate::math::Vec3;
use crate::render::Penalty;
use crate::servo::Fault;
use crate::servo::gate::gate_within;

/// A device's [`Protection`] for a loop's rate and gains.
///
/// The joints take turns, one per tick: a tick checks the rate of one joint and updates the heat of one motor. The
/// delay is one tick less than the number of joints: half a millisecond for three at 4 kHz. The polarity, the supply and
/// the probe's speed are checked in every tick, speeds while a contact gives force and for 50 ms after.
#[derive(Clone, Copy, Debug)]
pub struct Guarded<const JOINTS: usize> {
    heat: [HeatModel; JOINTS],
    max_joint_rates: [f32; JOINTS],
    /// m²/s².
    max_squared_speed: f32,
    supply: Option<SupplyWatch>,
    signs: Option<Polarities<JOINTS>>,
    release: ReleaseWatch,
    /// kg·m²; zero where they are not known.
    inertia: [f32; JOINTS],
}

/// The state of [`Guarded`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardState<const JOINTS: usize> {
    /// The joint whose turn it is.
    turn: usize,
    windings: [Winding; JOINTS],
    /// Ticks since the supply was measured.
    supply_age: u32,
    signs: PolarityState<JOINTS>,
    release: ReleaseState,
}

impl<const JOINTS: usize> GuardState<JOINTS> {
    /// How warm each motor's winding may be.
    pub fn heat(&self) -> [Heat; JOINTS] {
        self.windings.map(|winding| winding.heat)
    }

    /// The most torque that each motor may be given, N·m.
    pub fn limits(&self) -> [f32; JOINTS] {
        self.windings.map(|winding| winding.limit)
    }

    /// Which joints were seen to follow their motors.
    pub fn joints_seen(&self) -> [bool; JOINTS] {
        self.signs.seen()
    }
}

impl<const JOINTS: usize> Guarded<JOINTS> {
    /// Whether a motor is so warm that it is given less than full scale.
    pub fn folds(&self, state: &GuardState<JOINTS>) -> bool {
        self.heat.iter().zip(&state.windings).any(|(model, winding)| model.folds(winding.heat))
    }

    /// The smallest share of full scale that a motor may be given.
    fn bound(&self, state: &GuardState<JOINTS>) -> f32 {
        let bounds = self.heat.iter().zip(&state.windings).map(|(model, winding)| model.bound(winding.heat));
        bounds.fold(1.0, |least, bound| if bound < least { bound } else { least })
    }

    /// # Errors
    /// The number that is refused.
    pub(in crate::servo) const fn try_new(
        protection: Protection<JOINTS>,
        motors: &[Motor; JOINTS],
        encoders: &[Encoder; JOINTS],
        dry_friction: [f32; JOINTS],
        rate: f32,
        wall: &Penalty,
        max_depth: f32,
    ) -> Result<Self, ProtectionError> {
        if let Err(error) = check(&protection, rate) {
            return Err(error);
        }
        let mut heat = [HeatModel::new(protection.motors[0], motors[0], rate, JOINTS); JOINTS];
        let mut joint = 1;
        while joint < JOINTS {
            heat[joint] = HeatModel::new(protection.motors[joint], motors[joint], rate, JOINTS);
            joint += 1;
        }
        Ok(Self {
            heat,
            max_joint_rates: protection.max_joint_rates_rad_per_s,
            max_squared_speed: protection.max_probe_speed_m_per_s * protection.max_probe_speed_m_per_s,
            supply: match protection.supply {
                Some(range) => Some(SupplyWatch::new(range, rate)),
                None => None,
            },
            signs: match protection.polarity {
                Some(watch) => Some(Polarities::new(&watch, encoders, dry_friction, rate, wall.max_force_n)),
                None => None,
            },
            release: ReleaseWatch::new(wall, max_depth, rate),
            inertia: match protection.polarity {
                Some(watch) => watch.inertia_kg_m2,
                None => [0.0; JOINTS],
            },
        })
    }
}

impl<const JOINTS: usize> Guard<JOINTS> for Guarded<JOINTS> {
    type State = GuardState<JOINTS>;

    fn of_joints(
        mut self,
        motors: &[Motor; JOINTS],
        encoders: &[Encoder; JOINTS],
        dry_friction: &[f32; JOINTS],
    ) -> Self {
        for (heat, motor) in self.heat.iter_mut().zip(motors) {
            *heat = heat.of_motor(*motor);
        }
        self.signs = self.signs.map(|signs| signs.of_joints(encoders, *dry_friction));
        self
    }

    fn of_wall(mut self, wall: &Penalty, max_depth_m: f32) -> Self {
        self.signs = self.signs.map(|signs| signs.of_max_force(wall.max_force_n));
        self.release = self.release.of_wall(wall, max_depth_m);
        self
    }

    fn continuous(&self) -> [f32; JOINTS] {
        self.heat.map(|model| model.continuous())
    }

    fn start(&self) -> GuardState<JOINTS> {
        let windings = self.heat.map(|model| model.start());
        GuardState { turn: 0, windings, supply_age: 0, signs: PolarityState::START, release: ReleaseState::default() }
    }

    fn measured(&self, state: &mut GuardState<JOINTS>, millivolts: u32) -> Result<(), Fault> {
        self.supply.map_or(Ok(()), |supply| supply.measured(&mut state.supply_age, millivolts))
    }

    #[inline]
    fn watch(&self, state: &mut GuardState<JOINTS>) -> Result<(), Fault> {
        self.supply.as_ref().map_or(Ok(()), |supply| supply.tick(&mut state.supply_age))
    }

    #[inline]
    fn force_fraction(&self, state: &GuardState<JOINTS>) -> f32 {
        if self.signs.is_some() { state.signs.share() } else { 1.0 }
    }

    #[inline]
    fn withholds_force(&self, state: &GuardState<JOINTS>) -> bool {
        state.signs.is_on_trial()
    }

    #[inline(always)]
    fn limit(
        &self,
        state: &mut GuardState<JOINTS>,
        moving: &Motion<'_, JOINTS>,
        force: &mut Vec3,
        felt: &mut [f32; JOINTS],
    ) -> Result<(), Fault> {
        if let Some(signs) = &self.signs {
            signs.look(&mut state.signs, moving, force, felt)?;
        }
        // In free air a hand may be as fast as it likes.
        if !state.release.follow(&self.release, *force, moving) {
            return Ok(());
        }
        let turn = state.turn;
        let (Some(rate), Some(most)) = (moving.rates.get(turn), self.max_joint_rates.get(turn)) else { return Ok(()) };
        let is_fast = moving.velocity.length_squared() > self.max_squared_speed || rate.abs() > *most;
        let is_released = self.release.may_be_released(&state.release)
            && self.release.is_released(&state.release, self.bound(state), &self.inertia, moving);
        if is_fast || is_released {
            return Err(Fault::Overspeed);
        }
        Ok(())
    }

    #[inline]
    fn force_not_requested(&self, state: &mut GuardState<JOINTS>) {
        state.signs.end();
        state.release = ReleaseState::default();
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
        gate_within(drives, motors, felt, weight, state.limits())
    }

    #[inline]
    fn record_output(&self, state: &mut GuardState<JOINTS>, duties: &[Duty; JOINTS]) {
        for (winding, Duty(duty)) in state.windings.iter_mut().zip(duties) {
            let duty = i32::from(*duty);
            // Three squares of 32,767 at most.
            winding.squares = winding.squares.wrapping_add((duty * duty) as u32);
        }
        let turn = state.turn;
        state.turn = if turn + 1 < JOINTS { turn + 1 } else { 0 };
        let (Some(winding), Some(model)) = (state.windings.get_mut(turn), self.heat.get(turn)) else { return };
        winding.heat = model.next(winding.heat, winding.squares / JOINTS as u32);
        winding.squares = 0;
        winding.limit = model.limit(winding.heat);
    }
}

impl<const JOINTS: usize> Remembered for GuardState<JOINTS> {
    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for Winding { heat: Heat(heat), squares, limit } in self.windings {
            [heat as u32, squares, limit.to_bits()].into_iter().for_each(&mut take);
        }
        take(self.supply_age << 2 | self.turn as u32);
        take(self.release.work.to_bits());
        take(self.release.ticks.into());
        self.signs.for_each_word(take);
    }
}

/// Seconds for which a measurement of the supply holds.
const FRESH: f32 = 0.1;

/// The range as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupplyWatch {
    range: SupplyRange,
    fresh_ticks: u32,
}

impl SupplyWatch {
    pub(super) const fn new(range: SupplyRange, rate: f32) -> Self {
        Self { range, fresh_ticks: (FRESH * rate) as u32 }
    }

    /// A measurement: the fault if it is outside of the range. `age` counts ticks since the last one.
    pub(super) fn measured(&self, age: &mut u32, millivolts: u32) -> Result<(), Fault> {
        *age = 0;
        let good = self.range.min_mv <= millivolts && millivolts <= self.range.max_mv;
        if good { Ok(()) } else { Err(Fault::Supply) }
    }

    /// A tick: the fault if the last measurement is too old.
    #[inline]
    pub(super) fn tick(&self, age: &mut u32) -> Result<(), Fault> {
        // A latched fault may last for days.
        *age = age.saturating_add(1);
        if *age > self.fresh_ticks { Err(Fault::Supply) } else { Ok(()) }
    }
}

/// Which number is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ProtectionError {
    /// A motor's continuous torque is not above zero, or not finite.
    Continuous,
    /// A motor's time constant is below 100 or above 2,400,000 ticks, above ten minutes, or not a number.
    TimeConstant,
    /// A speed is not above zero, of the probe above 10 m/s, or of a joint above 500 rad/s.
    Speed,
    /// The supply's range holds nothing.
    Supply,
    /// An inertia is not positive and finite.
    Inertia,
}

impl ProtectionError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Continuous => "a motor's continuous torque must be a positive share of full duty",
            Self::TimeConstant => {
                "a winding's time constant must be between 100 and 2,400,000 ticks, and at most ten minutes"
            }
            Self::Speed => {
                "the maximum speeds must be positive, of the probe at most 10 m/s, of a joint at most 500 rad/s"
            }
            Self::Supply => "the supply's minimum voltage must be below its maximum",
            Self::Inertia => "the joints' inertias must be positive and finite",
        }
    }
}

crate::message::display!(ProtectionError);

/// Ten minutes at 4 kHz. Each turn rounds the heat down, so that it stays below its end by this number over the joints:
/// up to 0.08 % of the square of full duty. A shorter constant is safe.
const MAX_CONSTANT_TICKS: f32 = 2.4e6;

/// No hand is as fast: a larger number is one of mm/s, or of rpm.
const MAX_PROBE_SPEED_M_PER_S: f32 = 10.0;
const MAX_JOINT_RATE_RAD_PER_S: f32 = 500.0;

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
        let ticks = motor.time_constant_s * rate;
        let lasts = ticks >= 100.0 && ticks <= MAX_CONSTANT_TICKS && motor.time_constant_s <= 600.0;
        if !lasts {
            return Err(ProtectionError::TimeConstant);
        }
        let rate = protection.max_joint_rates_rad_per_s[joint];
        let is_rate = rate > 0.0 && rate <= MAX_JOINT_RATE_RAD_PER_S;
        if !is_rate {
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
    let speed = protection.max_probe_speed_m_per_s;
    let is_speed = speed > 0.0 && speed <= MAX_PROBE_SPEED_M_PER_S;
    if !is_speed {
        return Err(ProtectionError::Speed);
    }
    if let Some(SupplyRange { min_mv: least, max_mv: most }) = protection.supply
        && least >= most
    {
        return Err(ProtectionError::Supply);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::WOODEN_HAPTICS_2016_PROTECTION as PROTECTION;

    #[test]
    fn a_time_constant_of_too_many_ticks_is_refused_for_its_heat_would_be_rounded_away() {
        let checked = |seconds, rate| {
            let mut protection = PROTECTION;
            protection.motors[1].time_constant_s = seconds;
            check(&protection, rate)
        };
        assert_eq!((checked(600.0, 4_000.0), checked(60.0, 40_000.0)), (Ok(()), Ok(())));
        assert_eq!(checked(61.0, 40_000.0), Err(ProtectionError::TimeConstant));
    }
}
