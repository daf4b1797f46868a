//! Memory for bodies from a host, of a board that has plenty of RAM. Its flash is where its own program lies, which
//! cannot be read while it is written: no body is kept there.

use palpate_bench::Idle;
use palpate_shelf::{Bodies, Writing};

/// 48 KB a bank, and faces and edges of some 100 patches.
const WORDS: usize = 12_288;
const FACES: usize = 120;
const EDGES: usize = 300;

/// Where uploaded bodies lie.
pub type Shelf = Bodies<WORDS, FACES, EDGES>;

/// For the slot of the scene.
pub static SHELF: Shelf = Bodies::new();

/// Main's end of it.
pub struct Ends(Option<Writing<WORDS, FACES, EDGES>>);

/// Main's end, once.
pub fn ends() -> Ends {
    Ends(SHELF.main())
}

impl Ends {
    /// What the host is told that there is.
    pub fn offer<'a>(&'a self, idle: Idle<'a>) -> Idle<'a> {
        match &self.0 {
            Some(memory) => idle.taking(memory),
            None => idle,
        }
    }
}
