//! What every board on the bench does alike because its core is a Cortex-M: it stops, hands the loop to its interrupt,
//! counts cycles, and copies what is hot into its fastest memory.

mod accept;
#[cfg(feature = "copy")]
mod copy;
mod cycles;
mod hand_over;
mod memo;
mod program;
mod stop;

pub use accept::{core_id, fail};
pub use cycles::Cycles;
pub use hand_over::HandOver;
pub use memo::MemoCell;
pub use program::{Below, Shared, Ticking};
pub use stop::bearing_nmi;
