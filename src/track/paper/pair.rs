//! Two patches (Theorem 2): the closest pair of two bodies, and the pair of a common normal.
//!
//! Each patch has its own boundary automaton, so any of the mixed modes occurs. One tick evaluates each patch once.

use crate::math::Vec3;
use crate::patch::Patch;
use crate::track::boundary::{self, Descent, Landing};
use crate::track::{Controller, Placement, Probe, ProjectionErrors, Step, Witness};

/// The witness points of both patches, each in the frame of its own body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairWitness {
    /// On patch `f` of body A.
    pub a: Witness,
    /// On patch `h` of body B.
    pub b: Witness,
}

/// Result of a step of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairStep {
    /// `ΔR = f − h` after the step, metres, in A's frame.
    pub difference: Vec3,
    /// The step of A's witness point.
    pub a: Step,
    /// The step of B's witness point.
    pub b: Step,
}

/// Tracker of the closest pair of two patches that do not intersect.
///
/// ```
/// use palpate::math::vec3;
/// use palpate::patch::{Coefficients, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
/// use palpate::track::{CommonNormalTracker, PairTracker, PairWitness, Placement};
///
/// // A shallow dome, z = −2 (x² + y²), and the same one upside down, 30 mm above it and 10 mm aside.
/// static DOME: SplinePatch = SplineTable {
///     degree: [2, 2],
///     coefficients: Coefficients::Polynomial(&[
///         [0.0; 3], [0.0, 0.1, 0.0], [0.0, 0.0, -0.02],
///         [0.1, 0.0, 0.0], [0.0; 3], [0.0; 3],
///         [0.0, 0.0, -0.02], [0.0; 3], [0.0; 3],
///     ]),
///     shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.04, uv: 0.0, vv: 0.04 }),
///     size_m: 0.1,
///     ..SplineTable::UNIT_SQUARE
/// }
/// .checked();
/// let upside_down = [vec3(1.0, 0.0, 0.0), vec3(0.0, -1.0, 0.0), vec3(0.0, 0.0, -1.0)];
/// let placement = Placement { axes: upside_down, origin: vec3(0.01, 0.0, 0.03), ..Placement::IDENTITY };
/// let mut witness = PairWitness::at(&DOME, &DOME, [0.5; 2], [0.5; 2]);
/// let tracker = PairTracker::default();
/// for _ in 0..200 {
///     tracker.step(&DOME, &DOME, &placement, &mut witness, 0.001);
/// }
/// // Each witness point has moved 4.7 mm towards the other.
/// assert!((witness.a.surface.point.x - 0.0047).abs() < 1e-4);
/// // The law of the common normal ends there too.
/// let common = CommonNormalTracker::new(4.0, 4.0);
/// let step = common.step(&DOME, &DOME, &placement, &mut witness).expect("both have normals");
/// assert!(step.mismatch < 1e-2 && step.depth < 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairTracker {
    /// The law of both witness points.
    pub controller: Controller,
}

impl PairTracker {
    /// One step towards the closest pair of two patches that do not intersect.
    ///
    /// The witness points step in turn, each with the other for its probe: `V = ‖ΔR‖ − E` falls in each half with the
    /// certificate of a single patch, so it falls in the whole, and the pair inherits invariance and descent. Where one
    /// patch is strictly convex the only rest is the closest pair.
    #[inline]
    pub fn step<F: Patch, H: Patch>(
        &self,
        f: &F,
        h: &H,
        placement: &Placement,
        witness: &mut PairWitness,
        period_s: f32,
    ) -> PairStep {
        let seen_from_a = placement.point_to_a(witness.b.surface.point);
        let probe = Probe { position: seen_from_a, velocity: placement.velocity_at(seen_from_a) };
        let a = self.controller.step(f, &mut witness.a, probe, period_s);

        let point_a = witness.a.surface.point;
        let velocity = -placement.direction_to_b(placement.velocity_at(point_a));
        let probe = Probe { position: placement.point_to_b(point_a), velocity };
        let b = self.controller.step(h, &mut witness.b, probe, period_s);

        let difference = point_a - placement.point_to_a(witness.b.surface.point);
        PairStep { difference, a, b }
    }
}

impl PairWitness {
    /// Witness points at `(u, v)` of `f` and `(r, s)` of `h`. One evaluation of each.
    pub fn at<F: Patch, H: Patch>(f: &F, h: &H, [u, v]: [f32; 2], [r, s]: [f32; 2]) -> Self {
        Self { a: Witness::at(f, u, v), b: Witness::at(h, r, s) }
    }
}

/// The law of the *common normal*: the pair of points whose normals are opposite and whose difference is along them.
///
/// For bodies apart it is the closest pair, for intersecting ones the extremal pair: the maximum penetration along a
/// common normal. The paper claims the latter from the same `V`, but there it is no minimum. With offsets `x`, `y` of
/// the two points along a principal direction, depth `D` and curvatures `κ_A`, `κ_B`, half the squared distance is, to
/// second order, `½ [D² + (1 − D κ_A) x² − 2 x y + (1 − D κ_B) y²]`, of determinant `−D (κ_A + κ_B − D κ_A κ_B) < 0`
/// while `D < 1/κ_A + 1/κ_B`: a saddle, a minimum in `x − y` and a maximum in `x + y`. Each point alone sees a minimum
/// (a closest point from inside), yet stepping in turn drives the pair apart.
///
/// So the two motions get a law each. With `τ` the part of `ΔR` along the tangent planes and `ν = N_A + N_B`, zero
/// when the normals are opposite: `w_A = −½ τ − c ν` and `w_B = +½ τ − c ν`, each projected on its own tangent plane.
/// To first order `ν = κ_A x + κ_B y` whatever the sign of `D`, so with `c = 1/(κ_A + κ_B)` the sum decays at once and
/// the difference by the factor `D (κ_A + κ_B)/4` a tick, from apart through contact into penetration without a
/// switch. It is stable for `|D| (κ_A + κ_B) < 4`, locally, without a Lyapunov function. The pair is unique if the
/// depth is below the minimum radius of curvature of the Minkowski difference, for which `D < 1/κ_A + 1/κ_B`, with the
/// maximum curvatures of both bodies, is sufficient locally.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonNormalTracker {
    /// `c`, metres: how far the points move for a mismatch of the normals.
    align: f32,
}

/// Result of a step towards the common normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonNormalStep {
    /// `ΔR = f − h` before the step, metres, in A's frame.
    pub difference: Vec3,
    /// The depth `ΔR · N_A`: positive where the bodies intersect, metres.
    pub depth: f32,
    /// `‖τ‖`, metres.
    pub tangential: f32,
    /// `‖N_A + N_B‖`.
    pub mismatch: f32,
}

impl CommonNormalTracker {
    /// A tracker for two bodies of these maximum curvatures, 1/m.
    pub const fn new(curvature_a: f32, curvature_b: f32) -> Self {
        let sum = curvature_a + curvature_b;
        Self { align: if sum > 0.0 { 1.0 / sum } else { 0.0 } }
    }

    /// One step. `None`, and no movement, where a witness point has no normal (a pole).
    #[inline]
    pub fn step<F: Patch, H: Patch>(
        &self,
        f: &F,
        h: &H,
        placement: &Placement,
        witness: &mut PairWitness,
    ) -> Option<CommonNormalStep> {
        let normal_a = witness.a.normal(f)?;
        let normal_b = placement.direction_to_a(witness.b.normal(h)?);
        let difference = witness.a.surface.point - placement.point_to_a(witness.b.surface.point);
        // The mean of both tangent planes: the same for both points, and exact at the solution.
        let tangential_a = difference - normal_a * difference.dot(normal_a);
        let tangential_b = difference - normal_b * difference.dot(normal_b);
        let tangential = (tangential_a + tangential_b) * 0.5;
        let mismatch = normal_a + normal_b;
        let together = mismatch * -self.align;
        slide(f, &mut witness.a, together - tangential * 0.5);
        slide(h, &mut witness.b, placement.direction_to_b(together + tangential * 0.5));
        Some(CommonNormalStep {
            difference,
            depth: difference.dot(normal_a),
            tangential: tangential.length(),
            mismatch: mismatch.length(),
        })
    }
}

/// Moves a witness point by a vector, as far as its tangent plane and the patch's border allow.
#[inline]
fn slide<P: Patch>(patch: &P, witness: &mut Witness, by: Vec3) {
    // A point that is `by` away is a probe whose projection errors are the way to go.
    let errors = ProjectionErrors::new(&witness.surface, witness.surface.point + by);
    let descent = Descent::of(&errors, witness);
    witness.mode = descent.mode;
    if let Some(Landing { parameters, is_inside }) = boundary::advance(witness.parameters, descent.direction, 1.0) {
        let surface = patch.evaluate(parameters[0], parameters[1]);
        *witness = Witness { parameters, is_free: is_inside, surface, ..*witness };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::patch::SplinePatch;

    #[test]
    fn a_point_that_slides_to_the_border_knows_it() {
        let square = SplinePatch::VACANT;
        let mut witness = Witness::at(&square, 0.5, 0.5);
        slide(&square, &mut witness, vec3(0.25, 0.0, 0.3));
        assert!(witness.is_free && (witness.parameters[0] - 0.75).abs() < 1e-6, "{witness:?}");
        slide(&square, &mut witness, vec3(0.5, 0.02, 0.0));
        assert!(!witness.is_free && witness.parameters[0] == 1.0, "{witness:?}");
    }
}
