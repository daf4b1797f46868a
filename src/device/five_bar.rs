//! The planar five-bar of pantographs, and of arms that drive their second link through a rod.

use super::device_error::{all_of, centre, lengths, offsets};
use super::{DeviceError, Kinematics, ProbePose};
use crate::math::{Vec2, Vec3, sin_cos, sqrt, vec2};

/// Two cranks on fixed pivots, joined by two rods that meet at a hinge.
///
/// Joint angles, radians, counter-clockwise from the x axis: the first crank's about the origin, the second's about
/// `(second_pivot, 0)`. The cranks end in the elbows `A` and `B`; the rods from there meet at the hinge `C`, on the
/// `side` of the line from `A` to `B`. The probe sits on the first rod, `tool` from `A` towards `C`. The frame lies in
/// the mechanism's plane; z stays zero.
///
/// Forward map: circles about `A` and `B` intersect. With `h = B − A`:
/// `C = A + (L₁² − L₂² + h²)/(2 h²) · h ± √(…) · h⊥`. Jacobian: the rods keep their lengths,
/// `(C − A)·(Ċ − Ȧ) = 0` and `(C − B)·(Ċ − Ḃ) = 0`.
///
/// ```
/// use palpate::device::{FiveBar, Kinematics as _};
/// use palpate::math::Vec2;
///
/// let five_bar = FiveBar {
///     second_pivot_m: 0.04,
///     cranks_m: [0.07; 2],
///     rods_m: [0.09; 2],
///     side: 1.0,
///     tool_m: 0.09,
///     workspace_centre_m: Vec2::ZERO,
/// };
/// // Cranks in mirrored positions: the tool is half-way between the pivots.
/// let pose = five_bar.pose([2.0, core::f32::consts::PI - 2.0]).expect("closes");
/// assert!((pose.position.x - 0.02).abs() < 1e-6 && pose.position.y > 0.07);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBar {
    /// The second crank's pivot on the x axis, metres.
    pub second_pivot_m: f32,
    /// Lengths of the two cranks, metres.
    pub cranks_m: [f32; 2],
    /// Lengths of the two rods, metres.
    pub rods_m: [f32; 2],
    /// Which way the rods bend: 1 puts the hinge left of the line from the first elbow to the second, −1 right.
    pub side: f32,
    /// The probe on the first rod, metres from its elbow towards the hinge; negative on the other side of the elbow.
    pub tool_m: f32,
    /// The centre of the workspace, metres from the first pivot.
    pub workspace_centre_m: Vec2,
}

/// A point of the linkage, metres, and how it moves with each crank, metres per radian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hinge {
    pub place: Vec2,
    pub motion: [Vec2; 2],
}

/// The three hinges that move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closed {
    pub elbows: [Hinge; 2],
    pub hinge: Hinge,
}

/// A quarter turn to the left.
pub(super) fn left(v: Vec2) -> Vec2 {
    vec2(-v.y, v.x)
}

impl FiveBar {
    /// Closes the linkage; `None` where the rods cannot meet.
    #[inline]
    pub(super) fn close(&self, [first, second]: [f32; 2]) -> Option<Closed> {
        let ((sin_a, cos_a), (sin_b, cos_b)) = (sin_cos(first), sin_cos(second));
        let ([crank_a, crank_b], [rod_a, rod_b]) = (self.cranks_m, self.rods_m);
        let a = vec2(crank_a * cos_a, crank_a * sin_a);
        let arm_b = vec2(crank_b * cos_b, crank_b * sin_b);
        let b = arm_b + vec2(self.second_pivot_m, 0.0);

        let h = b - a;
        let square = h.length_squared();
        let along = 0.5 + 0.5 * (rod_a * rod_a - rod_b * rod_b) / square;
        let across = rod_a * rod_a / square - along * along;
        // Written so that NaN takes this branch too.
        if !(across > 0.0 && across < f32::INFINITY) {
            return None;
        }
        let c = a + h * along + left(h) * (self.side * sqrt(across));

        let (p, q) = (c - a, c - b);
        let lever = p.perp_dot(q);
        let (turn_a, turn_b) = (left(a), left(arm_b));
        Some(Closed {
            elbows: [
                Hinge { place: a, motion: [turn_a, Vec2::ZERO] },
                Hinge { place: b, motion: [Vec2::ZERO, turn_b] },
            ],
            hinge: Hinge { place: c, motion: [left(q) * (-p.dot(turn_a) / lever), left(p) * (q.dot(turn_b) / lever)] },
        })
    }

    /// The probe, metres from the first pivot.
    #[inline]
    pub(super) fn tool(&self, closed: &Closed) -> Hinge {
        let ([elbow, _], hinge) = (&closed.elbows, &closed.hinge);
        let [rod, _] = self.rods_m;
        let share = self.tool_m / rod;
        let between = |from: Vec2, to: Vec2| from + (to - from) * share;
        let ([elbow_a, elbow_b], [hinge_a, hinge_b]) = (elbow.motion, hinge.motion);
        Hinge {
            place: between(elbow.place, hinge.place),
            motion: [between(elbow_a, hinge_a), between(elbow_b, hinge_b)],
        }
    }
}

impl FiveBar {
    /// The check of all but the centre of the workspace.
    pub(super) const fn check_links(&self) -> Result<(), DeviceError> {
        let Self { second_pivot_m, cranks_m: [crank_a, crank_b], rods_m: [rod_a, rod_b], side, tool_m, .. } = *self;
        all_of!(
            lengths(&[("cranks", crank_a), ("cranks", crank_b), ("rods", rod_a), ("rods", rod_b)]),
            lengths(&[("tool", tool_m.abs())]),
            offsets(&[("second_pivot", second_pivot_m)]),
            if side.abs() == 1.0 { Ok(()) } else { Err(DeviceError::Mechanism("side")) }
        )
    }

    /// How far the tool goes from the first pivot, metres.
    pub(super) const fn reach_m(&self) -> f32 {
        self.cranks_m[0] + self.tool_m.abs()
    }

    /// As [`Kinematics::check`], for constants.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self) -> Result<(), DeviceError> {
        all_of!(self.check_links(), centre(&self.workspace_centre_m.to_array(), self.reach_m()))
    }
}

impl Kinematics<2> for FiveBar {
    #[inline]
    fn pose(&self, angles: [f32; 2]) -> Option<ProbePose<2>> {
        let closed = self.close(angles)?;
        let tool = self.tool(&closed);
        let flat = |v: Vec2| Vec3::new(v.x, v.y, 0.0);
        Some(ProbePose { position: flat(tool.place - self.workspace_centre_m), jacobian: tool.motion.map(flat) })
    }

    fn check(&self, _: [f32; 2]) -> Result<(), DeviceError> {
        Self::check(self)
    }
}
