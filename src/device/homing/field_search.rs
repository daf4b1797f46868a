//! A motor with three phases that measures its rotor's alignment to its field: the field turns, slowly and gently, and
//! the rotor follows.

use super::Refusal;
use crate::device::{Aligned, Commutation, Counts, ElectricalAngle};

/// How a motor's field turns in the search.
///
/// The field rises within `ramp_ticks` and turns once, which catches the rotor wherever it was. Then it turns by
/// `turns` electrical turns, there and back; the rotor's mean lag behind the field over both ways is the alignment.
/// Friction holds the rotor back as much on the way there as on the way back, and cogging over whole electrical turns
/// pulls it ahead as much as back: both leave the average.
///
/// It is refused unless the rotor has gone as far as its field, there and back, and was never more than a sixth of an
/// electrical turn away from the average: another number of pole pairs, a phase without current, a sensor that does
/// not move or slips, and a hand that holds the dial all show there. Torque, time and way are bounded by construction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSearch {
    /// How the counts go with the poles.
    pub commutation: Commutation,
    /// Torque of the field on a rotor a quarter turn behind it, N·m: well above dry friction and cogging.
    pub torque_n_m: f32,
    /// Ticks in which the field rises.
    pub ramp_ticks: u32,
    /// Ticks of an electrical turn.
    pub turn_ticks: u32,
    /// Electrical turns that are measured, there and back: 1, or all of a turn of the motor to record its cogging.
    pub turns: u16,
}

/// How far the rotor may be from where it is on average, in 65,536ths of an electrical turn: a sixth.
const ASTRAY: i32 = 65_536 / 6;
/// Tolerance of the rotor's turn against its field's, as a fraction: cogging at both ends. It still detects an error of
/// one pole pair in up to 14.
const INEXACT: f32 = 0.07;
/// How much less it may turn on the way back: it turns only once the field has pulled friction the other way.
const HELD_BACK: f32 = 0.3;

/// The state of a search, from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sweep {
    /// Ticks done.
    ticks: u32,
    /// The counts at which the field should catch the rotor, and later those at which the measured travel started.
    began: Counts,
    /// Where it turned back.
    turned: Counts,
    /// The way that the counts go, and the rotor's angle at the first tick that is measured.
    first: Aligned,
    /// The mean of how far it was from that, 65,536ths of an electrical turn, over the ticks so far.
    mean: f32,
}

/// The result of one tick.
pub(super) enum Led {
    /// Go on with this torque, N·m, at the field of the state.
    Drive(f32),
    Found(Aligned),
    Refused(Refusal),
}

impl FieldSearch {
    pub(super) const fn is_valid(&self) -> bool {
        let finite = self.torque_n_m > 0.0 && self.torque_n_m < f32::INFINITY;
        let timed = self.ramp_ticks > 0 && self.turn_ticks >= 64 && self.turns > 0;
        // So that ticks do not leave their bits.
        finite
            && timed
            && self.ramp_ticks <= 1 << 20
            && self.turn_ticks <= 1 << 20
            && self.turns <= 1 << 8
            && self.commutation.is_valid()
    }

    /// Ticks until it is done.
    pub const fn ticks(&self) -> u32 {
        self.ramp_ticks.saturating_add(self.turn_ticks.saturating_mul(1 + 2 * self.turns as u32))
    }

    /// The field's angle at a tick, its amplitude so far, 0 to 1, and whether the rotor is measured in that tick. A
    /// recording of the cogging needs these besides the counts.
    pub fn plan(&self, tick: u32) -> (ElectricalAngle, f32, bool) {
        let turn = if self.turn_ticks == 0 { 1 } else { self.turn_ticks };
        let Some(led) = tick.checked_sub(self.ramp_ticks) else {
            return (ElectricalAngle(0), tick as f32 / self.ramp_ticks as f32, false);
        };
        let there = turn.saturating_mul(1 + u32::from(self.turns));
        // There, and from its end back.
        let along = if led < there { led } else { there.saturating_sub(led - there) };
        // The remainder of a turn, below 2²⁰, times 2¹⁶ in 64 bits.
        let angle = ((u64::from(along % turn) << 16) / u64::from(turn)) as u16;
        (ElectricalAngle(angle), 1.0, led >= turn)
    }

    /// One tick.
    pub(super) fn step(&self, sweep: &mut Sweep, counts: Counts) -> Led {
        let tick = sweep.ticks;
        sweep.ticks = tick.saturating_add(1);
        let (_, share, measured) = self.plan(tick);
        if tick == self.ramp_ticks {
            sweep.began = counts;
        }
        if measured {
            // The rotor now follows the field of the tick before.
            if let Some(refusal) = self.measure(sweep, counts, tick) {
                return Led::Refused(refusal);
            }
        }
        if tick >= self.ticks() {
            return self.finish(sweep, counts);
        }
        Led::Drive(self.torque_n_m * share)
    }

    /// Counts that the rotor travels in a number of electrical turns.
    fn counts_of(&self, turns: u16) -> f32 {
        self.commutation.counts_per_turn as f32 / f32::from(self.commutation.pole_pairs) * f32::from(turns)
    }

    fn measure(&self, sweep: &mut Sweep, counts: Counts, tick: u32) -> Option<Refusal> {
        let led = tick - self.ramp_ticks;
        let (ElectricalAngle(followed), ..) = self.plan(tick.saturating_sub(1));
        let unaligned = |reversed| Aligned { at_zero: ElectricalAngle(0), reversed };
        if led == self.turn_ticks {
            let caught = counts.0.wrapping_sub(sweep.began.0);
            // Half a turn of it may have gone the other way, before the field had caught the rotor.
            if (caught as f32).abs() < 0.25 * self.counts_of(1) {
                return Some(Refusal::Jammed);
            }
            let way = unaligned(caught < 0);
            let behind = followed.wrapping_sub(self.commutation.rotor(way, counts).0);
            sweep.first = Aligned { at_zero: ElectricalAngle(behind), ..way };
            sweep.began = counts;
        }
        if led == self.turn_ticks.saturating_mul(1 + u32::from(self.turns)) {
            sweep.turned = counts;
        }
        // How far the field is ahead of the rotor as the first tick had it.
        let ahead = followed.wrapping_sub(self.commutation.rotor(sweep.first, counts).0) as i16;
        if i32::from(ahead).abs() > 2 * ASTRAY {
            return Some(Refusal::NotFollowed);
        }
        // Ticks measured so far, with this one.
        let count = led - self.turn_ticks + 1;
        sweep.mean += (f32::from(ahead) - sweep.mean) / count as f32;
        None
    }

    fn finish(&self, sweep: &Sweep, counts: Counts) -> Led {
        let forward = if sweep.first.reversed { -1.0 } else { 1.0 };
        let wanted = self.counts_of(self.turns);
        let there = sweep.turned.0.wrapping_sub(sweep.began.0) as f32 * forward;
        let back = sweep.turned.0.wrapping_sub(counts.0) as f32 * forward;
        let followed = (there - wanted).abs() <= INEXACT * wanted
            && back <= (1.0 + INEXACT) * wanted
            && back >= (1.0 - HELD_BACK) * wanted;
        if !followed {
            return Led::Refused(Refusal::NotFollowed);
        }
        let is_near = sweep.mean.abs() <= ASTRAY as f32;
        if !is_near {
            return Led::Refused(Refusal::NotFollowed);
        }
        // Through 32 bits, for the cast of a negative number to 16 without a sign would be 0.
        let at_zero = ElectricalAngle(sweep.first.at_zero.0.wrapping_add(sweep.mean as i32 as u16));
        Led::Found(Aligned { at_zero, ..sweep.first })
    }

    /// The field now.
    pub(super) fn field(&self, sweep: &Sweep) -> ElectricalAngle {
        self.plan(sweep.ticks.saturating_sub(1)).0
    }

    /// Every bit of the state, once the search has started.
    pub(super) fn bits(sweep: &Sweep) -> [u32; 5] {
        let Sweep { ticks, began, turned, first, mean } = *sweep;
        [ticks, began.0 as u32, turned.0 as u32, first.mark().0 as u32, mean.to_bits()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: FieldSearch = FieldSearch {
        commutation: Commutation { counts_per_turn: 16_384, pole_pairs: 7 },
        torque_n_m: 0.02,
        ramp_ticks: 100,
        turn_ticks: 1_000,
        turns: 1,
    };

    /// A rotor of so many pole pairs that follows its field with a lag of friction (radians, electrical), once it is
    /// driven at all; gives how it ended, and the tick.
    fn ends(
        pole_pairs: f64,
        zero: f64,
        way: f64,
        lag: f64,
        follows: impl Fn(u32) -> bool,
    ) -> (u32, Result<Aligned, Refusal>) {
        let (mut sweep, mut rotor, mut field, mut unwrapped) = (Sweep::default(), 0.4_f64, 0.0_f64, 0.0_f64);
        for tick in 0..10_000 {
            if follows(tick) {
                rotor = rotor.clamp(unwrapped - lag, unwrapped + lag);
            }
            let turns = way * (rotor - zero) / core::f64::consts::TAU / pole_pairs;
            match SEARCH.step(&mut sweep, Counts((turns * 16_384.0).floor() as i32)) {
                Led::Drive(torque) => {
                    assert!(torque <= SEARCH.torque_n_m);
                    let next = f64::from(SEARCH.field(&sweep).radians());
                    // Unwrapped.
                    unwrapped += (next - field + core::f64::consts::PI).rem_euclid(core::f64::consts::TAU)
                        - core::f64::consts::PI;
                    field = next;
                }
                Led::Found(aligned) => return (tick, Ok(aligned)),
                Led::Refused(refusal) => return (tick, Err(refusal)),
            }
        }
        panic!("it goes on for ever")
    }

    #[test]
    fn a_rotor_that_follows_is_aligned_whatever_its_friction_and_its_way() {
        for way in [1.0, -1.0] {
            for (zero, lag) in [(0.0, 0.0), (1.0, 0.3), (-2.5, 0.7), (3.1, 0.1)] {
                let (tick, end) = ends(7.0, zero, way, lag, |_| true);
                assert_eq!(tick, SEARCH.ticks());
                let aligned = end.unwrap();
                assert_eq!(aligned.reversed, way < 0.0);
                let off = f64::from(aligned.at_zero.radians()) - zero;
                let off = (off + core::f64::consts::PI).rem_euclid(core::f64::consts::TAU) - core::f64::consts::PI;
                // A field of the tick before is 1/1,000 turn, there and back; where the way turns, the lag goes from
                // one side to the other within itself: its mean over both ways is off by lag² / 2π at most.
                assert!(off.abs() < 0.01 + lag * lag / 3.0, "{zero} {lag}: {off}");
            }
        }
    }

    #[test]
    fn what_does_not_follow_its_field_is_refused() {
        assert_eq!(ends(7.0, 0.0, 1.0, 0.1, |_| false).1, Err(Refusal::Jammed));
        // Two more pole pairs, and one less.
        assert_eq!(ends(9.0, 0.0, 1.0, 0.1, |_| true).1, Err(Refusal::NotFollowed));
        assert_eq!(ends(6.0, 0.0, 1.0, 0.1, |_| true).1, Err(Refusal::NotFollowed));
        // Held from half of the way there, and on the way back.
        for held in [1_600, 2_500] {
            let (tick, end) = ends(7.0, 0.0, 1.0, 0.1, |tick| tick < held);
            assert_eq!(end, Err(Refusal::NotFollowed), "{tick}");
        }
    }

    #[test]
    fn numbers_that_make_no_sense_are_told() {
        assert!(SEARCH.is_valid());
        for bad in [
            FieldSearch { torque_n_m: f32::NAN, ..SEARCH },
            FieldSearch { torque_n_m: 0.0, ..SEARCH },
            FieldSearch { ramp_ticks: 0, ..SEARCH },
            FieldSearch { turn_ticks: 10, ..SEARCH },
            FieldSearch { turns: 0, ..SEARCH },
            FieldSearch { commutation: Commutation { counts_per_turn: 100, pole_pairs: 7 }, ..SEARCH },
        ] {
            assert!(!bad.is_valid(), "{bad:?}");
        }
    }
}
