//! Feel of the loop, in figures.
//!
//! A scripted hand ([`Script`]) holds a simulated device that touches a wall or a body; [`record`] runs the library's
//! loop against it, and [`Figures`] measures the force on the hand in the recording: the largest step between two
//! ticks, ripple by bands, and how far the ripple lies above the threshold of perception ([`Threshold`],
//! [`Sensation`]).

mod edges;
mod figures;
mod hand;
mod record;
pub mod recorded;
mod script;
mod sensation;
mod spectrum;
mod threshold;
mod wall;

pub use edges::{ROUND, over_edges};
pub use figures::{Figures, Steps, angle};
pub use hand::Legs;
pub use record::{Recording, RunError, Tick, record};
pub use script::{Deed, Script, Stage};
pub use sensation::{Sensation, thirds};
pub use spectrum::{BANDS, Band, Spectrum};
pub use threshold::{Threshold, ThresholdError};
pub use wall::wall;
