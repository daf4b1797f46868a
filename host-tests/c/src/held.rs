//! A tool in the memory of its loop.

use crate::body::Standing;
use crate::felt::Felt;
use crate::status::Status;
use core::ptr::{NonNull, addr_of};
use palpate_core::device::{Wrist, WristState};
use palpate_core::pair::{HeldTool, ToolSurface};

/// A loop with a tool, whatever its arm and its guard.
pub trait Oriented {
    /// The state of the tool.
    fn held(&self) -> &HeldTool;
    /// Notes the orientation from the counts of arm and wrist.
    fn orient(&mut self, wrist: &Wrist, memory: &mut WristState, counts: [[i32; 3]; 2]) -> Result<(), Status>;
}

/// Memory of a tool in its loop's.
pub struct Kept {
    /// The surface, to which the loop refers.
    pub felt: Felt<ToolSurface<'static>>,
    /// The body.
    pub standing: Standing,
    /// The last angles of the wrist.
    pub wrist: WristState,
    /// The loop beside it, once that is there.
    pub oriented: Option<NonNull<dyn Oriented>>,
}

impl Kept {
    /// Whether the body is still there.
    ///
    /// # Safety
    /// As [`Standing::body`], and `kept` is that of a loop.
    pub unsafe fn check(kept: *const Self) -> Result<(), Status> {
        // SAFETY: by the caller's promise. A part of it is looked at, never all of it at once.
        unsafe { addr_of!((*kept).standing).read().body().map(|_| ()) }
    }
}
