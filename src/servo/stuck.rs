//! Whether a sensor is stuck.

use super::StuckLimits;
use crate::device::Duty;

/// For each joint, the angles of all joints when its count changed last or it carried no load.
pub type Stillness<const JOINTS: usize> = [[f32; JOINTS]; JOINTS];

/// Whether a joint stood still to the count under load while another moved. `before` and `now` are the angles of the
/// last tick and this one, `duties` what was applied between.
#[inline]
pub fn is_stuck<const JOINTS: usize>(
    limits: StuckLimits,
    stillness: &mut Stillness<JOINTS>,
    before: [f32; JOINTS],
    now: [f32; JOINTS],
    duties: [Duty; JOINTS],
) -> bool {
    let mut stuck = false;
    for (((still, before), angle), duty) in stillness.iter_mut().zip(before).zip(now).zip(duties) {
        if before != angle || duty.fraction().abs() < limits.load {
            *still = now;
        } else {
            stuck |= now.iter().zip(*still).any(|(angle, since)| (angle - since).abs() > limits.travel);
        }
    }
    stuck
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: StuckLimits = StuckLimits { load: 0.1, travel: 0.2 };

    /// The tick at which it is found, the second joint moving by 0.001 rad a tick and the first as told.
    fn found(first: impl Fn(u32) -> f32, duty: i16) -> Option<u32> {
        let mut stillness = [[first(0), 0.0]; 2];
        let angles = |tick: u32| [first(tick), tick as f32 * 0.001];
        (1..1_000)
            .find(|tick| is_stuck(LIMITS, &mut stillness, angles(tick - 1), angles(*tick), [Duty(duty), Duty(duty)]))
    }

    #[test]
    fn a_joint_that_stands_still_under_load_while_another_moves_is_stuck() {
        assert!(matches!(found(|_| 0.5, 5_000), Some(200..=202)));
        assert_eq!(found(|_| 0.5, 1_000), None, "without load a joint may rest");
        assert_eq!(
            found(|tick| if tick % 150 < 75 { 0.5 } else { 0.5003 }, 5_000),
            None,
            "a count now and then is life"
        );
    }
}
