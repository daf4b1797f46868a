//! The choices of a first-order controller. In a `static` the compiler makes the choice and drops the code of the other
//! options.

/// Direction in which the witness point moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Law {
    /// Eq. (1): the projection errors as measure numbers, `−Ψ = −I⁻¹ g`; along an edge `−g_v/G` or `−g_u/E`.
    /// Independent of the parametrisation.
    #[default]
    MeasureNumbers,
    /// The projected gradient `−g / (E + G)`, each component that points outward at a border set to zero: the gradient
    /// flow of `½ ‖ΔR‖²` with time rescaled. Simpler, and slow where `I` is ill-conditioned.
    Covariant,
}

/// Gain `K`, 1/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Gain {
    /// The largest gain that is proved to lower the distance, computed each tick (see
    /// [`certified_gain`](crate::track::certified_gain)).
    #[default]
    Certified,
    /// This `K`, 1/s, or the certified gain if that is lower.
    Constant(f32),
    /// Remark 1: `K = rate · ‖ΔR‖² / (Ψᵘ² + Ψᵛ²)`, `rate` in 1/(m² s), or the certified gain if that is lower.
    /// Without this bound `K` would grow without limit as the witness point arrives.
    Exponential(f32),
    /// This `K`, 1/s, without a certificate and without rejected steps: for measuring where the limits lie.
    Unlimited(f32),
}

impl Gain {
    /// Whether the gain is positive and finite.
    pub(super) const fn is_valid(self) -> bool {
        match self {
            Self::Certified => true,
            Self::Constant(gain) | Self::Exponential(gain) | Self::Unlimited(gain) => {
                gain > 0.0 && gain < f32::INFINITY
            }
        }
    }
}

/// Use of the probe's velocity (Remark 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeedForward {
    /// None: motion is a disturbance, and the witness point lags.
    #[default]
    None,
    /// Eq. (13): motion that would raise a projection error is cancelled, motion that lowers it is kept.
    Gated,
    /// `ẋ = I⁻¹ Jᵀ q̇ − K Ψ`: all motion is followed.
    Full,
}

/// Integration of the flow over a tick (Remark 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Integrator {
    /// One evaluation of the patch a tick.
    #[default]
    Euler,
    /// Two evaluations.
    Heun,
    /// Four evaluations.
    RungeKutta4,
}

impl Integrator {
    /// Evaluations of the patch a tick.
    pub const fn evaluations(self) -> u32 {
        match self {
            Self::Euler => 1,
            Self::Heun => 2,
            Self::RungeKutta4 => 4,
        }
    }

    /// `z`: the integrator is stable for a mode of rate `λ` and a step `h` while `λ h < z`.
    pub const fn stability_bound(self) -> f32 {
        match self {
            Self::Euler | Self::Heun => 2.0,
            // The real zero of 1 + z/2 + z²/6 + z³/24 below 0, negated.
            Self::RungeKutta4 => 2.785_293_6,
        }
    }
}
