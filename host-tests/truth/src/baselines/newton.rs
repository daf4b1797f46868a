//! Newton's method as the paper compares with it, one step at a time.

use super::ErrorKinematics;
use super::projected;
use crate::oracle::OraclePoint;
use glam::DVec3;
use palpate_bake::NurbsPatch;

/// Which method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The controller `ẋ = M⁻¹ (−K Ψ − b)`; nothing is done at the borders, and what leaves the patch has failed.
    Newton,
    /// The same with saturation: a parameter that would pass its border stops there, the other moves on as it was told.
    SaturatedNewton,
    /// Not in the paper: Newton's method for the least `½ ‖ΔR‖²` over the square, as textbooks have it.
    ProjectedNewton,
}

/// Which errors Newton's method drives to zero. The paper's text leaves it open: its Eq. (4) defines measure numbers,
/// and the iteration it calls equivalent drives the covariant errors. The answers are the same, the basins are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Errors {
    /// `Ψ = I⁻¹ g`, Eq. (4).
    MeasureNumbers,
    /// `g = (ΔR · f_u, ΔR · f_v)`.
    Covariant,
}

/// A method on a patch.
#[derive(Clone, Copy, Debug)]
pub struct Baseline<'a> {
    /// The patch.
    pub patch: &'a NurbsPatch,
    /// The method.
    pub method: Method,
    /// The errors; [`Method::ProjectedNewton`] knows only the covariant ones.
    pub errors: Errors,
    /// `K h`: with 1, an Euler step of the controller is a step of Newton's iteration. Not used by
    /// [`Method::ProjectedNewton`], which searches along its step.
    pub gain: f64,
}

/// Where a step leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advance {
    /// To these parameters.
    To([f64; 2]),
    /// Out of the square, to these.
    Out([f64; 2]),
    /// Nowhere: the matrix is singular, or there is nothing left to do.
    Nowhere,
}

impl<'a> Baseline<'a> {
    /// The method with a gain of 1.
    pub const fn new(patch: &'a NurbsPatch, method: Method, errors: Errors) -> Self {
        Self { patch, method, errors, gain: 1.0 }
    }

    /// One step from `at`, in the square, for a probe at rest.
    pub fn step(&self, at: [f64; 2], probe: DVec3) -> Advance {
        let surface = OraclePoint::evaluate(self.patch, at[0], at[1]);
        if self.method == Method::ProjectedNewton {
            return projected::step(self.patch, &surface, at, probe).map_or(Advance::Nowhere, Advance::To);
        }
        let kinematics = match self.errors {
            Errors::MeasureNumbers => ErrorKinematics::measure_numbers(&surface, probe),
            Errors::Covariant => Some(ErrorKinematics::covariant(&surface, probe)),
        };
        let direction = kinematics.and_then(|kinematics| kinematics.newton_direction());
        let Some(direction) = direction else { return Advance::Nowhere };
        let next = [0, 1].map(|i| at[i] + self.gain * direction[i]);
        let inside = next.iter().all(|parameter| (0.0..=1.0).contains(parameter));
        let saturated = next.map(|parameter| parameter.clamp(0.0, 1.0));
        match self.method {
            _ if next == at || (self.method == Method::SaturatedNewton && saturated == at) => Advance::Nowhere,
            Method::Newton if !inside => Advance::Out(next),
            _ => Advance::To(saturated),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_bake::Model;

    /// A biquadratic dome; probes above its middle.
    fn dome() -> NurbsPatch {
        let text = r#"
            unit = "m"
            [[patch]]
            degree = [2, 2]
            points = [
              [[0, 0, 0], [0.5, 0, 0.4], [1, 0, 0]],
              [[0, 0.5, 0.4], [0.5, 0.5, 0.9], [1, 0.5, 0.4]],
              [[0, 1, 0], [0.5, 1, 0.4], [1, 1, 0]],
            ]"#;
        Model::parse(text, "test").expect("the model is good").patches.remove(0)
    }

    #[test]
    fn every_method_converges_from_nearby_newton_quadratically() {
        let (patch, probe) = (dome(), DVec3::new(0.55, 0.45, 0.8));
        for (method, errors) in [
            (Method::Newton, Errors::MeasureNumbers),
            (Method::Newton, Errors::Covariant),
            (Method::SaturatedNewton, Errors::MeasureNumbers),
            (Method::ProjectedNewton, Errors::Covariant),
        ] {
            let baseline = Baseline::new(&patch, method, errors);
            let mut at = [0.5, 0.5];
            // From 0.05 away, squared five times, is far below the digits of a double.
            for _ in 0..6 {
                if let Advance::To(next) = baseline.step(at, probe) {
                    at = next;
                }
            }
            let surface = OraclePoint::evaluate(&patch, at[0], at[1]);
            let difference = surface.point - probe;
            let residual = difference.dot(surface.tangent_u).abs() + difference.dot(surface.tangent_v).abs();
            assert!(residual < 1e-14, "{method:?}, {errors:?}: {residual:e} left");
        }
    }

    #[test]
    fn at_the_border_newton_leaves_and_saturation_stays() {
        // The closest point lies on u = 1: the unrestricted step has to cross it.
        let (patch, probe, start) = (dome(), DVec3::new(0.4, 1.6, 0.3), [0.95, 0.5]);
        let step = |method| Baseline::new(&patch, method, Errors::Covariant).step(start, probe);
        assert!(matches!(step(Method::Newton), Advance::Out([u, _]) if u > 1.0));
        assert!(matches!(step(Method::SaturatedNewton), Advance::To([1.0, _])));
        assert!(matches!(step(Method::ProjectedNewton), Advance::To([u, _]) if u <= 1.0));
    }
}
