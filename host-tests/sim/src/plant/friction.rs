//! Dry friction that can hold: at each joint it is as large as it must be to stop the joint, and at most its limit.

use super::vector::{Matrix, Vector, dot};

/// Sweeps over the joints at most. Each shrinks the error by the square of the coupling of two joints, below ½ for this
/// arm: 50 sweeps reach rounding.
const SWEEPS: usize = 50;

/// The friction torques, N·m, that minimise the motion at the end of a step.
///
/// `rates` are the joint rates at the step's end without dry friction, rad/s, and `mobility` is the step, s, times the
/// inverse mass matrix: friction torques `f` change the rates to `rates + mobility f`. Each `|f| ≤ limit`; a joint with
/// a smaller `|f|` comes to rest, at the limit friction opposes the motion. (A linear complementarity problem, solved
/// joint by joint; after J. J. Moreau's time stepping.)
pub fn dry_friction(rates: Vector, mobility: &Matrix, limits: Vector) -> Vector {
    let mut torques = [0.0; 3];
    for _ in 0..SWEEPS {
        let before = torques;
        for joint in 0..3 {
            let rate = rates[joint] + dot(mobility[joint], torques);
            let stopping = torques[joint] - rate / mobility[joint][joint];
            torques[joint] = stopping.clamp(-limits[joint], limits[joint]);
        }
        if torques == before {
            break;
        }
    }
    torques
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::vector::{add_scaled, times};

    const MOBILITY: Matrix = [[2.0, 0.3, -0.2], [0.3, 3.0, 1.4], [-0.2, 1.4, 2.5]];

    #[test]
    fn every_joint_rests_below_the_limit_or_slides_against_it() {
        let limits = [0.4, 0.3, 0.2];
        let (mut resting, mut sliding) = (0, 0);
        for n in 0..1_000 {
            let rates = [n % 10, n / 10 % 10, n / 100].map(|index| 0.4 * f64::from(index) - 1.8);
            let torques = dry_friction(rates, &MOBILITY, limits);
            let after = add_scaled(rates, times(&MOBILITY, torques), 1.0);
            for joint in 0..3 {
                if torques[joint].abs() < limits[joint] {
                    // Coupling² = 1.4²/(3 × 2.5) = 0.26 a sweep: rounding is reached in 28 sweeps.
                    assert!(after[joint].abs() < 1e-14, "{rates:?} {after:?}");
                    resting += 1;
                } else {
                    assert!(after[joint] * torques[joint] <= 0.0, "{rates:?} {after:?}");
                    sliding += 1;
                }
            }
        }
        assert!(resting > 300 && sliding > 300, "{resting} {sliding}");
    }
}
