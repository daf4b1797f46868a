//! The ground of a loop: a body, rigid or one that gives way, touched by a point or a tool, or a dial.

use crate::body::{Loaded, Standing};
use crate::felt::Felt;
use crate::handle::Handle;
use crate::held::Kept;
use crate::soft::{SoftStanding, Softened};
use crate::status::Status;
use palpate_core::body::Body;
use palpate_core::pair::ToolSurface;
use palpate_core::servo::{Knob, KnobWitness, SoftBody, Surface};

/// Words of a servo's handle: of 32 bits on a microcontroller, of 64 on most hosts.
pub const SERVO_WORDS: usize = if size_of::<usize>() == 4 { 500 } else { 260 };

/// A ground that a loop can render: the handle of a body, or a dial.
pub trait Rendered {
    /// The surface of the loop.
    type Surface: Dialled + 'static;
    /// Its own memory in the loop's.
    type Kept: 'static;
    /// Words of the loop's handle.
    const WORDS: usize = SERVO_WORDS;

    /// To stand on it.
    ///
    /// # Safety
    /// As [`Handle::get`], for as long as anything stands on it; `kept` is memory of the loop, which stays.
    unsafe fn stand(self, kept: *mut Self::Kept) -> Result<(Ground, &'static Felt<Self::Surface>), Status>;
}

/// A surface that may be a dial.
pub trait Dialled: Surface {
    /// The dial and its state, if it is one.
    fn dial<'a>(&'a self, _: &'a mut Self::Witness) -> Option<(&'a Knob, &'a mut KnobWitness)> {
        None
    }
}

impl Dialled for Body<'_> {}
impl Dialled for SoftBody<'_> {}
impl Dialled for ToolSurface<'_> {}

impl Dialled for Knob {
    fn dial<'a>(&'a self, state: &'a mut KnobWitness) -> Option<(&'a Knob, &'a mut KnobWitness)> {
        Some((self, state))
    }
}

/// The handle that a loop stands on.
#[derive(Clone, Copy)]
pub enum Ground {
    Rigid(Standing),
    Soft(SoftStanding),
    /// A body, and the tool on it in the loop's memory.
    Tool(*mut Kept),
    /// None: the surface lies in the loop itself.
    Own,
}

impl Ground {
    /// Whether it is still there.
    ///
    /// # Safety
    /// As [`Handle::get`].
    pub unsafe fn check(self) -> Result<(), Status> {
        // SAFETY: by the caller's promise.
        unsafe {
            match self {
                Self::Rigid(standing) => standing.body().map(|_| ()),
                Self::Soft(standing) => standing.check(),
                Self::Tool(kept) => Kept::check(kept),
                Self::Own => Ok(()),
            }
        }
    }
}

impl Rendered for *const Handle<Loaded> {
    type Surface = Body<'static>;
    type Kept = ();

    unsafe fn stand(self, _: *mut ()) -> Result<(Ground, &'static Felt), Status> {
        // SAFETY: by the caller's promise.
        let (standing, felt) = unsafe { Standing::on(self) }?;
        Ok((Ground::Rigid(standing), felt))
    }
}

impl Rendered for *const Handle<Softened> {
    type Surface = SoftBody<'static>;
    type Kept = ();

    unsafe fn stand(self, _: *mut ()) -> Result<(Ground, &'static Felt<SoftBody<'static>>), Status> {
        // SAFETY: by the caller's promise.
        let (standing, felt) = unsafe { Softened::stand(self) }?;
        Ok((Ground::Soft(standing), felt))
    }
}

impl Rendered for Knob {
    type Surface = Self;
    type Kept = Felt<Self>;

    unsafe fn stand(self, kept: *mut Felt<Self>) -> Result<(Ground, &'static Felt<Self>), Status> {
        // SAFETY: by the caller's promise.
        let felt = unsafe {
            kept.write(Felt(self));
            &*kept
        };
        Ok((Ground::Own, felt))
    }
}
