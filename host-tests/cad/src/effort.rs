//! Limit of the search effort: an import ends for every part.
//!
//! Effort is counted, not timed, so that the result does not depend on the machine's speed.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of evaluated quads: about twenty seconds of a processor.
const MOST: u64 = 300_000_000;

/// The start of a line of progress.
pub const PROGRESS: &str = "progress: ";
/// The time of the last one; `None` if none are wanted.
static TOLD: Mutex<Option<Instant>> = Mutex::new(None);

/// Turns lines of progress on, on standard error.
pub fn show_progress() {
    *TOLD.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
}

/// The remaining effort, shared by all copies.
#[derive(Clone, Debug)]
pub struct Effort(Rc<Spent>);

#[derive(Debug)]
struct Spent {
    left: Cell<u64>,
    /// Effort spent on each face, by its label.
    faces: RefCell<BTreeMap<String, u64>>,
}

/// Results of this import, by a hash of everything that they follow from, shared by all copies of the part: it is divided
/// many times, and most of its faces are as before.
#[derive(Clone, Debug, Default)]
pub struct Memory(Rc<RefCell<HashMap<u64, Box<dyn Any>>>>);

impl Memory {
    /// The result for a key.
    pub fn get<T: Clone + 'static>(&self, key: u64) -> Option<T> {
        self.0.borrow().get(&key).and_then(|result| result.downcast_ref()).cloned()
    }

    /// Keeps a result.
    pub fn keep<T: 'static>(&self, key: u64, result: T) {
        self.0.borrow_mut().insert(key, Box::new(result));
    }
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

    /// Restores all effort: for another way of dividing the part.
    pub fn renew(&self) {
        self.0.left.set(MOST);
    }

    /// Restores a quarter of the effort: for improving a result that exists already.
    pub fn for_better(&self) {
        self.0.left.set(MOST / 4);
    }

    /// Does something for a face, and remembers what that took.
    pub fn on<R>(&self, label: &str, work: impl FnOnce() -> R) -> R {
        self.tell(label);
        let before = self.0.left.get();
        let result = work();
        *self.0.faces.borrow_mut().entry(label.to_owned()).or_insert(0) += before - self.0.left.get();
        result
    }

    /// Prints the face in work on standard error, if [`show_progress`] was called: at most five lines a second.
    pub fn tell(&self, label: &str) {
        let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
        if told.is_some_and(|told| told.elapsed() >= Duration::from_millis(200)) {
            *told = Some(Instant::now());
            let percent = 100 - 100 * self.0.left.get() / MOST;
            eprintln!("{PROGRESS}{label}, {percent} % of the effort limit");
        }
    }

    /// The face that the most went into.
    pub fn hardest(&self) -> Option<String> {
        let faces = self.0.faces.borrow();
        faces.iter().max_by_key(|(_, spent)| **spent).map(|(label, _)| label.clone())
    }
}
