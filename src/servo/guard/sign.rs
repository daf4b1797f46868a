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
//! [`MORE`] in any case: a hand that presses evenly leaves `n` at zero. Until a joint has come through two of
//! them it is on trial, and the force no more than a quarter of the greatest one, as far as it loads this joint; a
//! joint that the force hardly loads stays on trial. What a contact has shown counts from its end on, so that no limit
//! is lifted while something is felt.
//!
//! The sums take every joint in every tick, for a verdict has no time to lose; which force a joint on trial bears is
//! asked of one joint a tick, in turn, and only once the force is above a quarter: until each had its turn, a quarter
//! is the limit.

use super::Moving;
use crate::device::SignWatch;
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
/// The share of `d` that a joint must have to be judged with it.
const PART: f32 = 0.2;
/// The share of the greatest force that a joint on trial bears.
const ON_TRIAL: f32 = 0.25;
/// The load from which on a joint on trial is loaded, as a share of what so much force could load it with.
const LOADED: f32 = 1.0 / 3.0;

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

/// Some of the joints, a bit each.
type Joints = u8;

/// What the watch remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SignState<const JOINTS: usize> {
    trial: Trial,
    /// Which joints have come through a contact, and which through two.
    passed: [Joints; 2],
    /// Which joints have come through this one.
    passes: Joints,
    /// `2 n` so far, W.
    change: f32,
    /// `4 d` so far of each joint, W.
    alone: [f32; JOINTS],
    /// The torques of the tick before, N·m.
    torques: [f32; JOINTS],
    /// The rates of the tick before, rad/s.
    rates: [f32; JOINTS],
    /// The square of the force that each joint was found to bear in this contact, N².
    squared_limits: [f32; JOINTS],
    /// The share of the force that was felt in the last tick.
    share: f32,
}

impl<const JOINTS: usize> SignState<JOINTS> {
    pub(super) const START: Self = Self {
        trial: Trial::FreeAir,
        passed: [0; 2],
        passes: 0,
        change: 0.0,
        alone: [0.0; JOINTS],
        torques: [0.0; JOINTS],
        rates: [0.0; JOINTS],
        squared_limits: [0.0; JOINTS],
        share: 1.0,
    };

    /// Whether a contact is on trial that has not been judged.
    #[inline]
    pub(super) fn is_busy(&self) -> bool {
        self.trial == Trial::Watched
    }

    /// How many contacts each joint has come through.
    pub(super) fn passed(&self) -> [u8; JOINTS] {
        core::array::from_fn(|joint| self.passed.iter().map(|joints| joints >> joint & 1).sum())
    }

    pub(super) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        let [once, twice] = self.passed;
        take(u32::from(once) | u32::from(twice) << 8 | u32::from(self.passes) << 16 | (self.trial as u32) << 24);
        for floats in [self.alone, self.torques, self.rates, self.squared_limits] {
            floats.into_iter().for_each(|float| take(float.to_bits()));
        }
        [self.change, self.share].into_iter().for_each(|float| take(float.to_bits()));
    }

    /// A contact is over: what it has shown counts.
    #[inline]
    fn end(&mut self) {
        let [once, twice] = &mut self.passed;
        *twice |= *once & self.passes;
        *once |= self.passes;
        self.trial = if *twice == all::<JOINTS>() { Trial::Over } else { Trial::FreeAir };
        (self.passes, self.change, self.share) = (0, 0.0, 1.0);
        (self.alone, self.torques, self.squared_limits) = ([0.0; JOINTS], [0.0; JOINTS], [0.0; JOINTS]);
    }

    /// Judges a contact that has shown enough; `all` is `4 d`.
    #[cold]
    fn judge(&mut self, all: f32) -> Result<(), Fault> {
        let ratio = 2.0 * self.change / all;
        if ratio < WRONG {
            return Err(Fault::WrongSign);
        }
        if ratio < GOOD && all < 4.0 * MORE {
            return Ok(());
        }
        self.trial = Trial::Judged;
        for (joint, alone) in self.alone.iter().enumerate() {
            self.passes |= u8::from(*alone >= PART * all) << joint;
        }
        Ok(())
    }
}

/// All joints.
const fn all<const JOINTS: usize>() -> Joints {
    (1 << JOINTS) - 1
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

    /// Looks at a tick in which force is given. The share of it that may be felt: less than 1 on trial. `turn` is the
    /// joint whose turn it is.
    #[inline(always)]
    pub(super) fn look(
        &self,
        state: &mut SignState<JOINTS>,
        moving: &Moving<'_, JOINTS>,
        turn: usize,
    ) -> Result<f32, Fault> {
        if state.trial == Trial::Over {
            return Ok(1.0);
        }
        let squared = moving.force.length_squared();
        if squared <= 0.0 {
            if state.trial != Trial::FreeAir {
                state.end();
            }
            state.rates = *moving.rates;
            return Ok(1.0);
        }
        if state.trial == Trial::FreeAir {
            state.trial = Trial::Watched;
        }
        let share = if squared <= self.squared_trial { 1.0 } else { self.share(state, moving, squared, turn) };
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
            state.judge(all)?;
        }
        Ok(share)
    }

    /// The share of a force above a quarter of the greatest one that joints on trial bear: that quarter, or more where
    /// it loads them by less than a third of what it could. Which way a force loads a joint hardly changes until its
    /// turn comes round.
    #[inline(always)]
    fn share(&self, state: &mut SignState<JOINTS>, moving: &Moving<'_, JOINTS>, squared: f32, turn: usize) -> f32 {
        let felt = moving.felt.get(turn).zip(moving.pose.jacobian.get(turn));
        if let (Some(limit), Some((felt, column))) = (state.squared_limits.get_mut(turn), felt) {
            let third = LOADED * LOADED * self.squared_trial * column.length_squared();
            // A joint that bears no load divides by zero: no limit.
            *limit = if state.passed[1] >> turn & 1 != 0 { f32::INFINITY } else { third * squared / (felt * felt) };
        }
        let least =
            state.squared_limits.iter().fold(squared, |least, limit| if *limit < least { *limit } else { least });
        let most = if least > self.squared_trial { least } else { self.squared_trial };
        if most >= squared {
            state.share = 1.0;
        } else {
            // √(most/squared) by a step a tick of its own Newton's method, from below: the harmonic mean of two numbers
            // is below the geometric one.
            let (wanted, last) = (most / squared, state.share);
            state.share = 2.0 * wanted * last / (last * last + wanted);
        }
        state.share
    }
}
