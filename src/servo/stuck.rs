//! Whether a sensor is stuck.

use super::StuckLimits;
use crate::device::Counts;

/// What the watch over stuck sensors remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stillness<const JOINTS: usize> {
    /// The joint whose turn it is.
    pub turn: u32,
    /// The count of each joint when it was last seen to move, or to carry no load.
    pub counts: [Counts; JOINTS],
    /// The angles of all joints then, radians.
    pub since: [[f32; JOINTS]; JOINTS],
}

impl<const JOINTS: usize> Stillness<JOINTS> {
    /// Before the first tick.
    pub const START: Self = Self { turn: 0, counts: [Counts(0); JOINTS], since: [[0.0; JOINTS]; JOINTS] };

    /// Looks at the next joint, one a tick: whether it has not moved by a count under load while another moved far.
    ///
    /// `felt` is the torque on each joint of the force that the hand feels, N·m, without what carries the links, which
    /// their weight balances; `friction` is each joint's dry friction. A joint whose friction is not known is not
    /// watched.
    #[inline]
    pub(super) fn is_broken(
        &mut self,
        limits: StuckLimits,
        friction: &[f32; JOINTS],
        counts: &[Counts; JOINTS],
        angles: &[f32; JOINTS],
        felt: &[f32; JOINTS],
    ) -> bool {
        let joint = if (self.turn as usize) < JOINTS { self.turn as usize } else { 0 };
        self.turn = joint as u32 + 1;
        let bears = || felt[joint].abs() > limits.load * friction[joint] && friction[joint] > 0.0;
        if counts[joint] == self.counts[joint] && bears() {
            return angles
                .iter()
                .zip(self.since[joint])
                .any(|(angle, since)| (angle - since).abs() > limits.travel_rad);
        }
        self.counts[joint] = counts[joint];
        self.since[joint] = *angles;
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: StuckLimits = StuckLimits { load: 2.0, travel_rad: 0.2 };

    /// The tick at which it is found, the second joint moving by 0.001 rad a tick and the first as told.
    fn found(first: impl Fn(u32) -> i32, felt: f32, friction: f32) -> Option<u32> {
        let mut stillness = Stillness::<2>::START;
        (1..1_000).find(|tick| {
            let counts = [Counts(first(*tick)), Counts(*tick as i32)];
            let angles = counts.map(|count| count.0 as f32 * 0.001);
            stillness.is_broken(LIMITS, &[friction; 2], &counts, &angles, &[felt; 2])
        })
    }

    #[test]
    fn a_joint_that_stands_still_under_load_while_another_moves_is_stuck() {
        // Seen first at the first tick, and every second one.
        assert!(matches!(found(|_| 500, -0.3, 0.1), Some(201..=204)));
        assert_eq!(found(|_| 500, 0.19, 0.1), None, "what friction holds may rest");
        assert_eq!(found(|_| 500, 0.3, 0.0), None, "friction that is not known may hold anything");
        assert_eq!(
            found(|tick| if tick % 150 < 75 { 500 } else { 501 }, 0.3, 0.1),
            None,
            "a count now and then is life"
        );
    }
}
