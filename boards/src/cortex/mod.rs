//! Shared by the bench boards, whose cores are Cortex-M: stopping, handing the loop to its interrupt, counting cycles,
//! copying the hot path into the fastest memory.

mod accept;
mod copies;
#[cfg(feature = "copy")]
mod copy;
mod cycles;
mod hand_over;
mod memo;
mod memory;
mod program;
mod stop;

pub use accept::{core_id, fail};
pub use copies::{ProgramCheck, ProgramCopy};
#[cfg(feature = "copy")]
pub use copy::program_check;
pub use cycles::Cycles;
pub use hand_over::HandOver;
pub use memo::MemoCell;
pub use memory::holds_its_bits;
pub use program::{Below, Shared, Ticking};
pub use stop::bearing_nmi;
