//! The serial three-joint arm of WoodenHaptics and of the Phantom.

use super::device_error::{all_of, centre, lengths, offsets, weights};
use super::{DeviceError, GRAVITY, Kinematics, ProbePose};
use crate::math::{Vec3, sin_cos, vec3};

/// A turntable that carries a parallelogram of two links.
///
/// The frame: x away from the turntable at `a = 0`, z up.
///
/// Joint angles, radians: `a` turns the table about the vertical; `b` tilts the first link from the vertical; `c` tilts
/// the second link down from the horizontal. Both link motors sit on the turntable, so `c` is absolute, not relative
/// to `b`. With `r = B sin b + C cos c`:
/// `x = r cos a`, `y = r sin a`, `z = A + B cos b − C sin c`, less the workspace centre.
///
/// ```
/// use palpate::device::{Kinematics as _, SerialArm};
/// use palpate::math::{Vec3, vec3};
///
/// let arm = SerialArm {
///     base_height_m: 0.08,
///     first_link_m: 0.2,
///     second_link_m: 0.25,
///     workspace_centre_m: Vec3::ZERO,
///     end_masses_kg: [0.0; 2],
/// };
/// // First link upright, second level.
/// let pose = arm.pose([0.0; 3]).expect("within reach");
/// assert!((pose.position - vec3(0.25, 0.0, 0.28)).length() < 1e-6);
/// ```
///
/// An elbow motor that rides on the first link turns the second one by the angle `e` between them, `c = b + e`, and its
/// encoder reads `e`. Such an arm is another mechanism, by the chain rule; its torques follow from the Jacobian:
///
/// ```
/// use palpate::device::{Kinematics, ProbePose, SerialArm};
/// # use palpate::device::presets::WOODEN_HAPTICS_2016;
///
/// #[derive(Clone, Copy)]
/// struct ElbowOnFirstLink(SerialArm);
///
/// impl Kinematics<3> for ElbowOnFirstLink {
///     fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
///         self.held_pose(angles).map(|(pose, _)| pose)
///     }
///
///     fn held_pose(&self, [a, b, e]: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
///         let (pose, [table, first, second]) = self.0.held_pose([a, b, b + e])?;
///         let [by_a, by_b, by_c] = pose.jacobian;
///         // The first motor turns both links.
///         Some((ProbePose { jacobian: [by_a, by_b + by_c, by_c], ..pose }, [table, first + second, second]))
///     }
/// }
///
/// let arm = ElbowOnFirstLink(WOODEN_HAPTICS_2016.kinematics);
/// let (at, step) = ([0.2, 0.3, 0.1], 1e-3);
/// let pose = arm.pose(at).expect("within reach");
/// let moved = arm.pose([at[0], at[1] + step, at[2]]).expect("within reach");
/// // Second derivatives are at most the links' lengths, 0.5 m together.
/// assert!(((moved.position - pose.position) / step - pose.jacobian[1]).length() < 0.5 * step);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SerialArm {
    /// Height of the first link's axis, `A`, metres.
    pub base_height_m: f32,
    /// Length of the first link, `B`, metres.
    pub first_link_m: f32,
    /// Length of the second link, `C`, metres.
    pub second_link_m: f32,
    /// The centre of the workspace, metres from the foot of the turntable.
    pub workspace_centre_m: Vec3,
    /// Mass that each link lifts, referred to its end, kg: its own mass times the distance of its centre from its axis
    /// over its length, and for the first also all masses beyond its end. Negative where it is overbalanced; zero if
    /// not known.
    pub end_masses_kg: [f32; 2],
}

impl SerialArm {
    /// As [`Kinematics::check`], for constants.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        let Self { base_height_m, first_link_m, second_link_m, workspace_centre_m, end_masses_kg } = *self;
        let [x, y, z] = workspace_centre_m.to_array();
        let [first, second] = end_masses_kg;
        all_of!(
            lengths(&[("first_link", first_link_m), ("second_link", second_link_m)]),
            offsets(&[("base_height", base_height_m)]),
            centre(&[x, y, z - base_height_m], first_link_m + second_link_m),
            weights([0.0, first * first_link_m, second * second_link_m], holds_n_m)
        )
    }
}

impl Kinematics<3> for SerialArm {
    // Always: with a second caller it would be a call in the tick, of 42 instructions.
    #[inline(always)]
    fn pose(&self, [a, b, c]: [f32; 3]) -> Option<ProbePose<3>> {
        let ((sin_a, cos_a), (sin_b, cos_b), (sin_c, cos_c)) = (sin_cos(a), sin_cos(b), sin_cos(c));
        let (first, second) = (self.first_link_m, self.second_link_m);
        let reach = first * sin_b + second * cos_c;
        let height = self.base_height_m + first * cos_b - second * sin_c;
        // How reach grows with b and with c.
        let (reach_b, reach_c) = (first * cos_b, -second * sin_c);
        Some(ProbePose {
            position: vec3(reach * cos_a, reach * sin_a, height) - self.workspace_centre_m,
            jacobian: [
                vec3(-reach * sin_a, reach * cos_a, 0.0),
                vec3(reach_b * cos_a, reach_b * sin_a, -first * sin_b),
                vec3(reach_c * cos_a, reach_c * sin_a, -second * cos_c),
            ],
        })
    }

    #[inline]
    fn held_pose(&self, angles: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
        let pose = self.pose(angles)?;
        // A mass at the end of a link is lifted as that end is: by the Jacobian's z.
        let [_, first, second] = pose.jacobian;
        let [first_mass, second_mass] = self.end_masses_kg;
        Some((pose, [0.0, GRAVITY * first_mass * first.z, GRAVITY * second_mass * second.z]))
    }

    fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        Self::check(self, holds_n_m)
    }
}
