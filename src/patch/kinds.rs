//! The kinds of patches that an evaluation is compiled for: each kind has unrolled code of its own, which an image only
//! needs if its body has such patches.

/// A set of kinds of patches, known to the compiler.
pub trait Kinds: Copy {
    /// A bit for each kind: those of polynomial patches, and 16 places above them those of rational ones.
    const MASK: u32;
}

/// A set of kinds by its bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KindSet<const MASK: u32>;

/// Every kind.
pub const ALL_KINDS: u32 = u32::MAX;

impl<const MASK: u32> Kinds for KindSet<MASK> {
    const MASK: u32 = MASK;
}

/// Degrees with code of their own.
const DEGREES: [[u8; 2]; 11] = [[1, 1], [2, 2], [3, 3], [1, 2], [2, 1], [1, 3], [3, 1], [4, 4], [5, 5], [3, 5], [5, 3]];

/// The bit of patches of a degree; those without code of their own share one.
pub(super) const fn kind(degree: [u8; 2], is_rational: bool) -> u32 {
    let mut index = 0;
    while index < DEGREES.len() && (DEGREES[index][0] != degree[0] || DEGREES[index][1] != degree[1]) {
        index += 1;
    }
    1 << (index + if is_rational { 16 } else { 0 })
}

/// [`has`] for code that an image of every kind has no flash for.
pub(super) const fn has_own<K: Kinds, const D: usize>(degree: [u8; 2]) -> bool {
    K::MASK != ALL_KINDS && has::<K, D>(degree)
}

/// Whether polynomial (`D` is 3) or rational patches of this degree are of a set.
pub(super) const fn has<K: Kinds, const D: usize>(degree: [u8; 2]) -> bool {
    K::MASK & kind(degree, D == 4) != 0
}
