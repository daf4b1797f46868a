//! What can be chosen about the controller. All of it is configuration: in a `static` the choice is made by the
//! compiler and what is not chosen leaves no code in the image.

/// Which direction drives the witness point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// The minimiser of the quadratic model of `½ ‖ΔR‖²` over the whole patch, in full where the distance is proved to
    /// fall, otherwise as much of it as is proved to, or the step of [`Self::MeasureNumbers`], whichever is proved to
    /// bring more (theory §12). Converges quadratically. The certified gain, no feed-forward and Euler belong to it;
    /// with another choice of these it is [`Self::MeasureNumbers`].
    SecondOrder,
    /// Eq. (1): the projection errors as measure numbers, `−Ψ = −I⁻¹ g`; along an edge `−g_v/G` or `−g_u/E`.
    /// Insensitive to the parametrisation.
    #[default]
    MeasureNumbers,
    /// The projected gradient `−g / (E + G)`, each component that points outward at a border set to zero. The plain
    /// gradient flow of `½ ‖ΔR‖²` in another time: simpler, and slow where `I` is ill-conditioned.
    Covariant,
}

/// How fast: the gain `K`, 1/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gain {
    /// The largest that is proved to lower the distance, tick by tick (see [`super::certified_gain`]).
    #[default]
    Certified,
    /// This `K`, 1/s, or the certified gain where that is less.
    Constant(f32),
    /// Remark 1: `K = rate · ‖ΔR‖² / (Ψᵘ² + Ψᵛ²)`, `rate` in 1/(m² s), or the certified gain where that is less.
    /// Without a bound it would grow beyond all limits as the witness point arrives.
    Exponential(f32),
    /// This `K`, 1/s, whatever comes of it: no certificate, no step undone. For measuring where the limits lie.
    Unlimited(f32),
}

/// What is done with the probe's motion (Remark 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FeedForward {
    /// Nothing: motion is a disturbance, and the witness point lags.
    #[default]
    None,
    /// Eq. (13): motion that would raise a projection error is cancelled, motion that lowers it is kept.
    Gated,
    /// `ẋ = I⁻¹ Jᵀ q̇ − K Ψ`: all motion is followed.
    Full,
}

/// How the flow is integrated over a tick (Remark 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
