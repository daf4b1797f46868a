//! The switching controller of Theorem 1: one step a tick.

use super::boundary::{self, Descent};
use super::gain::certified_gain;
use super::law::{FeedForward, Gain, Integrator, Law};
use super::projection::ProjectionErrors;
use super::witness::{Outcome, Probe, Step, Witness};
use super::{feed_forward, integrate};
use crate::math::{ROOT_EXCESS, Vec3, sqrt, sqrt_from_above};
use crate::patch::{Patch, SurfacePoint};

/// The controller's configuration. Keep it in a `static`: what is not chosen costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controller {
    /// Which direction.
    pub law: Law,
    /// How fast.
    pub gain: Gain,
    /// What is done with motion.
    pub feed_forward: FeedForward,
    /// How the flow is integrated.
    pub integrator: Integrator,
}

/// A rise of the squared distance is rounding as long as it is below this many units in the last place of the coordinates
/// and the size (partial sums are as large as either), times the distance. Horner's rule at degree 5 in both
/// parameters rounds about 20 times a coordinate, at both ends of a step, and uneven weights double it; a rise `δ` of the
/// distance shows as `2 R δ`. So `V` may rise by 32 units in the last place, 4 µm on a body of 1 m.
const ROUNDING: f32 = 64.0 * f32::EPSILON;
/// Caution never goes below this, so that a witness point is never stuck for good.
const LEAST_CAUTION: f32 = 1.0 / 1024.0;

impl Controller {
    /// Theorem 1 at the largest gain that is proved monotone, one evaluation a tick: the default on the target.
    pub const CERTIFIED: Self = Self {
        law: Law::MeasureNumbers,
        gain: Gain::Certified,
        feed_forward: FeedForward::None,
        integrator: Integrator::Euler,
    };

    /// One step of the chosen law towards the point of the patch closest to the probe, over `period` seconds.
    ///
    /// Invariance: `(u, v)` stays in `[0, 1]²`. Descent, unless the gain is [`Gain::Unlimited`]: the computed distance to
    /// the probe never rises by more than rounding; a step that would is undone. With [`Integrator::Euler`] and bounds that hold none
    /// has to be. Work: [`Integrator::evaluations`] of the patch. No panic; a probe that is not finite leaves the witness
    /// point where it is.
    ///
    /// Inlined where it is called, so that the compiler sees what is chosen there and drops the rest.
    #[inline(always)]
    pub fn step<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Probe, period: f32) -> Step {
        let errors = ProjectionErrors::new(&witness.surface, probe.position);
        let squared = errors.difference.length_squared();
        let plain = Descent::new(self.law, &errors, witness.parameters);
        let plain_gain = self.gain_for(&plain, patch, squared, witness.caution, period);
        let (descent, gain) = match self.feed_forward {
            FeedForward::None => (plain, plain_gain),
            FeedForward::Gated | FeedForward::Full => {
                let moved = probe.velocity * period;
                let descent = self.following(&errors, &witness.surface, witness.parameters, moved, plain_gain);
                (descent, plain_gain.min(self.gain_for(&descent, patch, squared, witness.caution, period)))
            }
        };
        witness.mode = descent.mode;
        let moves = is_positive(descent.slope) && squared.to_bits() < f32::INFINITY.to_bits();
        if !moves {
            let outcome = Outcome::AtRest;
            return Step { distance_squared_before: squared, residual_squared: 0.0, gain: 0.0, outcome };
        }
        let change =
            integrate::change(self.integrator, patch, witness.parameters, descent.direction, gain, |surface, at| {
                let errors = ProjectionErrors::new(surface, probe.position);
                Descent::new(self.law, &errors, at).direction
            });
        let parameters = boundary::advance(witness.parameters, change, gain);
        let surface = patch.evaluate(parameters[0], parameters[1]);
        let outcome = if self.is_guarded() && rises(&witness.surface, &surface, probe.position, squared, patch.size()) {
            witness.caution = (0.5 * witness.caution).max(LEAST_CAUTION);
            Outcome::Undone
        } else {
            // A power of two: doubled it meets 1.
            if witness.caution < 1.0 {
                witness.caution *= 2.0;
            }
            witness.parameters = parameters;
            witness.surface = surface;
            Outcome::Moved
        };
        Step { distance_squared_before: squared, residual_squared: plain.slope, gain, outcome }
    }

    /// `K h` for a direction.
    #[inline(always)]
    fn gain_for<P: Patch>(&self, descent: &Descent, patch: &P, squared: f32, caution: f32, period: f32) -> f32 {
        let certified = || certified_gain(descent, &patch.bounds(), squared) * caution;
        match self.gain {
            Gain::Certified => certified(),
            Gain::Constant(gain) => certified().min(gain * period),
            Gain::Exponential(rate) => {
                let [w_u, w_v] = descent.direction;
                certified().min(rate * period * squared / (w_u * w_u + w_v * w_v))
            }
            Gain::Unlimited(gain) => gain * period,
        }
    }

    /// The direction that also follows the probe's motion; its slope is taken along the true gradient.
    #[inline]
    fn following(
        &self,
        errors: &ProjectionErrors,
        surface: &SurfacePoint,
        parameters: [f32; 2],
        moved: Vec3,
        gain: f32,
    ) -> Descent {
        let gradient = feed_forward::gradient(self.feed_forward, errors, surface, moved, gain);
        let descent = Descent::new(self.law, &ProjectionErrors { gradient, ..*errors }, parameters);
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

/// Whether `0 < x < ∞`; false for NaN. As bits it is one comparison.
#[inline]
fn is_positive(x: f32) -> bool {
    x.to_bits().wrapping_sub(1) < f32::INFINITY.to_bits() - 1
}

/// Whether the squared distance rose by more than rounding. Written so that NaN counts as a rise.
#[inline(always)]
fn rises(before: &SurfacePoint, after: &SurfacePoint, probe: Vec3, squared: f32, size: f32) -> bool {
    let now = (after.point - probe).length_squared();
    if now <= squared {
        return false;
    }
    // The size alone is most often enough, with a root that is not above the distance.
    if now - squared <= (ROUNDING / ROOT_EXCESS) * size * sqrt_from_above(squared) {
        return false;
    }
    let coordinates = (before.point.abs() + probe.abs()).max_element() + size;
    let within_rounding = now - squared <= ROUNDING * coordinates * sqrt(squared);
    !within_rounding
}
