//! What is chosen of the controller, one choice after the other, as in `Controller::CERTIFIED.law(Law::Covariant)`.

use super::controller::Controller;
use super::law::{FeedForward, Gain, Integrator, Law};
use thiserror::Error;

/// Which choice is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ControllerError {
    /// The gain is not positive and finite.
    #[error("the gain must be positive and finite")]
    Gain,
}

impl Controller {
    /// The same controller with this law.
    #[must_use]
    pub const fn law(self, law: Law) -> Self {
        Self { law, ..self }
    }

    /// The same controller with this gain.
    ///
    /// # Errors
    /// A gain that is not positive and finite.
    pub const fn try_gain(self, gain: Gain) -> Result<Self, ControllerError> {
        let is_good = match gain {
            Gain::Certified => true,
            Gain::Constant(gain) | Gain::Exponential(gain) | Gain::Unlimited(gain) => {
                gain > 0.0 && gain < f32::INFINITY
            }
        };
        if is_good { Ok(Self { gain, ..self }) } else { Err(ControllerError::Gain) }
    }

    /// [`Self::try_gain`] for a `static`.
    ///
    /// # Panics
    /// At compile time, where the gain is refused.
    #[must_use]
    pub const fn gain(self, gain: Gain) -> Self {
        match self.try_gain(gain) {
            Ok(controller) => controller,
            Err(ControllerError::Gain) => panic!("gain"),
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_that_no_controller_can_have_is_refused() {
        for gain in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            for gain in [Gain::Constant(gain), Gain::Exponential(gain), Gain::Unlimited(gain)] {
                assert_eq!(Controller::CERTIFIED.try_gain(gain), Err(ControllerError::Gain), "{gain:?}");
            }
        }
        let chosen = Controller::CERTIFIED
            .law(Law::Covariant)
            .gain(Gain::Constant(300.0))
            .feed_forward(FeedForward::Full)
            .integrator(Integrator::Heun);
        let Controller { law, gain, feed_forward, integrator } = chosen;
        assert_eq!((law, gain), (Law::Covariant, Gain::Constant(300.0)));
        assert_eq!((feed_forward, integrator), (FeedForward::Full, Integrator::Heun));
        assert_eq!(chosen.try_gain(Gain::Certified), Ok(Controller { gain: Gain::Certified, ..chosen }));
    }
}
