//! Limit of the search effort: an import ends for every part.
//!
//! Effort is counted, not timed, so that the result does not depend on the machine's speed.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Maximum number of evaluated quads: about twenty seconds of a processor.
const MOST: u64 = 300_000_000;

/// The remaining effort, shared by all copies.
#[derive(Clone, Debug)]
pub struct Effort(Rc<Spent>);

#[derive(Debug)]
struct Spent {
    left: Cell<u64>,
    /// Effort spent on each face, by its label.
    faces: RefCell<BTreeMap<String, u64>>,
}

impl Default for Effort {
    fn default() -> Self {
        Self(Rc::new(Spent { left: Cell::new(MOST), faces: RefCell::default() }))
    }
}

impl Effort {
    /// Spends some effort.
    pub fn spend(&self, looks: u64) {
        self.0.left.set(self.0.left.get().saturating_sub(looks));
    }

    /// Whether nothing is left.
    pub fn is_spent(&self) -> bool {
        self.0.left.get() == 0
    }

    /// Restores all effort.
    pub fn renew(&self) {
        self.0.left.set(MOST);
    }

    /// Restores half of the effort: for improving a result that exists already.
    pub fn for_better(&self) {
        self.0.left.set(MOST / 2);
    }

    /// Does something for a face, and remembers what that took.
    pub fn on<R>(&self, label: &str, work: impl FnOnce() -> R) -> R {
        let before = self.0.left.get();
        let result = work();
        *self.0.faces.borrow_mut().entry(label.to_owned()).or_insert(0) += before - self.0.left.get();
        result
    }

    /// The face that the most went into.
    pub fn hardest(&self) -> Option<String> {
        let faces = self.0.faces.borrow();
        faces.iter().max_by_key(|(_, spent)| **spent).map(|(label, _)| label.clone())
    }
}
