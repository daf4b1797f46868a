//! A joint that searches its end stop: slowly, gently, and with a result only if it could first move away from it.

use super::Refusal;
use crate::device::{Counts, Encoder};
use crate::math::saturate;

/// How a joint finds its end stop. It moves away by the clearance first, for a joint that does not come off has not
/// found a stop but is jammed; then towards the stop until it stands still under full torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopSearch {
    /// Joint angle at the stop, radians.
    pub angle_rad: f32,
    /// Speed towards the stop, rad/s; its sign is the way. Beyond four times this the search is refused.
    pub speed_rad_per_s: f32,
    /// Maximum torque, N·m: above dry friction and the links' weight, below a force that hurts.
    pub torque_n_m: f32,
    /// How far it moves away first, radians. Make it all of the way to the other stop, less a little, to prove that
    /// nothing is in between.
    pub clearance_rad: f32,
    /// Maximum distance of the stop from there, radians: a joint that travels further is refused.
    pub travel_rad: f32,
}

/// Seconds in which the torque grows to its limit where the joint does not move.
const RAMP: f32 = 0.15;
/// Fraction of the maximum torque that a joint at rest gets at once.
const AT_ONCE: f32 = 0.2;
/// How far a joint may be moved against the way it is driven, radians: less is the sag of an arm that is not held yet.
const ASTRAY: f32 = 0.1;
/// Maximum speed of a joint, as a multiple of the requested one.
const HASTE: f32 = 4.0;

/// The state of a search, from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Search {
    /// The counts at which this stage started.
    from: Option<Counts>,
    /// Whether it came off.
    cleared: bool,
    /// Where it stands still, and for how many ticks.
    anchor: Counts,
    still: u32,
    /// The torque that has grown, N·m.
    grown: f32,
}

impl Search {
    /// The same stage, from wherever the joint is now.
    pub fn again(self) -> Self {
        Self { cleared: self.cleared, ..Self::default() }
    }
}

/// The result of one tick.
pub(super) enum Seek {
    /// Go on with this torque, N·m.
    Drive(f32),
    /// The stop is at this count.
    Found(Counts),
    Refused(Refusal),
}

/// The search's input of a tick: its joint.
pub(super) struct Joint {
    pub encoder: Encoder,
    pub counts: Counts,
    /// rad/s.
    pub rate: f32,
    /// s.
    pub period: f32,
}

impl StopSearch {
    pub(super) const fn is_valid(&self) -> bool {
        let finite = self.angle_rad.is_finite() && self.speed_rad_per_s.is_finite() && self.torque_n_m.is_finite();
        // A way without an end would be searched until the time is over.
        let ends = self.clearance_rad.is_finite() && self.travel_rad.is_finite();
        finite
            && ends
            && self.speed_rad_per_s != 0.0
            && self.torque_n_m > 0.0
            && self.clearance_rad > 0.0
            && self.travel_rad > 0.0
    }

    /// One tick. Still is: within `still_counts` of one reading for `still_ticks` ticks under full torque.
    pub(super) fn step(&self, search: &mut Search, joint: &Joint, still_ticks: u32, still_counts: u32) -> Seek {
        let Joint { encoder, counts, rate, period } = *joint;
        let Some(from) = search.from else {
            (search.from, search.anchor) = (Some(counts), counts);
            return Seek::Drive(0.0);
        };
        let wanted = if search.cleared { self.speed_rad_per_s } else { -self.speed_rad_per_s };
        let forward = if wanted > 0.0 { 1.0 } else { -1.0 };
        let moved = counts.0.wrapping_sub(from.0) as f32 * encoder.radians_per_count * forward;
        if moved < -ASTRAY || rate * forward < -HASTE * self.speed_rad_per_s.abs() {
            return Seek::Refused(Refusal::WrongDirection);
        }
        if rate.abs() > HASTE * self.speed_rad_per_s.abs() {
            return Seek::Refused(Refusal::TooFast);
        }
        if search.cleared && moved > self.travel_rad {
            return Seek::Refused(Refusal::NoStop);
        }
        if !search.cleared && moved >= self.clearance_rad {
            *search = Search { from: Some(counts), cleared: true, anchor: counts, ..Search::default() };
            return Seek::Drive(0.0);
        }

        // Full torque at rest in RAMP seconds; a joint at the requested speed gets the torque that keeps it.
        let share = (wanted - rate) / self.speed_rad_per_s.abs();
        search.grown =
            saturate(search.grown + share * self.torque_n_m * (period / RAMP), -self.torque_n_m, self.torque_n_m);
        let presses = search.grown * forward >= 0.99 * self.torque_n_m;
        if presses && counts.0.abs_diff(search.anchor.0) <= still_counts {
            search.still = search.still.saturating_add(1);
        } else {
            (search.anchor, search.still) = (counts, 0);
        }
        if search.still >= still_ticks {
            return if search.cleared { Seek::Found(counts) } else { Seek::Refused(Refusal::Jammed) };
        }
        Seek::Drive(saturate(search.grown + share * self.torque_n_m * AT_ONCE, -self.torque_n_m, self.torque_n_m))
    }

    /// Every bit of the state.
    pub(super) fn bits(search: &Search) -> [u32; 5] {
        let Search { from, cleared, anchor, still, grown } = *search;
        let (begun, from) = from.map_or((0, 0), |Counts(from)| (1, from));
        [begun | u32::from(cleared) << 1, from as u32, anchor.0 as u32, still, grown.to_bits()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: StopSearch =
        StopSearch { angle_rad: 0.5, speed_rad_per_s: 1.0, torque_n_m: 0.2, clearance_rad: 0.1, travel_rad: 1.0 };

    /// Steps a joint that is said to be at these counts, mrad, at these rates, rad/s; gives what ended it, and the
    /// tick.
    fn ends(place: impl Fn(i32) -> i32, rate: impl Fn(i32) -> f32) -> Option<(i32, Result<i32, Refusal>)> {
        let mut search = Search::default();
        (0..5_000).find_map(|tick| {
            let joint = Joint {
                encoder: Encoder { radians_per_count: 1e-3, angle_at_zero_rad: 9.0 },
                counts: Counts(place(tick)),
                rate: rate(tick),
                period: 1e-3,
            };
            match SEARCH.step(&mut search, &joint, 100, 1) {
                Seek::Drive(torque) => {
                    assert!(torque.abs() <= SEARCH.torque_n_m, "{torque}");
                    None
                }
                Seek::Found(Counts(count)) => Some((tick, Ok(count))),
                Seek::Refused(refusal) => Some((tick, Err(refusal))),
            }
        })
    }

    #[test]
    fn a_stop_is_found_where_the_joint_stands_under_full_torque() {
        // 101 mrad back, then forward to a stop at 300.
        let found = ends(
            |tick| if tick < 101 { -tick } else { (tick - 202).min(300) },
            |tick| {
                if tick < 101 {
                    -1.0
                } else if tick < 502 {
                    1.0
                } else {
                    0.0
                }
            },
        );
        // At rest from tick 502 on: full torque after 150 more, and still for 100.
        assert!(matches!(found, Some((740..=770, Ok(300)))), "{found:?}");
    }

    #[test]
    fn what_cannot_be_believed_is_refused() {
        let refusal = |place: fn(i32) -> i32, rate: f32| ends(place, |_| rate).map(|(_, end)| end.unwrap_err());
        assert_eq!(refusal(|_| 7, 0.0), Some(Refusal::Jammed));
        // Away is down: it goes up, or is said to go up.
        assert_eq!(refusal(|tick| tick, 1.0), Some(Refusal::WrongDirection));
        assert_eq!(refusal(|_| 0, 4.1), Some(Refusal::WrongDirection));
        // Down, and faster than four times as fast.
        assert_eq!(refusal(|_| 0, -4.1), Some(Refusal::TooFast));
        let no_stop =
            ends(|tick| if tick < 101 { -tick } else { tick - 202 }, |tick| if tick < 101 { -1.0 } else { 1.0 });
        assert_eq!(no_stop.map(|(_, end)| end), Some(Err(Refusal::NoStop)));
    }

    #[test]
    fn a_search_without_an_end_is_none() {
        assert!(SEARCH.is_valid());
        for endless in [f32::INFINITY, f32::NAN] {
            assert!(!StopSearch { clearance_rad: endless, ..SEARCH }.is_valid());
            assert!(!StopSearch { travel_rad: endless, ..SEARCH }.is_valid());
        }
    }
}
