//! How many words of the caller's memory each handle takes; the header says the same, and a test compares them.

use crate::body::Loaded;
use crate::ground::SERVO_WORDS;
use crate::handle::Handle;
use crate::link::Listening;
use crate::pair::Paired;
use crate::servo::Started;
use crate::soft::Softened;
use crate::tracker::Tracking;
use palpate_core::body::{Edge, Face};
use palpate_core::field::Mode;

/// Whether words are of 32 bits, as on a microcontroller, or of 64, as on most hosts.
const NARROW: bool = size_of::<usize>() == 4;

/// Words of a face in the buffer of a body.
pub const FACE_WORDS: usize = if NARROW { 57 } else { 45 };
/// Words of an edge in the buffer of a body.
pub const EDGE_WORDS: usize = if NARROW { 13 } else { 9 };
/// Words of a body.
pub const BODY_WORDS: usize = if NARROW { 28 } else { 23 };
/// Words of a mode in the buffer of a body that gives way.
pub const MODE_WORDS: usize = if NARROW { 43 } else { 22 };
/// Words of a body that gives way.
pub const SOFT_BODY_WORDS: usize = if NARROW { 84 } else { 56 };
/// Words of a tracker.
pub const TRACKER_WORDS: usize = if NARROW { 76 } else { 40 };
/// Words of a pair.
pub const PAIR_WORDS: usize = if NARROW { 56 } else { 32 };
/// Words of a receiver.
pub const RECEIVER_WORDS: usize = if NARROW { 38 } else { 22 };

/// A few words are spare, so that a handle may grow without a new header.
const fn holds<T>(words: usize) {
    assert!(size_of::<T>() <= words * size_of::<usize>() && align_of::<T>() <= align_of::<usize>());
}

const _: () = holds::<Face>(FACE_WORDS);
const _: () = holds::<Edge>(EDGE_WORDS);
const _: () = holds::<Handle<Loaded>>(BODY_WORDS);
const _: () = holds::<Mode>(MODE_WORDS);
const _: () = holds::<Handle<Softened>>(SOFT_BODY_WORDS);
const _: () = holds::<Handle<Tracking>>(TRACKER_WORDS);
const _: () = holds::<Handle<Paired>>(PAIR_WORDS);
const _: () = holds::<Handle<Started>>(SERVO_WORDS);
const _: () = holds::<Handle<Listening>>(RECEIVER_WORDS);
