//! Every number of a body's tables as 32-bit words, for the check that flash still holds the baked tables.
//!
//! The tables are a list of *records* (one for the body, then the faces' sides and patches, edges, vertices, spokes, and
//! the locator's nodes and entries), and a record is a list of words. A [`TableCursor`] finds a word in a bounded number
//! of steps, whatever the size of the body. The words leave out addresses, which the linker chooses; they hold the
//! length of each slice and its content.

use super::curve::SplineCurve;
use super::feature::{Edge, EdgeFace, Separator, Side, Spoke, Vertex};
use super::locator::Locator;
use super::table::Body;
use crate::field::Rigid;
use crate::math::Vec3;
use crate::patch::{coefficient_word, crc32};
use crate::track::Contact;

/// A place in the words of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TableCursor {
    /// Index of the record.
    pub record: u32,
    /// Index of the word in it.
    pub word: u32,
}

impl TableCursor {
    /// The next place to read, after `found` was read here; `None` at the end of the table. The end of a record takes a
    /// reading of its own.
    #[inline]
    pub const fn after(self, found: Option<u32>) -> Option<Self> {
        match (found, self.word) {
            (Some(_), word) => Some(Self { word: word + 1, ..self }),
            // No record is empty.
            (None, 0) => None,
            (None, _) => Some(Self { record: self.record + 1, word: 0 }),
        }
    }
}

/// `slice.get(index)`, in a `const fn`.
#[inline(always)]
const fn at<T>(slice: &[T], index: usize) -> Option<&T> {
    if index < slice.len() { Some(&slice[index]) } else { None }
}

impl<const KINDS: u32> Body<'_, Rigid<KINDS>> {
    /// The word at a cursor; `None` past the end of its record, and of the table.
    pub const fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        let word = cursor.word as usize;
        let mut record = cursor.record as usize;
        if record < 1 {
            return self.head(word);
        }
        record -= 1;
        let Locator { nodes, lists, .. } = self.locator;
        let (of_faces, edges, spokes) = (FACE_RECORDS * self.faces.len(), self.edges.len(), self.spokes.len());
        let features = of_faces + edges + self.vertices.len() + spokes;
        // Last and most often first: the lists are most of the words.
        if record >= features + nodes.len() {
            record -= features + nodes.len();
            // Words in records of 16: one each would spend every other reading on the end of a record.
            let rectangles = records_of(lists.rectangles);
            let (bytes, record) =
                if record < rectangles { (lists.rectangles, record) } else { (lists.candidates, record - rectangles) };
            return if word < WORDS { word_of(bytes, record * WORDS + word) } else { None };
        }
        if record < of_faces {
            let Some(face) = at(self.faces, record / FACE_RECORDS) else { return None };
            return match at(&face.sides, record % FACE_RECORDS) {
                Some(side) => side.word(word),
                None => face.patch.word(word),
            };
        }
        record -= of_faces;
        if let Some(edge) = at(self.edges, record) {
            return edge.word(word);
        }
        record -= edges;
        if let Some(vertex) = at(self.vertices, record) {
            return vertex.word(word);
        }
        record -= self.vertices.len();
        if let Some(spoke) = at(self.spokes, record) {
            return spoke.word(word);
        }
        let Some(node) = at(nodes, record - spokes) else { return None };
        let (Some(low), Some(high)) = (at(node, 2 * word), at(node, 2 * word + 1)) else { return None };
        Some(pair(*low, *high))
    }

    /// The number of records.
    pub const fn table_records(&self) -> u32 {
        let Locator { nodes, lists, .. } = self.locator;
        let features = FACE_RECORDS * self.faces.len() + self.edges.len() + self.vertices.len() + self.spokes.len();
        (1 + features + nodes.len() + records_of(lists.rectangles) + records_of(lists.candidates)) as u32
    }

    /// CRC-32 of all words as they are now; [`Self::baked_crc`] is that of the words as they were baked.
    pub const fn table_crc(&self) -> u32 {
        let (mut crc, mut place) = (0, Some(TableCursor { record: 0, word: 0 }));
        while let Some(cursor) = place {
            let found = self.table_word(cursor);
            if let Some(word) = found {
                crc = crc32(crc, word);
            }
            place = cursor.after(found);
        }
        crc
    }

    /// [`Self::table_crc`] that calls `pause` after each [`PAUSE`] readings.
    pub(super) fn table_crc_with(&self, pause: &mut dyn FnMut()) -> u32 {
        let (mut crc, mut place) = (0, Some(TableCursor::default()));
        let mut passed = 0_u32;
        while let Some(cursor) = place {
            let found = self.table_word(cursor);
            if let Some(word) = found {
                crc = crc32(crc, word);
            }
            place = cursor.after(found);
            passed = passed.wrapping_add(1);
            if passed.is_multiple_of(PAUSE) {
                pause();
            }
        }
        crc
    }

    const fn head(&self, word: usize) -> Option<u32> {
        let Locator { corner, side, nodes, lists } = self.locator;
        Some(match word {
            0 => self.size.to_bits(),
            1 => (Contact::Touching as u32).wrapping_sub(self.sure_from as u32),
            2 => self.faces.len() as u32,
            3 => self.edges.len() as u32,
            4 => self.vertices.len() as u32,
            5 => self.spokes.len() as u32,
            6..=8 => component(corner, word - 6),
            9 => side.to_bits(),
            10 => nodes.len() as u32,
            11 => lists.entries as u32 | (lists.entry_bits as u32) << 16 | (lists.face_bits as u32) << 24,
            12 => lists.rectangles.len() as u32,
            13 => lists.candidates.len() as u32,
            _ => return None,
        })
    }
}

/// Words from one pause to the next.
pub(super) const PAUSE: u32 = 1_024;

/// Words of the locator's lists in a record.
const WORDS: usize = 16;

/// Number of records of a list of bytes.
const fn records_of(bytes: &[u8]) -> usize {
    bytes.len().div_ceil(4 * WORDS)
}

/// Four bytes; zeros past the last one.
const fn word_of(bytes: &[u8], index: usize) -> Option<u32> {
    let (first, mut word, mut byte) = (4 * index, 0, 0);
    let Some((_, rest)) = bytes.split_at_checked(first) else { return None };
    if let Some(word) = rest.first_chunk() {
        return Some(u32::from_le_bytes(*word));
    }
    if rest.is_empty() {
        return None;
    }
    while byte < 4 && first + byte < bytes.len() {
        word |= (bytes[first + byte] as u32) << (8 * byte);
        byte += 1;
    }
    Some(word)
}

/// Records of a face: its sides, then its patch.
const FACE_RECORDS: usize = 5;

impl Side<'_> {
    const fn word(&self, word: usize) -> Option<u32> {
        match (self, word) {
            (Self::Pole { vertex }, 0) => Some(*vertex as u32),
            (Self::Pole { .. }, _) => None,
            (Self::Edge { edge, reversed, separator }, 0) => {
                let is_ruled = matches!(separator, Separator::Ruled(_));
                Some(*edge as u32 | (*reversed as u32) << 16 | (is_ruled as u32) << 17 | 1 << 18)
            }
            (Self::Edge { separator, .. }, _) => match separator {
                Separator::Plane { across, .. } if word < 4 => Some(component(*across, word - 1)),
                Separator::Plane { offset, .. } if word == 4 => Some(offset.to_bits()),
                Separator::Plane { .. } => None,
                Separator::Ruled(curve) => curve.word(word - 1),
            },
        }
    }
}

impl SplineCurve<'_> {
    const fn word(&self, word: usize) -> Option<u32> {
        match word {
            0 => Some(self.degree as u32 | self.coefficients.tag() << 8 | (self.breaks.len() as u32) << 16),
            1 => Some(self.second_derivative.to_bits()),
            _ => match at(self.breaks, word - 2) {
                Some(border) => Some(border.to_bits()),
                None => coefficient_word(self.coefficients, word - 2 - self.breaks.len()),
            },
        }
    }
}

impl Edge<'_> {
    /// Faces, ends and kind, the bounds of the third derivative and of jumps, then the curve.
    const fn word(&self, word: usize) -> Option<u32> {
        let [first, second] = self.faces;
        match word {
            0 => Some(face_word(first) | (self.kind as u32) << 24),
            1 => Some(face_word(second)),
            2 => Some(pair(self.ends[0], self.ends[1])),
            3 => Some(self.third_derivative.to_bits()),
            4 => Some(self.jump.to_bits()),
            _ => self.curve.word(word - 5),
        }
    }
}

const fn face_word(of: EdgeFace) -> u32 {
    of.face as u32 | (of.side as u32) << 16
}

impl Vertex {
    const fn word(&self, word: usize) -> Option<u32> {
        match word {
            0..=2 => Some(component(self.point, word)),
            3..=5 => Some(component(self.outward, word - 3)),
            6 => Some(pair(self.first_spoke, self.spokes)),
            7 => Some(self.is_open as u32),
            _ => None,
        }
    }
}

impl Spoke {
    const fn word(&self, word: usize) -> Option<u32> {
        match word {
            0..=2 => Some(component(self.direction, word)),
            3 => Some(self.edge as u32 | (self.at_upper_end as u32) << 16),
            _ => None,
        }
    }
}

const fn pair(low: u16, high: u16) -> u32 {
    low as u32 | (high as u32) << 16
}

const fn component(vector: Vec3, index: usize) -> u32 {
    let value = match index {
        0 => vector.x,
        1 => vector.y,
        _ => vector.z,
    };
    value.to_bits()
}
