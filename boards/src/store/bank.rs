//! A bank: a body, and who holds it.

use core::cell::UnsafeCell;
use palpate::body::{Body, BodyBuffer, Edge, Effort, Face, FileError, Side, TickLimit};
use portable_atomic::{AtomicU32, Ordering};

/// The holder of a bank.
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

/// A body in a file that lies elsewhere, and what must be structs in RAM of it.
pub(crate) struct Bank<const FACES: usize, const EDGES: usize> {
    holder: AtomicU32,
    built: UnsafeCell<Built<FACES, EDGES>>,
    /// Of ticks on its bodies.
    effort: Effort,
}

struct Built<const FACES: usize, const EDGES: usize> {
    faces: [Face<'static>; FACES],
    edges: [Edge<'static>; EDGES],
    /// Borrows from the two above, and from the file, while the bank is not main's.
    body: Option<Body<'static>>,
}

impl<const FACES: usize, const EDGES: usize> Built<FACES, EDGES> {
    /// Lets go of every reference.
    fn clear(&mut self) {
        self.body = None;
        self.faces.fill(Face::VACANT);
        self.edges.fill(Edge::VACANT);
    }

    /// No face of a body has four poles, no edge the degree 0.
    fn is_vacant(&self) -> bool {
        let has_poles = |face: &Face<'_>| face.sides.iter().all(|side| matches!(side, Side::Pole { .. }));
        self.body.is_none() && self.faces.iter().all(has_poles) && self.edges.iter().all(|edge| edge.curve.degree == 0)
    }
}

// SAFETY: the content is written only while main holds the bank, and there is one main, as the callers of `check`
// say; it is read only while nobody or the tick holds it. The holder changes with release and is looked at with
// acquire.
unsafe impl<const FACES: usize, const EDGES: usize> Sync for Bank<FACES, EDGES> {}

impl<const FACES: usize, const EDGES: usize> Bank<FACES, EDGES> {
    pub const fn new(effort: Effort) -> Self {
        Self {
            effort,
            holder: AtomicU32::new(Holder::Main as u32),
            built: UnsafeCell::new(Built { faces: [Face::VACANT; FACES], edges: [Edge::VACANT; EDGES], body: None }),
        }
    }

    fn is_held_by(&self, holder: Holder) -> bool {
        self.holder.load(Ordering::Acquire) == holder as u32
    }

    /// Changes hands, if it is in the first of them.
    fn pass(&self, from: Holder, to: Holder) -> bool {
        self.holder.compare_exchange(from as u32, to as u32, Ordering::AcqRel, Ordering::Acquire).is_ok()
    }

    /// Whether main may write the file.
    pub fn is_mains(&self) -> bool {
        self.is_held_by(Holder::Main)
    }

    /// Takes back a body that nobody has taken, and says whether the bank is main's. Then it has no reference to the
    /// file left, which main may write.
    ///
    /// # Safety
    /// Only from main, of which there is one, and not while [`Self::check`] runs.
    pub unsafe fn reclaim(&self) -> bool {
        let is_mains = self.pass(Holder::Waiting, Holder::Main) || self.is_mains();
        if is_mains {
            // SAFETY: main holds the bank and is here once, as the caller says: nobody else looks at the content.
            unsafe { (*self.built.get()).clear() };
        }
        is_mains
    }

    /// Whether no reference of a body is left in it. `false` while it is not main's.
    ///
    /// # Safety
    /// As [`Self::reclaim`].
    pub unsafe fn is_vacant(&self) -> bool {
        // SAFETY: main holds the bank where it is looked at, and is here once, as the caller says.
        self.is_mains() && unsafe { &*self.built.get() }.is_vacant()
    }

    /// Checks a file; its body waits to be taken from then on. `pause` is called meanwhile.
    ///
    /// # Safety
    /// Only from main, of which there is one, and not from within `pause`. The file does not change until the bank is
    /// main's again, and the bank is a `static`.
    pub unsafe fn check(&self, file: &'static [u8], pause: &mut dyn FnMut()) -> Result<(), FileError> {
        if !self.is_mains() {
            return Err(FileError::Magic);
        }
        // SAFETY: main holds the bank and is here once, as the caller says: nobody else looks at the content. The
        // references live as long as the bank, which is a `static`, and nobody writes behind them until the bank is
        // main's again; by then the tick has let go of all of them.
        let built: &'static mut Built<FACES, EDGES> = unsafe { &mut *self.built.get() };
        built.clear();
        let Built { faces, edges, body } = built;
        match Body::from_bytes_with(file, BodyBuffer { faces, edges }, TickLimit::BENCH, pause) {
            // Not above the effort with which its ticks fit.
            Ok(found) => *body = Some(found.with_effort(self.effort.min(found.effort()))),
            Err(error) => {
                // SAFETY: as above, and nothing of `built` is used any more.
                unsafe { (*self.built.get()).clear() };
                return Err(error);
            }
        }
        self.pass(Holder::Main, Holder::Waiting);
        Ok(())
    }

    /// The tick takes a body that waits.
    pub fn take(&self) -> bool {
        self.pass(Holder::Waiting, Holder::Tick)
    }

    /// The tick lets go of it, and may take it again while main does not want it.
    pub fn put_down(&self) {
        self.pass(Holder::Tick, Holder::Waiting);
    }

    /// The tick lets go of it, for main.
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
        unsafe { (*self.built.get()).body.as_ref() }
    }
}
