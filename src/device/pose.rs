//! Where the probe is and how it moves with the joints.

use crate::math::{Vec3, sqrt};

/// Where the probe is and how it moves with each joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePose<const JOINTS: usize> {
    /// The probe's position in the device's frame, metres from the centre of its workspace.
    pub position: Vec3,
    /// The Jacobian's columns `∂position/∂angle`, metres per radian.
    pub jacobian: [Vec3; JOINTS],
}

impl<const JOINTS: usize> ProbePose<JOINTS> {
    /// The probe's velocity, m/s, from the joint rates, rad/s.
    pub fn velocity(&self, joint_rates: [f32; JOINTS]) -> Vec3 {
        self.jacobian.iter().zip(joint_rates).fold(Vec3::ZERO, |sum, (column, rate)| sum + *column * rate)
    }

    /// The joint torques, N·m, that hold a force at the probe, N: `τ = Jᵀ F`.
    pub fn torques(&self, force: Vec3) -> [f32; JOINTS] {
        self.jacobian.map(|column| column.dot(force))
    }

    /// The force at a probe that is held, N, of 1 N·m of one joint alone: `F` with `Jᵀ F = eⱼ`, at right angles to the
    /// other joints' columns. Not finite at a singularity; zero for a joint that is not there.
    #[inline]
    pub(crate) fn force_of_joint(&self, joint: usize) -> Vec3 {
        match (self.jacobian.as_slice(), joint) {
            ([only], 0) => *only / only.length_squared(),
            ([a, b], 0) => beside(*a, *b),
            ([a, b], 1) => beside(*b, *a),
            ([a, b, c], 0) => across(*a, *b, *c),
            ([a, b, c], 1) => across(*b, *c, *a),
            ([a, b, c], 2) => across(*c, *a, *b),
            _ => Vec3::ZERO,
        }
    }

    /// Distance from a singularity, m/rad: a lower bound of the Jacobian's smallest singular value, exact for one
    /// joint.
    ///
    /// For every direction of the joint rates, a unit of joint rates moves the probe at least this fast; a joint torque
    /// of 1 N·m presses with at most the inverse, in newtons. From `σ₁σ₂σ₃ = |det J|` and `σ₁σ₂ ≤ (σ₁² + σ₂²)/2`: `σ₃ ≥
    /// 2 |det J| / ‖J‖²`; for two joints `σ₂ ≥ |j₁ × j₂| / ‖J‖` (Frobenius norms). Zero at a singularity and where the
    /// pose is not finite, and for more than three joints.
    pub fn singularity_margin(&self) -> f32 {
        let margin = self.margin();
        if margin.is_finite() && self.position.is_finite() { margin } else { 0.0 }
    }

    /// The same for a pose that is known to be finite.
    #[inline]
    pub(super) fn margin(&self) -> f32 {
        let squares = self.jacobian.iter().fold(0.0, |sum, column| sum + column.length_squared());
        match self.jacobian.as_slice() {
            [only] => sqrt(only.length_squared()),
            [a, b] => sqrt(a.cross(*b).length_squared()) / sqrt(squares),
            [a, b, c] => 2.0 * a.dot(b.cross(*c)).abs() / squares,
            _ => 0.0,
        }
    }
}

/// The vector in their plane whose dot product with `column` is 1 and with `other` 0.
fn beside(column: Vec3, other: Vec3) -> Vec3 {
    let rest = column - other * (column.dot(other) / other.length_squared());
    rest / rest.dot(column)
}

/// The vector whose dot product with `column` is 1 and with `a` and `b` 0.
#[inline]
fn across(column: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let normal = a.cross(b);
    normal * (1.0 / column.dot(normal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    fn margin<const JOINTS: usize>(jacobian: [Vec3; JOINTS]) -> f32 {
        ProbePose { position: Vec3::ZERO, jacobian }.singularity_margin()
    }

    #[test]
    fn margin_is_exact_where_columns_are_square_and_alike() {
        let (x, y, z) = (vec3(0.1, 0.0, 0.0), vec3(0.0, 0.1, 0.0), vec3(0.0, 0.0, 0.1));
        // Singular values 0.1 each: 2 · 10⁻³ / 0.03, 10⁻² / (√2 · 0.1), and 0.1 itself; a few roundings.
        for (found, expected) in [(margin([x, y, z]), 2e-3 / 0.03), (margin([x, y]), 0.070_710_68), (margin([z]), 0.1)]
        {
            assert!((found - expected).abs() < 1e-7, "{found} {expected}");
        }
    }

    #[test]
    fn margin_never_exceeds_the_least_motion_of_a_unit_of_rates() {
        let jacobian = [vec3(0.02, 0.1, -0.03), vec3(0.09, -0.02, 0.05), vec3(0.04, 0.05, 0.11)];
        let pose = ProbePose { position: Vec3::ZERO, jacobian };
        let mut least = f32::INFINITY;
        for n in 0..100_000 {
            let (turn, tilt) = (n as f32 * 2.399_963, 1.0 - 2.0 * (n as f32 + 0.5) / 100_000.0);
            let across = (1.0 - tilt * tilt).sqrt();
            least = least.min(pose.velocity([across * turn.cos(), across * turn.sin(), tilt]).length());
        }
        let margin = pose.singularity_margin();
        assert!(margin <= least && margin > 0.4 * least, "{margin} {least}");
    }

    #[test]
    fn a_singular_or_impossible_pose_has_no_margin() {
        let (x, y) = (vec3(0.1, 0.0, 0.0), vec3(0.0, 0.1, 0.0));
        assert_eq!([margin([x, y, x + y]), margin([x, -x]), margin([Vec3::ZERO; 3])], [0.0; 3]);
        assert_eq!(margin([Vec3::NAN; 2]), 0.0);
    }

    #[test]
    fn a_joint_alone_presses_past_the_others() {
        let pose = |jacobian| ProbePose { position: Vec3::ZERO, jacobian };
        let [a, b, c] = [vec3(0.2, 0.0, 0.05), vec3(0.1, 0.3, 0.0), vec3(-0.1, 0.1, 0.2)];
        for joint in 0..3 {
            let unit = [0, 1, 2].map(|each| f32::from(u8::from(each == joint)));
            let torques = pose([a, b, c]).torques(pose([a, b, c]).force_of_joint(joint));
            // Roundings of sums of three products below 2.
            assert!(torques.iter().zip(unit).all(|(torque, unit)| (torque - unit).abs() < 1e-6), "{torques:?}");
        }
        let planar = ProbePose { position: Vec3::ZERO, jacobian: [vec3(0.0, 0.2, 0.0), vec3(0.1, 0.1, 0.0)] };
        for joint in 0..2 {
            let torques = planar.torques(planar.force_of_joint(joint));
            assert!((torques[joint] - 1.0).abs() < 1e-6 && torques[1 - joint].abs() < 1e-6, "{torques:?}");
        }
        assert!((ProbePose { position: Vec3::ZERO, jacobian: [c] }.force_of_joint(0).dot(c) - 1.0).abs() < 1e-6);
        assert!(!pose([a, b, a]).force_of_joint(0).is_finite());
        assert_eq!(pose([a, b, c]).force_of_joint(3), Vec3::ZERO);
    }
}
