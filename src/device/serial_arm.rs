//! The serial three-joint arm of WoodenHaptics and of the Phantom.

use super::{GRAVITY, Kinematics, ProbePose};
use crate::math::{Vec3, sin_cos, vec3};

/// A turntable that carries a parallelogram of two links.
///
/// The frame: x away from the turntable at `a = 0`, z up.
///
/// Joint angles, radians: `a` turns the table about the vertical; `b` tilts the first link from the vertical; `c` tilts
/// the second link down from the horizontal. Both link motors sit on the turntable, so `c` is absolute, not relative
/// to `b`. With `r = B sin b + C cos c`:
/// `x = r cos a`, `y = r sin a`, `z = A + B cos b − C sin c`, less the workspace centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SerialArm {
    /// Height of the first link's axis, `A`, metres.
    pub base_height: f32,
    /// Length of the first link, `B`, metres.
    pub first_link: f32,
    /// Length of the second link, `C`, metres.
    pub second_link: f32,
    /// The centre of the workspace, metres from the foot of the turntable.
    pub workspace_centre: Vec3,
    /// What each link lifts: its mass times the distance of its centre from its axis, and for the first also all that hangs
    /// on its end times its length, kg·m. Negative where it is overbalanced; zero if not known.
    pub mass_moments: [f32; 2],
}

impl Kinematics<3> for SerialArm {
    #[inline]
    fn pose(&self, [a, b, c]: [f32; 3]) -> ProbePose<3> {
        let ((sin_a, cos_a), (sin_b, cos_b), (sin_c, cos_c)) = (sin_cos(a), sin_cos(b), sin_cos(c));
        let (first, second) = (self.first_link, self.second_link);
        let reach = first * sin_b + second * cos_c;
        let height = self.base_height + first * cos_b - second * sin_c;
        // How reach grows with b and with c.
        let (reach_b, reach_c) = (first * cos_b, -second * sin_c);
        ProbePose {
            position: vec3(reach * cos_a, reach * sin_a, height) - self.workspace_centre,
            jacobian: [
                vec3(-reach * sin_a, reach * cos_a, 0.0),
                vec3(reach_b * cos_a, reach_b * sin_a, -first * sin_b),
                vec3(reach_c * cos_a, reach_c * sin_a, -second * cos_c),
            ],
        }
    }

    #[inline]
    fn holding_torques(&self, [_, b, c]: [f32; 3]) -> [f32; 3] {
        // The links' height is `m₁ cos b − m₂ sin c`; the torque that holds it is its slope.
        let [first, second] = self.mass_moments;
        [0.0, -GRAVITY * first * sin_cos(b).0, -GRAVITY * second * sin_cos(c).1]
    }
}
