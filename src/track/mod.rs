//! One controller step on one patch: the switching controller of Theorem 1 of Patoglu and Gillespie, to second order.
//!
//! Conventions: `Q` is the probe in the body's frame, `P = f(u, v)` the witness point, `ΔR = P − Q`. The projection
//! errors `Ψ` are the measure numbers of `ΔR` in the basis of the tangents (Eq. (4)): `ΔR = Ψᵘ f_u + Ψᵛ f_v + Δ N`. `V
//! = ‖ΔR‖ − E`, with `E` the minimum distance, is the Lyapunov function of every mode.
//!
//! [`Controller::SecondOrder`], the default, goes to the minimiser of the quadratic model of the distance over the
//! square, as far as the distance is proved to fall (theory §12). Where no such step is certified it takes the
//! first-order one: [`ProjectionErrors`] of the new probe at the cached surface point → [`Descent`], the direction
//! that the boundary allows and its [`BoundaryMode`] → [`certified_gain`], the longest step proved to lower the
//! distance → cut at the patch's border → one evaluation of the patch → kept unless the distance rose. The paper's own
//! laws are [`FirstOrder`].

mod aim;
mod border;
mod boundary;
mod contact;
mod controller;
mod gain;
mod paper;
mod placement;
mod projection;
mod rounding;
mod second_order;
mod witness;

pub(crate) use aim::Aim;
pub use border::BoundaryMode;
pub(crate) use border::{is_inside, mode_at};
pub use boundary::Descent;
pub use contact::Contact;
pub use controller::Controller;
pub use gain::certified_gain;
pub use paper::{
    CommonNormalStep, CommonNormalTracker, FeedForward, FirstOrder, FirstOrderError, Gain, Integrator, Law, PairStep,
    PairTracker, PairWitness, PerformanceLimits,
};
pub use placement::Placement;
pub use projection::{FirstFundamentalForm, ProjectionErrors};
pub(crate) use second_order::shifted;
pub use witness::{Outcome, Probe, Step, Witness};
