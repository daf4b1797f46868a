//! The first-order controller of Theorem 1: its configuration, and one step a tick.

use super::laws::{FeedForward, Gain, Integrator, Law};
use super::{feed_forward, integrator};
use crate::math::Vec3;
use crate::patch::Patch;
use crate::track::boundary::{self, Descent, Landing, MAX_HALVINGS};
use crate::track::gain::certified_gain;
use crate::track::projection::ProjectionErrors;
use crate::track::rounding::{is_above_zero, rises};
use crate::track::witness::{Outcome, Probe, Step, Witness};
use thiserror::Error;

/// Configuration of a first-order controller: start from [`FirstOrder::CERTIFIED`] and choose.
///
/// Keep it in a `static`: the options that are not chosen leave no code in the image.
///
/// ```
/// use palpate::track::{Controller, FeedForward, FirstOrder, Gain};
///
/// const LAW: FirstOrder = FirstOrder::CERTIFIED.gain(Gain::Constant(500.0)).feed_forward(FeedForward::Full);
/// static CONTROLLER: Controller = Controller::FirstOrder(LAW);
/// assert!(FirstOrder::CERTIFIED.try_gain(Gain::Constant(-1.0)).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FirstOrder {
    law: Law,
    gain: Gain,
    feed_forward: FeedForward,
    integrator: Integrator,
}

/// Error of [`FirstOrder::try_gain`]. In a `static`, [`FirstOrder::gain`] makes it a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FirstOrderError {
    /// The gain is not positive and finite.
    #[error("the gain must be positive and finite")]
    Gain,
}

impl Default for FirstOrder {
    fn default() -> Self {
        Self::CERTIFIED
    }
}

impl FirstOrder {
    /// Theorem 1 at the largest gain that is proved monotone, with Euler's method and without feed-forward: the paper's
    /// law, one evaluation a tick.
    pub const CERTIFIED: Self = Self {
        law: Law::MeasureNumbers,
        gain: Gain::Certified,
        feed_forward: FeedForward::None,
        integrator: Integrator::Euler,
    };

    /// [`Self::CERTIFIED`] with the projected gradient for its direction.
    pub const COVARIANT: Self = Self { law: Law::Covariant, ..Self::CERTIFIED };

    /// The same controller with this law.
    #[must_use]
    pub const fn law(self, law: Law) -> Self {
        Self { law, ..self }
    }

    /// The same controller with this gain.
    ///
    /// # Errors
    /// A gain that is not positive and finite.
    pub const fn try_gain(self, gain: Gain) -> Result<Self, FirstOrderError> {
        if gain.is_valid() { Ok(Self { gain, ..self }) } else { Err(FirstOrderError::Gain) }
    }

    /// [`Self::try_gain`] for a `static`.
    ///
    /// # Panics
    /// At compile time, if the gain is refused.
    #[must_use]
    pub const fn gain(self, gain: Gain) -> Self {
        match self.try_gain(gain) {
            Ok(controller) => controller,
            Err(FirstOrderError::Gain) => panic!("gain: must be positive and finite"),
        }
    }

    /// The same controller with this feed-forward.
    #[must_use]
    pub const fn feed_forward(self, feed_forward: FeedForward) -> Self {
        Self { feed_forward, ..self }
    }

    /// The same controller with this integrator.
    #[must_use]
    pub const fn integrator(self, integrator: Integrator) -> Self {
        Self { integrator, ..self }
    }

    #[inline(always)]
    pub(in crate::track) fn step<P: Patch>(
        &self,
        patch: &P,
        witness: &mut Witness,
        probe: Probe,
        period_s: f32,
    ) -> Step {
        let errors = ProjectionErrors::new(&witness.surface, probe.position);
        let squared = errors.difference.length_squared();
        let plain = self.descent(&errors, witness);
        let plain_gain = self.gain_for(&plain, patch, squared, period_s);
        let (descent, gain) = match self.feed_forward {
            FeedForward::None => (plain, plain_gain),
            FeedForward::Gated | FeedForward::Full => {
                let moved = probe.velocity * period_s;
                let descent = self.following(&errors, witness, moved, plain_gain);
                (descent, lower(plain_gain, self.gain_for(&descent, patch, squared, period_s)))
            }
        };
        witness.mode = descent.mode;
        if !is_above_zero(descent.slope) {
            return Step::at_rest(squared);
        }
        let change =
            integrator::change(self.integrator, patch, witness.parameters, descent.direction, gain, |surface, at| {
                let errors = ProjectionErrors::new(surface, probe.position);
                self.direction(&errors, at)
            });
        // A step that is not finite moves nothing.
        let Some(Landing { parameters, is_inside }) = boundary::advance(witness.parameters, change, gain) else {
            return Step::at_rest(squared);
        };
        let surface = patch.evaluate(parameters[0], parameters[1]);
        let outcome = if self.is_guarded() && rises(&witness.surface, &surface, probe.position, squared, patch.size()) {
            witness.is_free = false;
            witness.halvings = (witness.halvings + 1).min(MAX_HALVINGS);
            Outcome::Rejected
        } else {
            witness.halvings = 0;
            witness.is_free = is_inside;
            witness.parameters = parameters;
            witness.surface = surface;
            Outcome::Moved
        };
        Step { distance_squared_before: squared, residual_squared: plain.slope, gain, outcome }
    }

    /// The direction of the law, halved after rejected steps.
    #[inline(always)]
    fn descent(&self, errors: &ProjectionErrors, witness: &Witness) -> Descent {
        match self.law {
            Law::MeasureNumbers => Descent::of(errors, witness),
            Law::Covariant => Descent::projected_gradient(errors, witness.parameters).halved(witness.halvings),
        }
    }

    /// The direction of the law at `(u, v)`.
    #[inline(always)]
    fn direction(&self, errors: &ProjectionErrors, parameters: [f32; 2]) -> [f32; 2] {
        match self.law {
            Law::MeasureNumbers => Descent::new(errors, parameters).direction,
            Law::Covariant => Descent::projected_gradient(errors, parameters).direction,
        }
    }

    /// `K h` for a direction.
    #[inline(always)]
    fn gain_for<P: Patch>(&self, descent: &Descent, patch: &P, squared: f32, period_s: f32) -> f32 {
        let certified = || certified_gain(descent, &patch.bounds(), squared);
        match self.gain {
            Gain::Certified => certified(),
            Gain::Constant(gain) => lower(certified(), gain * period_s),
            Gain::Exponential(rate) => {
                let [w_u, w_v] = descent.direction;
                lower(certified(), rate * period_s * squared / (w_u * w_u + w_v * w_v))
            }
            Gain::Unlimited(gain) => gain * period_s,
        }
    }

    /// The direction that also follows the probe's motion; its slope is taken along the true gradient.
    #[inline]
    fn following(&self, errors: &ProjectionErrors, witness: &Witness, moved: Vec3, gain: f32) -> Descent {
        let gradient = feed_forward::gradient(self.feed_forward, errors, &witness.surface, moved, gain);
        let errors_ahead = ProjectionErrors { gradient, ..*errors };
        let descent = self.descent(&errors_ahead, witness);
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

/// The lower of a gain and its limit; NaN stays NaN.
#[inline]
fn lower(gain: f32, limit: f32) -> f32 {
    if limit < gain { limit } else { gain }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_that_no_controller_can_have_is_refused() {
        for gain in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            for gain in [Gain::Constant(gain), Gain::Exponential(gain), Gain::Unlimited(gain)] {
                assert_eq!(FirstOrder::CERTIFIED.try_gain(gain), Err(FirstOrderError::Gain), "{gain:?}");
            }
        }
        let chosen = FirstOrder::COVARIANT
            .gain(Gain::Constant(300.0))
            .feed_forward(FeedForward::Full)
            .integrator(Integrator::Heun);
        let FirstOrder { law, gain, feed_forward, integrator } = chosen;
        assert_eq!((law, gain), (Law::Covariant, Gain::Constant(300.0)));
        assert_eq!((feed_forward, integrator), (FeedForward::Full, Integrator::Heun));
        assert_eq!(chosen.try_gain(Gain::Certified), Ok(FirstOrder { gain: Gain::Certified, ..chosen }));
    }
}
