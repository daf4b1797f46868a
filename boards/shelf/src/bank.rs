//! A bank: the bytes of a body, and what must be structs in memory.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering};
use palpate::body::{Body, Edge, Face, FileError, Room};

/// Who holds a bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
enum Holder {
    /// Main, which may write it.
    Main = 0,
    /// Nobody: a body was checked and waits to be taken.
    Waiting = 1,
    /// The tick, which reads it.
    Tick = 2,
}

/// Memory for one body.
pub(crate) struct Bank<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    holder: AtomicU32,
    inside: UnsafeCell<Inside<WORDS, FACES, EDGES>>,
}

struct Inside<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    words: [u32; WORDS],
    faces: [Face<'static>; FACES],
    edges: [Edge<'static>; EDGES],
    /// Borrows from the three above while the bank is not main's.
    body: Option<Body<'static>>,
}

// SAFETY: what is inside is written only while main holds the bank, and there is one main (`Shelf::main`); it is read
// only while nobody or the tick holds it. The holder changes with release and is looked at with acquire.
unsafe impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Sync for Bank<WORDS, FACES, EDGES> {}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Bank<WORDS, FACES, EDGES> {
    pub const fn new() -> Self {
        Self {
            holder: AtomicU32::new(Holder::Main as u32),
            inside: UnsafeCell::new(Inside {
                words: [0; WORDS],
                faces: [Face::VACANT; FACES],
                edges: [Edge::VACANT; EDGES],
                body: None,
            }),
        }
    }

    fn is_held_by(&self, holder: Holder) -> bool {
        self.holder.load(Ordering::Acquire) == holder as u32
    }

    /// Changes hands, if it is in the first of them.
    fn pass(&self, from: Holder, to: Holder) -> bool {
        self.holder.compare_exchange(from as u32, to as u32, Ordering::AcqRel, Ordering::Acquire).is_ok()
    }

    /// Takes back a body that nobody has taken, and says whether the bank is main's.
    pub fn reclaim(&self) -> bool {
        self.pass(Holder::Waiting, Holder::Main) || self.is_held_by(Holder::Main)
    }

    /// Writes bytes at a place; false where they do not fit, or the bank is not main's.
    ///
    /// # Safety
    /// Only from main, of which there is one, and not while [`Self::check`] runs.
    pub unsafe fn write(&self, at: usize, bytes: &[u8]) -> bool {
        if !self.is_held_by(Holder::Main) {
            return false;
        }
        // SAFETY: main holds the bank and is here once, as the caller says: nobody else looks at the words.
        let words = unsafe { &mut (*self.inside.get()).words };
        let room = bytemuck::cast_slice_mut::<u32, u8>(words);
        let Some(place) = at.checked_add(bytes.len()).and_then(|end| room.get_mut(at..end)) else { return false };
        place.copy_from_slice(bytes);
        true
    }

    /// Checks what was written; a body waits to be taken from then on.
    ///
    /// # Safety
    /// As [`Self::write`].
    pub unsafe fn check(&self, bytes: usize) -> Result<(), FileError> {
        if !self.is_held_by(Holder::Main) {
            return Err(FileError::Magic);
        }
        // SAFETY: as above. The references live as long as the bank, which is 'static by `Shelf`'s bound, and nobody
        // writes behind them until the bank is main's again; by then the tick has let go of all of them.
        let inside: &'static mut Inside<WORDS, FACES, EDGES> = unsafe { &mut *self.inside.get() };
        let Inside { words, faces, edges, body } = inside;
        *body = None;
        let all: &'static [u8] = bytemuck::cast_slice::<u32, u8>(words);
        let Some(file) = all.get(..bytes) else { return Err(FileError::Magic) };
        *body = Some(Body::from_bytes(file, Room { faces, edges })?);
        self.pass(Holder::Main, Holder::Waiting);
        Ok(())
    }

    /// The tick takes a body that waits.
    pub fn take(&self) -> bool {
        self.pass(Holder::Waiting, Holder::Tick)
    }

    /// The tick lets go of it.
    pub fn leave(&self) {
        self.pass(Holder::Tick, Holder::Main);
    }

    /// The body, while the tick holds the bank.
    pub fn body(&self) -> Option<&Body<'static>> {
        if !self.is_held_by(Holder::Tick) {
            return None;
        }
        // SAFETY: the tick holds the bank: nobody writes it until the tick itself lets go of it, and it keeps no
        // reference beyond a call.
        unsafe { (*self.inside.get()).body.as_ref() }
    }
}
