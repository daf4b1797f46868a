//! How much is tried: an import comes to an end whatever the part.
//!
//! Counted, not timed, so that a part is imported on a slow machine if it is on a fast one.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// What may be spent, in looks at a quad that might be laid: some twenty seconds of a processor.
const MOST: u64 = 300_000_000;

/// What is left; all copies have it in common.
#[derive(Clone, Debug)]
pub struct Effort(Rc<Spent>);

#[derive(Debug)]
struct Spent {
    left: Cell<u64>,
    /// What went into each face, by its label.
    faces: RefCell<BTreeMap<String, u64>>,
}

impl Default for Effort {
    fn default() -> Self {
        Self(Rc::new(Spent { left: Cell::new(MOST), faces: RefCell::default() }))
    }
}

impl Effort {
    /// Spends some of it.
    pub fn spend(&self, looks: u64) {
        self.0.left.set(self.0.left.get().saturating_sub(looks));
    }

    /// Whether nothing is left.
    pub fn is_spent(&self) -> bool {
        self.0.left.get() == 0
    }

    /// All of it again.
    pub fn renew(&self) {
        self.0.left.set(MOST);
    }

    /// Half of it: for what is better than a result that is there.
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
