//! Whether a joint moves the way its motor pushes.
//!
//! An encoder that counts against its motor makes of every wall a slope: the force grows with the depth and pulls
//! further in. What a hand does cannot tell the two apart, for it pushes either way; what the force *changes* can.
//! While a torque `u` acts on a joint of inertia `I`, its rate changes by `u/I` and by what the hand does. Summed over
//! the first moments of a contact, `n = Σ u·Δq̇` is the power by which the motors speed the device up, and `d = Σ
//! u²/I·Δt` what it would be if they were alone: `n/d` is 1 less the hand's share for a good sign, and −1 less it for a
//! wrong one.
//!
//! Each contact that begins in free air is judged as soon as `d` reaches [`ENOUGH`] and the verdict is clear, and by
//! [`MORE`] in any case: a hand that presses evenly leaves `n` at zero. Until a joint has come through [`TRIALS`] of
//! them it is on trial, and the force no more than a quarter of the greatest one, as far as it loads this joint; a
//! joint that the force hardly loads stays on trial. What a contact has shown counts from its end on, so that no limit
//! is lifted while something is felt.

use super::Moving;
use crate::device::SignWatch;
use crate::math::sqrt;
use crate::render::Penalty;
use crate::servo::Fault;

/// `d` at which a contact is judged, W: 1 N that alone changes the probe's speed by 50 mm/s. Less would be the noise of
/// the encoders' counts, more would be felt.
const ENOUGH: f32 = 0.05;
/// `d` by which a contact is judged, W.
const MORE: f32 = 2.5 * ENOUGH;
/// `n/d` above which a sign is good without waiting for more.
const GOOD: f32 = 0.2;
/// `n/d` below which a sign is wrong. `cargo test a_wrong_sign` prints what wrong and good ones come to.
const WRONG: f32 = -0.42;
/// Contacts that a joint has to come through.
const TRIALS: u8 = 2;
/// The share of `d` that a joint must have to be judged with it.
const PART: f32 = 0.2;
/// The share of the greatest force that a joint on trial bears.
const ON_TRIAL: f32 = 0.25;

/// The watch as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signs<const JOINTS: usize> {
    /// A period over each inertia, s/(kg·m²).
    mobility: [f32; JOINTS],
    /// The square of the force that a joint on trial bears, N².
    squared_trial: f32,
}

/// How far the contact at hand has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trial {
    /// There is none.
    FreeAir,
    /// It is being watched.
    Watched,
    /// It has been judged.
    Judged,
    /// Every joint has come through: nothing is watched any more.
    Over,
}

/// What the watch remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SignState<const JOINTS: usize> {
    trial: Trial,
    /// Contacts that each joint came through.
    passed: [u8; JOINTS],
    /// Which joints have come through this one.
    passes: [bool; JOINTS],
    /// `2 n` so far, W.
    change: f32,
    /// `4 d` so far of each joint, W.
    alone: [f32; JOINTS],
    /// The torques of the tick before, N·m.
    torques: [f32; JOINTS],
    /// The rates of the tick before, rad/s.
    rates: [f32; JOINTS],
}

impl<const JOINTS: usize> SignState<JOINTS> {
    pub(super) const START: Self = Self {
        trial: Trial::FreeAir,
        passed: [0; JOINTS],
        passes: [false; JOINTS],
        change: 0.0,
        alone: [0.0; JOINTS],
        torques: [0.0; JOINTS],
        rates: [0.0; JOINTS],
    };

    /// Whether a contact is on trial that has not been judged.
    #[inline]
    pub(super) fn is_busy(&self) -> bool {
        self.trial == Trial::Watched
    }

    /// How many contacts each joint has come through.
    pub(super) const fn passed(&self) -> [u8; JOINTS] {
        self.passed
    }

    pub(super) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for (passed, passes) in self.passed.into_iter().zip(self.passes) {
            take(u32::from(passed) | u32::from(passes) << 8 | (self.trial as u32) << 9);
        }
        for floats in [self.alone, self.torques, self.rates] {
            floats.into_iter().for_each(|float| take(float.to_bits()));
        }
        take(self.change.to_bits());
    }
}

impl<const JOINTS: usize> Signs<JOINTS> {
    pub(super) const fn new(watch: &SignWatch<JOINTS>, rate: f32, penalty: &Penalty) -> Self {
        let mut mobility = watch.inertia;
        let mut joint = 0;
        while joint < JOINTS {
            mobility[joint] = 1.0 / (rate * watch.inertia[joint]);
            joint += 1;
        }
        let trial = ON_TRIAL * penalty.max_force;
        Self { mobility, squared_trial: trial * trial }
    }

    /// Looks at a tick in which force is given. The share of it that may be felt: less than 1 on trial.
    #[inline]
    pub(super) fn look(&self, state: &mut SignState<JOINTS>, moving: &Moving<'_, JOINTS>) -> Result<f32, Fault> {
        if state.trial == Trial::Over {
            return Ok(1.0);
        }
        let squared = moving.force.length_squared();
        if squared <= 0.0 {
            if state.trial != Trial::FreeAir {
                end(state);
            }
            state.rates = *moving.rates;
            return Ok(1.0);
        }
        let share = if squared <= self.squared_trial { 1.0 } else { self.bound(&state.passed, moving) };
        if state.trial == Trial::FreeAir {
            state.trial = Trial::Watched;
        }
        let (mut change, mut all) = (0.0, 0.0);
        for joint in 0..JOINTS {
            // The sum of the torques at both ends of the tick: what a damper makes of the noise of the rates then sums
            // up to next to nothing, for it is the difference of two squares.
            let (torque, rate) = (moving.felt[joint] * share, moving.rates[joint]);
            let twice = state.torques[joint] + torque;
            change += twice * (rate - state.rates[joint]);
            state.alone[joint] += twice * twice * self.mobility[joint];
            all += state.alone[joint];
            (state.torques[joint], state.rates[joint]) = (torque, rate);
        }
        state.change += change;
        if state.trial == Trial::Watched && all >= 4.0 * ENOUGH {
            judge(state, all)?;
        }
        Ok(share)
    }

    /// The share of the force that joints on trial bear: a quarter of the greatest force, or more where it loads them
    /// by less than a third of what it could.
    #[cold]
    fn bound(&self, passed: &[u8; JOINTS], moving: &Moving<'_, JOINTS>) -> f32 {
        let mut squared_share = 1.0;
        let quarter = self.squared_trial / moving.force.length_squared();
        for ((passed, felt), column) in passed.iter().zip(moving.felt).zip(&moving.pose.jacobian) {
            let squared = felt * felt;
            let third = (1.0 / 9.0) * self.squared_trial * column.length_squared();
            if *passed < TRIALS && squared * squared_share > third && squared_share > quarter {
                let by_torque = third / squared;
                squared_share = if by_torque > quarter { by_torque } else { quarter };
            }
        }
        sqrt(squared_share)
    }
}

/// A contact is over: what it has shown counts.
#[cold]
fn end<const JOINTS: usize>(state: &mut SignState<JOINTS>) {
    let mut passed = state.passed;
    for (passed, passes) in passed.iter_mut().zip(state.passes) {
        *passed += u8::from(passes && *passed < TRIALS);
    }
    *state = SignState { passed, ..SignState::START };
    if passed.iter().all(|passed| *passed >= TRIALS) {
        state.trial = Trial::Over;
    }
}

/// Judges a contact that has shown enough; `all` is `4 d`.
#[cold]
fn judge<const JOINTS: usize>(state: &mut SignState<JOINTS>, all: f32) -> Result<(), Fault> {
    let ratio = 2.0 * state.change / all;
    if ratio < WRONG {
        return Err(Fault::WrongSign);
    }
    if ratio < GOOD && all < 4.0 * MORE {
        return Ok(());
    }
    state.trial = Trial::Judged;
    for (passes, alone) in state.passes.iter_mut().zip(state.alone) {
        *passes = alone >= PART * all;
    }
    Ok(())
}
