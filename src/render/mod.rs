//! From the witness point to a force.
//!
//! [`crate::track::Contact`] says whether the surface is touched. [`Penalty`] says how it pushes back, [`Friction`] how
//! it holds along the surface, [`Texture`] what is added; [`Coupling`] puts a virtual tool between probe and surface.
//! [`Ease`] keeps it from clicking. Then the force passes the limits of [`limit`] and, if configured, [`Passivity`]. [`bounds`] says beforehand what a device can bear; [`Feel`] is what a dial feels
//! like, with [`Detents`] that click.

pub mod bounds;
mod coupling;
mod ease;
mod feel;
mod friction;
mod knob;
pub mod limit;
mod material;
mod passivity;
mod penalty;
mod press;
mod texture;

pub use coupling::{Coupling, Tool};
pub use ease::{Ease, Eased, Reason};
pub use feel::{Ends, Feel, FeelError, Spring, Wave};
pub use friction::{Anchor, Friction};
pub use knob::{Detents, DetentsError};
pub use material::Material;
pub use passivity::{Energy, Moved, Passivity};
pub use penalty::Penalty;
pub use press::Press;
pub use texture::{Texture, Touch, grating};
