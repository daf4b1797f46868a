//! From the witness point to a force.
//!
//! [`crate::track::Contact`] is the state of contact. [`Penalty`] gives the push, or [`Hertz`] that of a dent, [`Friction`] the force along the
//! surface, [`Texture`] a ripple on top, [`Effects`] a pull and a drag near it; [`Coupling`] puts a virtual tool between probe and surface. [`Ease`] prevents
//! clicks. Then the force passes the limits of [`limit`] and, if configured, [`Passivity`]. [`bounds`] computes the
//! stable stiffness of a device; [`Feel`] is the feel of a dial, with [`Detents`] that click.

pub mod bounds;
mod coupling;
mod ease;
mod effects;
mod feel;
mod friction;
mod hertz;
mod knob;
pub mod limit;
mod material;
mod passivity;
mod penalty;
mod press;
mod texture;

pub use coupling::{Coupling, Tool};
pub use ease::{Ease, Eased, Reason};
pub use effects::{EffectError, EffectField, EffectLimits, Effects, Magnet, Viscosity};
pub use feel::{DialFriction, Ends, Feel, FeelError, FeelPart, Notch, Spring, Wave};
pub(crate) use feel::{nearest, wound};
pub use friction::{Anchor, Friction};
pub use hertz::Hertz;
pub use knob::{Detents, DetentsError};
pub use material::Material;
pub use passivity::{Energy, Moved, Passivity};
pub use penalty::Penalty;
pub use press::Press;
pub use texture::{Texture, TextureShape, Touch, grating};
