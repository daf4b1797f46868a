//! The controller of one patch: one step a tick.

use super::aim::Aim;
use super::boundary::Landing;
use super::paper::FirstOrder;
use super::witness::{Probe, Step, Witness};
use crate::math::Vec3;
use crate::patch::Patch;

/// How the witness point moves in each tick. Keep it in a `static`: the compiler then drops the code of the other laws.
///
/// ```
/// use palpate::track::{Controller, FirstOrder, Gain};
///
/// // The default: quadratic convergence, one evaluation of the patch a tick.
/// static CONTROLLER: Controller = Controller::SecondOrder;
/// // The paper's law, for comparison.
/// static PAPER: Controller = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Constant(500.0)));
/// assert_eq!(Controller::default(), CONTROLLER);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Controller {
    /// To the minimiser of the quadratic model of `½ ‖ΔR‖²` over the whole patch: the full step if the distance is
    /// proved to fall, otherwise the fraction for which it is proved, or the certified step of first order, whichever
    /// is proved to gain more (theory §12). Converges quadratically, with one evaluation a tick.
    #[default]
    SecondOrder,
    /// A first-order law of the paper.
    FirstOrder(FirstOrder),
}

impl Controller {
    /// One step of the witness point towards the point of the patch closest to the probe. `period_s` is the servo
    /// period, seconds; the second-order law does not use it.
    ///
    /// Invariance: `(u, v)` stays in `[0, 1]²`. Descent, unless the gain is [`Gain::Unlimited`](super::Gain::Unlimited):
    /// the computed distance to the probe never rises by more than rounding; a step that would raise it is rejected.
    /// With Euler's method and valid bounds no step is rejected. Work: one evaluation of the patch, or
    /// [`Integrator::evaluations`](super::Integrator::evaluations). No panic; a probe that is not finite moves nothing.
    ///
    /// Inlined, so that the compiler sees the choice at the call and drops the other laws.
    #[inline(always)]
    pub fn step<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Probe, period_s: f32) -> Step {
        match self {
            Self::SecondOrder => step_second_order(patch, witness, probe.position),
            Self::FirstOrder(law) => law.step(patch, witness, probe, period_s),
        }
    }

    /// Whether the law uses the witness point's second derivatives.
    #[inline(always)]
    pub(crate) const fn is_second_order(&self) -> bool {
        matches!(self, Self::SecondOrder)
    }
}

#[inline(always)]
fn step_second_order<P: Patch>(patch: &P, witness: &mut Witness, probe: Vec3) -> Step {
    let aim = Aim::of(patch, witness, probe);
    witness.mode = aim.mode;
    let (squared, slope, gain) = (aim.squared, aim.slope, aim.gain);
    if !aim.has_slope() {
        return Step::at_rest(squared);
    }
    let Landing { parameters: [u, v], .. } = aim.landing;
    let outcome = aim.settle(&patch.evaluate_curved(u, v), witness, probe, patch.size());
    Step { distance_squared_before: squared, residual_squared: slope, gain, outcome }
}
