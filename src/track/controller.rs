//! The switching controller of Theorem 1: one step a tick.

use super::aim::Aim;
use super::boundary::{self, Descent, Landing, MAX_HALVINGS};
use super::gain::certified_gain;
use super::law::{FeedForward, Gain, Integrator, Law};
use super::projection::ProjectionErrors;
use super::rounding::{is_above_zero, rises};
use super::witness::{Outcome, Probe, Step, Witness};
use super::{feed_forward, integrate};
use crate::math::Vec3;
use crate::patch::Patch;

/// The controller's configuration. Begin with [`Controller::SECOND_ORDER`], or with [`Controller::CERTIFIED`] and
/// choose, as in
/// `Controller::CERTIFIED.gain(Gain::Constant(500.0))`. Keep it in a `static`: what is not chosen costs nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// Which direction.
    pub(super) law: Law,
    /// How fast.
    pub(super) gain: Gain,
    /// What is done with motion.
    pub(super) feed_forward: FeedForward,
    /// How the flow is integrated.
    pub(super) integrator: Integrator,
}

impl Default for Controller {
    fn default() -> Self {
        Self::SECOND_ORDER
    }
}

impl Controller {
    /// The certified law of second order, one evaluation a tick: the default.
    pub const SECOND_ORDER: Self = Self { law: Law::SecondOrder, ..Self::CERTIFIED };

    /// Theorem 1 at the largest gain that is proved monotone, one evaluation a tick: the paper's law.
    pub const CERTIFIED: Self = Self {
        law: Law::MeasureNumbers,
        gain: Gain::Certified,
        feed_forward: FeedForward::None,
        integrator: Integrator::Euler,
    };

    /// One step of the chosen law towards the point of the patch closest to the probe, over `period` seconds.
    ///
    /// Invariance: `(u, v)` stays in `[0, 1]²`. Descent, unless the gain is [`Gain::Unlimited`]: the computed distance
    /// to the probe never rises by more than rounding; a step that would is undone. With [`Integrator::Euler`] and
    /// bounds that hold none has to be. Work: [`Integrator::evaluations`] of the patch. No panic; a probe that is not
    /// finite leaves the witness point where it is.
    ///
    /// Inlined where it is called, so that the compiler sees what is chosen there and drops the rest.
    #[inline(always)]
    pub fn step<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Probe, period: f32) -> Step {
        if self.is_second_order() {
            self.step_second_order(patch, witness, probe)
        } else {
            self.step_first_order(patch, witness, probe, period)
        }
    }

    /// Whether the witness point's second derivatives are looked at.
    #[inline(always)]
    pub(crate) const fn is_second_order(&self) -> bool {
        matches!(
            self,
            Self {
                law: Law::SecondOrder,
                gain: Gain::Certified,
                feed_forward: FeedForward::None,
                integrator: Integrator::Euler
            }
        )
    }

    #[inline(always)]
    fn step_second_order<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Probe) -> Step {
        let aim = Aim::of(patch, witness, probe.position);
        witness.mode = aim.mode;
        let (squared, slope, gain) = (aim.squared, aim.slope, aim.gain);
        if !aim.has_slope() {
            return Step {
                distance_squared_before: squared,
                residual_squared: 0.0,
                gain: 0.0,
                outcome: Outcome::AtRest,
            };
        }
        let Landing { parameters: [u, v], .. } = aim.landing;
        let outcome = aim.settle(&patch.evaluate_curved(u, v), witness, probe.position, patch.size());
        Step { distance_squared_before: squared, residual_squared: slope, gain, outcome }
    }

    #[inline(always)]
    fn step_first_order<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Probe, period: f32) -> Step {
        let errors = ProjectionErrors::new(&witness.surface, probe.position);
        let squared = errors.difference.length_squared();
        let plain = Descent::of(self.law, &errors, witness);
        let plain_gain = self.gain_for(&plain, patch, squared, period);
        let (descent, gain) = match self.feed_forward {
            FeedForward::None => (plain, plain_gain),
            FeedForward::Gated | FeedForward::Full => {
                let moved = probe.velocity * period;
                let descent = self.following(&errors, witness, moved, plain_gain);
                (descent, least(plain_gain, self.gain_for(&descent, patch, squared, period)))
            }
        };
        witness.mode = descent.mode;
        let at_rest =
            Step { distance_squared_before: squared, residual_squared: 0.0, gain: 0.0, outcome: Outcome::AtRest };
        if !is_above_zero(descent.slope) {
            return at_rest;
        }
        let change =
            integrate::change(self.integrator, patch, witness.parameters, descent.direction, gain, |surface, at| {
                let errors = ProjectionErrors::new(surface, probe.position);
                Descent::new(self.law, &errors, at).direction
            });
        // What is not a number, or too large for one, has come this far and goes no farther.
        let Some(Landing { parameters, is_inside }) = boundary::advance(witness.parameters, change, gain) else {
            return at_rest;
        };
        let surface = patch.evaluate(parameters[0], parameters[1]);
        let outcome = if self.is_guarded() && rises(&witness.surface, &surface, probe.position, squared, patch.size()) {
            witness.is_free = false;
            witness.halvings = (witness.halvings + 1).min(MAX_HALVINGS);
            Outcome::Undone
        } else {
            witness.halvings = 0;
            witness.is_free = is_inside;
            witness.parameters = parameters;
            witness.surface = surface;
            Outcome::Moved
        };
        Step { distance_squared_before: squared, residual_squared: plain.slope, gain, outcome }
    }

    /// `K h` for a direction.
    #[inline(always)]
    fn gain_for<P: Patch>(&self, descent: &Descent, patch: &P, squared: f32, period: f32) -> f32 {
        let certified = || certified_gain(descent, &patch.bounds(), squared);
        match self.gain {
            Gain::Certified => certified(),
            Gain::Constant(gain) => least(certified(), gain * period),
            Gain::Exponential(rate) => {
                let [w_u, w_v] = descent.direction;
                least(certified(), rate * period * squared / (w_u * w_u + w_v * w_v))
            }
            Gain::Unlimited(gain) => gain * period,
        }
    }

    /// The direction that also follows the probe's motion; its slope is taken along the true gradient.
    #[inline]
    fn following(&self, errors: &ProjectionErrors, witness: &Witness, moved: Vec3, gain: f32) -> Descent {
        let gradient = feed_forward::gradient(self.feed_forward, errors, &witness.surface, moved, gain);
        let errors_ahead = ProjectionErrors { gradient, ..*errors };
        let descent = Descent::of(self.law, &errors_ahead, witness);
        let [w_u, w_v] = descent.direction;
        let form = errors.form;
        Descent {
            slope: -(errors.gradient[0] * w_u + errors.gradient[1] * w_v),
            length_squared: form.e * w_u * w_u + 2.0 * form.f * w_u * w_v + form.g * w_v * w_v,
            ..descent
        }
    }

    const fn is_guarded(&self) -> bool {
        !matches!(self.gain, Gain::Unlimited(_))
    }
}

/// The lesser of a gain and its limit; a gain that is not a number stays none.
#[inline]
fn least(gain: f32, limit: f32) -> f32 {
    if limit < gain { limit } else { gain }
}
