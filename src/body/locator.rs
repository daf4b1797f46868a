//! The locator: an octree in flash that lists the parts of faces that can own the closest point of a probe.
//!
//! A leaf is a list of candidates, each a rectangle of the parameters of one face. The host proves, where it can, that
//! the closest point of every probe of the cell is in one of them, and that the distance has one minimum in each.

use crate::math::Vec3;

/// Maximum depth of the octree.
pub const MAX_DEPTH: usize = 10;
/// Intervals of the grid on which the rectangles of candidates have their corners.
pub const GRID: u32 = 31;
/// Maximum number of faces of a body: the range of an entry's ten bits.
pub const MAX_FACES: usize = 1 << 10;
/// Maximum number of candidates in a list: all faces.
pub const MAX_LIST: usize = MAX_FACES;
/// Maximum number of nodes and entries together: the range of a child's sixteen bits.
pub const MAX_CHILDREN: usize = 1 << 16;

/// The octree, part of the tables of a body.
///
/// ```
/// use palpate::body::{Candidate, Lists, Locator};
/// use palpate::math::{Vec3, vec3};
///
/// // One face for all probes: a root whose eight children are the same list.
/// static NODES: [[u16; 8]; 1] = [[1; 8]];
/// let locator = Locator { corner: Vec3::ZERO, side: 0.1, nodes: &NODES, lists: Lists::WHOLE };
/// let first = locator.list(vec3(0.02, 0.09, 0.05));
/// assert_eq!(locator.candidate(first).map(|candidate| candidate.upper), Some([31; 2]));
/// assert!(!locator.holds(vec3(0.2, 0.0, 0.0)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Locator<'a> {
    /// The lower corner of the root cube, metres, in the body's frame.
    pub corner: Vec3,
    /// The root cube's side, metres.
    pub side: f32,
    /// Inner nodes, the first is the root; child `x + 2 y + 4 z` (1 for the upper half) is the index of a node, or the
    /// number of nodes plus the index of the first entry of its list. Equal parts of the tree are stored once.
    pub nodes: &'a [[u16; 8]],
    /// The lists of candidates.
    pub lists: Lists<'a>,
}

/// The lists of candidates, packed: of the rectangles, many entries name the same few.
#[derive(Clone, Copy, Debug)]
pub struct Lists<'a> {
    /// Number of entries.
    pub entries: u16,
    /// Bits of an entry: from the lowest one more, one convex, [`Self::face_bits`], the others the rectangle's number.
    pub entry_bits: u8,
    /// Bits of its face.
    pub face_bits: u8,
    /// Twenty bits each: from the lowest 5 bits each of lower and upper `u`, lower and upper `v`. Bytes to the end of a
    /// 32-bit word after the last one's start.
    pub rectangles: &'a [u8],
    /// The entries, with as much behind the last one's start.
    pub candidates: &'a [u8],
}

/// A part of a face that can own the closest point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Candidate {
    /// Index of the face.
    pub face: u16,
    /// Lower `u` and `v`, in grid steps of 1/[`GRID`].
    pub lower: [u8; 2],
    /// Upper `u` and `v`.
    pub upper: [u8; 2],
    /// Whether half the squared distance is proved to be convex in `(u, v)` over the rectangle, for every probe of the
    /// cell: then it has one minimum there, and every point of the rectangle gives a lower bound of it.
    pub convex: bool,
    /// Whether more candidates follow in the list.
    pub more: bool,
}

impl Candidate {
    /// All of a face, alone in its list.
    pub(super) const fn whole(face: u16) -> Self {
        Self { face, lower: [0; 2], upper: [GRID as u8; 2], convex: false, more: false }
    }

    /// Whether parameters are on a border of the rectangle that is inside of the face.
    pub(super) fn cuts(&self, parameters: [f32; 2]) -> bool {
        let [lower, upper] = self.rectangle();
        let axes = || [0, 1].into_iter().map(|axis| (parameters[axis], lower[axis], upper[axis]));
        axes().all(|(at, low, high)| at >= low && at <= high)
            && axes().any(|(at, low, high)| (at <= low && at > 0.0) || (at >= high && at < 1.0))
    }

    /// As one number: from the lowest bit 5 bits each of lower and upper `u`, lower and upper `v`, 10 of the face,
    /// convex, more.
    pub const fn pack(&self) -> u32 {
        let rectangle = self.lower[0] as u32
            | (self.upper[0] as u32) << 5
            | (self.lower[1] as u32) << 10
            | (self.upper[1] as u32) << 15;
        rectangle | (self.face as u32) << 20 | (self.convex as u32) << 30 | (self.more as u32) << 31
    }

    /// From one number.
    #[inline]
    pub const fn unpack(entry: u32) -> Self {
        Self {
            face: ((entry >> 20) & (MAX_FACES as u32 - 1)) as u16,
            lower: [(entry & GRID) as u8, ((entry >> 10) & GRID) as u8],
            upper: [((entry >> 5) & GRID) as u8, ((entry >> 15) & GRID) as u8],
            convex: (entry >> 30) & 1 == 1,
            more: (entry >> 31) & 1 == 1,
        }
    }

    /// The rectangle's corners as parameters; grid step 31 is exactly 1.
    pub fn rectangle(&self) -> [[f32; 2]; 2] {
        let parameters = |corner: [u8; 2]| corner.map(|step| STEPS[usize::from(step) & GRID as usize]);
        [parameters(self.lower), parameters(self.upper)]
    }
}

/// The steps of the grid as parameters: a division in place of each takes longer.
static STEPS: [f32; GRID as usize + 1] = {
    let mut steps = [0.0; GRID as usize + 1];
    let mut step = 0;
    while step < steps.len() {
        steps[step] = step as f32 / GRID as f32;
        step += 1;
    }
    steps
};

/// Bits of a rectangle.
const RECTANGLE_BITS: usize = 20;

/// The word that starts in the byte of a bit, shifted so that it starts with that bit: 25 bits or more.
#[inline]
const fn from_bit(bytes: &[u8], bit: usize) -> Option<u32> {
    let Some((_, rest)) = bytes.split_at_checked(bit / 8) else { return None };
    match rest.first_chunk() {
        Some(word) => Some(u32::from_le_bytes(*word) >> (bit % 8)),
        None => None,
    }
}

impl Lists<'static> {
    /// One list of the first face, all of it.
    pub const WHOLE: Self =
        Self { entries: 1, entry_bits: 2, face_bits: 0, rectangles: &[0xe0, 0x83, 0x0f, 0], candidates: &[0; 4] };
}

impl Lists<'_> {
    /// Whether an entry can be read with one word: as many bits, from any bit of a byte at which one starts.
    pub const fn has_readable_entries(&self) -> bool {
        let Self { entry_bits, face_bits, .. } = *self;
        face_bits <= MAX_FACES.ilog2() as u8 && entry_bits >= 2 + face_bits && matches!(entry_bits, 2..=26 | 28)
    }

    /// The candidate at an index of the entries; `None` past their end.
    #[inline]
    pub const fn candidate(&self, index: usize) -> Option<Candidate> {
        if index >= self.entries as usize {
            return None;
        }
        let Some(word) = from_bit(self.candidates, index * self.entry_bits as usize) else { return None };
        let (named, face_bits) = (word >> 2, self.face_bits as u32);
        let others = (self.entry_bits as u32).wrapping_sub(2 + face_bits);
        let number = named.wrapping_shr(face_bits) & !u32::MAX.wrapping_shl(others);
        let Some(rectangle) = from_bit(self.rectangles, number as usize * RECTANGLE_BITS) else { return None };
        let face = named & !u32::MAX.wrapping_shl(face_bits);
        let rectangle = rectangle & ((1 << RECTANGLE_BITS) - 1);
        Some(Candidate::unpack(rectangle | face << RECTANGLE_BITS | (word & 2) << 29 | word << 31))
    }
}

impl Locator<'_> {
    /// The index of the first entry for a probe. Outside the root cube it is the list of the nearest cell, whose
    /// completeness is not proved. At most [`MAX_DEPTH`] rounds.
    #[inline]
    pub fn list(&self, probe: Vec3) -> usize {
        self.cell(probe).0
    }

    /// The same, with the distance from the probe to the nearest wall of its cell, metres, below 0 outside.
    #[inline]
    pub(super) fn cell(&self, probe: Vec3) -> (usize, f32) {
        let mut centre = self.corner + Vec3::splat(0.5 * self.side);
        let mut quarter = 0.25 * self.side;
        let mut node = 0;
        // Hidden from the compiler, which would unroll every round.
        for _ in 0..core::hint::black_box(MAX_DEPTH) {
            let upper = [probe.x >= centre.x, probe.y >= centre.y, probe.z >= centre.z];
            let child = usize::from(upper[0]) | usize::from(upper[1]) << 1 | usize::from(upper[2]) << 2;
            let Some(code) = self.nodes.get(node).and_then(|children| children.get(child)) else { break };
            centre += Vec3::from_array(upper.map(|upper| if upper { quarter } else { -quarter }));
            node = usize::from(*code);
            if let Some(entry) = node.checked_sub(self.nodes.len()) {
                let off = (probe - centre).abs().max_element();
                return (entry, quarter - off);
            }
            quarter *= 0.5;
        }
        (0, 0.0)
    }

    /// Whether the root cube holds the probe.
    #[inline]
    pub fn holds(&self, probe: Vec3) -> bool {
        let within = |x: f32, low: f32| x >= low && x - low <= self.side;
        within(probe.x, self.corner.x) && within(probe.y, self.corner.y) && within(probe.z, self.corner.z)
    }

    /// The number of candidates in the longest list.
    pub const fn longest_list(&self) -> usize {
        let (mut longest, mut list, mut index) = (0, 0, 0);
        while let Some(Candidate { more, .. }) = self.lists.candidate(index) {
            list += 1;
            longest = if list > longest { list } else { longest };
            list = if more { list } else { 0 };
            index += 1;
        }
        longest
    }

    /// The candidate at an index of the entries; `None` past their end.
    #[inline]
    pub const fn candidate(&self, index: usize) -> Option<Candidate> {
        self.lists.candidate(index)
    }
}
