//! The ground of a loop: a body, rigid or one that gives way.

use crate::body::{Loaded, Standing};
use crate::felt::Felt;
use crate::handle::{Handle, Kind};
use crate::soft::{SoftStanding, Softened};
use crate::status::Status;
use palpate_core::body::Body;
use palpate_core::servo::{SoftBody, Surface};

/// A handle that a loop can render.
pub trait Rendered: Kind {
    /// The surface of the loop.
    type Surface: Surface + 'static;

    /// To stand on it.
    ///
    /// # Safety
    /// As [`Handle::get`], for as long as anything stands on it.
    unsafe fn stand(place: *const Handle<Self>) -> Result<(Ground, &'static Felt<Self::Surface>), Status>;
}

/// The handle that a loop stands on.
#[derive(Clone, Copy)]
pub enum Ground {
    Rigid(Standing),
    Soft(SoftStanding),
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
            }
        }
    }
}

impl Rendered for Loaded {
    type Surface = Body<'static>;

    unsafe fn stand(place: *const Handle<Self>) -> Result<(Ground, &'static Felt), Status> {
        // SAFETY: by the caller's promise.
        let (standing, felt) = unsafe { Standing::on(place) }?;
        Ok((Ground::Rigid(standing), felt))
    }
}

impl Rendered for Softened {
    type Surface = SoftBody<'static>;

    unsafe fn stand(place: *const Handle<Self>) -> Result<(Ground, &'static Felt<SoftBody<'static>>), Status> {
        // SAFETY: by the caller's promise.
        let (standing, felt) = unsafe { Self::stand(place) }?;
        Ok((Ground::Soft(standing), felt))
    }
}
