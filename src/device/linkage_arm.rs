//! The three-joint arm whose second link is driven by a crank and a rod, as in Polhem.

use super::device_error::{all_of, centre, offsets, weights};
use super::five_bar::{Closed, left};
use super::{DeviceError, FiveBar, GRAVITY, Kinematics, ProbePose};
use crate::math::{Vec2, Vec3, sin_cos, vec3};

/// A link's mass and where its centre lies in the link's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkMass {
    /// Mass, kg; zero if not known.
    pub mass_kg: f32,
    /// The centre, metres along the link from its first hinge.
    pub along_m: f32,
    /// The centre, metres to the left of that direction.
    pub across_m: f32,
}

impl LinkMass {
    /// A link that weighs nothing.
    pub const NONE: Self = Self { mass_kg: 0.0, along_m: 0.0, across_m: 0.0 };
}

/// A turntable that carries an upright [`FiveBar`].
///
/// Joint angles, radians: `a` turns the table about the vertical z axis; the other two are the cranks',
/// counter-clockwise from the horizontal. The five-bar's x is the distance from the turntable's axis less
/// `pivot_reach`, its y the height: `x = r cos a`, `y = r sin a`, `z = h`, less the workspace centre.
///
/// ```
/// use palpate::device::{Kinematics as _, LinkageArm, presets::POLHEM_V2};
///
/// let arm: LinkageArm = POLHEM_V2.kinematics;
/// let angles = [0.0, 0.912_695, 2.360_105];
/// assert!(POLHEM_V2.in_workspace(angles));
/// // The turntable lifts no link.
/// assert_eq!(arm.holding_torques(angles)[0], 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkageArm {
    /// The linkage in the upright plane. Its own workspace centre is not used.
    pub linkage: FiveBar,
    /// From the turntable's axis to the first crank's pivot, metres.
    pub pivot_reach_m: f32,
    /// The centre of the workspace, metres from the foot of the first crank's pivot on the axis.
    pub workspace_centre_m: Vec3,
    /// First crank, second crank, first rod (with all it carries, direction from its elbow to the probe), second rod
    /// (direction from its elbow to the hinge).
    pub masses: [LinkMass; 4],
}

impl LinkageArm {
    /// How the height of a link's centre changes with the cranks, metres per radian. The link starts at a point that
    /// moves with `start`, and points along `span` from there, whose end moves `sweep` faster than its start.
    fn lift(link: &LinkMass, start: [Vec2; 2], span: Vec2, sweep: [Vec2; 2]) -> [f32; 2] {
        // A rigid link turns by `span⊥ · sweep / span²`, and its centre's height changes with the offset's own x.
        let length = span.length();
        let forward = span / length;
        let offset = forward * link.along_m + left(forward) * link.across_m;
        let rate = |sweep: Vec2| left(span).dot(sweep) / (length * length);
        let ([start_a, start_b], [sweep_a, sweep_b]) = (start, sweep);
        [start_a.y + rate(sweep_a) * offset.x, start_b.y + rate(sweep_b) * offset.x]
    }

    fn weight(&self, closed: &Closed) -> [f32; 2] {
        let [elbow_a, elbow_b] = closed.elbows;
        let (tool, hinge) = (self.linkage.tool(closed), closed.hinge);
        let pivot_b = Vec2::new(self.linkage.second_pivot_m, 0.0);
        let less = |[a, b]: [Vec2; 2], [c, d]: [Vec2; 2]| [a - c, b - d];
        let fixed = [Vec2::ZERO; 2];
        let [crank_a, crank_b, rod_a, rod_b] = &self.masses;
        let lifts = [
            (crank_a.mass_kg, Self::lift(crank_a, fixed, elbow_a.place, elbow_a.motion)),
            (crank_b.mass_kg, Self::lift(crank_b, fixed, elbow_b.place - pivot_b, elbow_b.motion)),
            (
                rod_a.mass_kg,
                Self::lift(rod_a, elbow_a.motion, tool.place - elbow_a.place, less(tool.motion, elbow_a.motion)),
            ),
            (
                rod_b.mass_kg,
                Self::lift(rod_b, elbow_b.motion, hinge.place - elbow_b.place, less(hinge.motion, elbow_b.motion)),
            ),
        ];
        lifts.into_iter().fold([0.0; 2], |[sum_a, sum_b], (mass, [lift_a, lift_b])| {
            [sum_a + GRAVITY * mass * lift_a, sum_b + GRAVITY * mass * lift_b]
        })
    }
}

impl LinkageArm {
    /// As [`Kinematics::check`], for constants.
    ///
    /// The weight of each crank's joint: its own, and those of the rods where the crank carries them, levers as in a
    /// parallelogram, all held out level. Towards a singularity a motor takes more.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        let Self { linkage, pivot_reach_m, workspace_centre_m, masses } = *self;
        let ([crank_a, crank_b], [rod_a, rod_b]) = (linkage.cranks_m, linkage.rods_m);
        let (mut moments, mut link) = ([0.0; 4], 0);
        while link < 4 {
            let LinkMass { mass_kg, along_m, across_m } = masses[link];
            if !(mass_kg >= 0.0 && mass_kg < f32::INFINITY) {
                return Err(DeviceError::Mass("masses"));
            }
            moments[link] = mass_kg * (along_m.abs() + across_m.abs());
            link += 1;
        }
        let first = moments[0] + masses[2].mass_kg * crank_a + moments[3] * crank_a / rod_b;
        let second = moments[1] + masses[3].mass_kg * crank_b + moments[2] * crank_b / rod_a;
        all_of!(
            linkage.check_links(),
            offsets(&[("pivot_reach", pivot_reach_m)]),
            centre(&workspace_centre_m.to_array(), pivot_reach_m.abs() + linkage.reach_m()),
            weights([0.0, first, second], holds_n_m)
        )
    }
}

impl Kinematics<3> for LinkageArm {
    #[inline]
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        self.held_pose(angles).map(|(pose, _)| pose)
    }

    #[inline]
    fn held_pose(&self, [a, b, c]: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
        let closed = self.linkage.close([b, c])?;
        let tool = self.linkage.tool(&closed);
        let (sin_a, cos_a) = sin_cos(a);
        let reach = self.pivot_reach_m + tool.place.x;
        let stand = |v: Vec2| vec3(v.x * cos_a, v.x * sin_a, v.y);
        let [motion_b, motion_c] = tool.motion;
        let pose = ProbePose {
            position: stand(Vec2::new(reach, tool.place.y)) - self.workspace_centre_m,
            jacobian: [vec3(-reach * sin_a, reach * cos_a, 0.0), stand(motion_b), stand(motion_c)],
        };
        let [first, second] = self.weight(&closed);
        Some((pose, [0.0, first, second]))
    }

    fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        Self::check(self, holds_n_m)
    }
}
