//! Every number of a body's tables as 32-bit words, for the check that flash still holds what was baked.
//!
//! The tables are a list of *records* — one for the body, then the faces' sides and patches, edges, vertices, spokes,
//! and the locator's nodes and entries — and a record is a list of words. A word is found by a [`TableCursor`] in a
//! bounded number of steps, whatever the size of the body. Addresses are left out: they are the linker's. What a
//! slice's address leads to is read, and its length is in the words.

use super::curve::SplineCurve;
use super::feature::{Edge, EdgeFace, Separator, Side, Spoke, Vertex};
use super::locator::Locator;
use super::table::Body;
use crate::math::Vec3;
use crate::patch::coefficient_word;
use crate::track::Contact;

/// A place in the words of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableCursor {
    /// Which record.
    pub record: u32,
    /// Which of its words.
    pub word: u32,
}

impl TableCursor {
    /// Where to read on after what was `found` here; `None` at the end of the table. The end of a record takes a
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

impl Body<'_> {
    /// The word at a cursor; `None` past the end of its record, and of the table.
    pub fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        let word = cursor.word as usize;
        let mut record = cursor.record as usize;
        // What is left of the record's number after this part of the table, or the record.
        let mut within = |count: usize| {
            if record < count {
                Some(record)
            } else {
                record -= count;
                None
            }
        };
        let Locator { nodes, entries, .. } = self.locator;
        if within(1).is_some() {
            return self.head(word);
        }
        if let Some(index) = within(FACE_RECORDS * self.faces.len()) {
            let face = self.faces.get(index / FACE_RECORDS)?;
            return match face.sides.get(index % FACE_RECORDS) {
                Some(side) => side.word(word),
                None => face.patch.word(word),
            };
        }
        if let Some(index) = within(self.edges.len()) {
            return self.edges.get(index)?.word(word);
        }
        if let Some(index) = within(self.vertices.len()) {
            return self.vertices.get(index)?.word(word);
        }
        if let Some(index) = within(self.spokes.len()) {
            return self.spokes.get(index)?.word(word);
        }
        if let Some(index) = within(nodes.len()) {
            let node = nodes.get(index)?;
            return Some(pair(*node.get(2 * word)?, *node.get(2 * word + 1)?));
        }
        // Entries in records of 16: one each would spend every other reading on the end of a record.
        let index = within(entries.len().div_ceil(ENTRIES))?;
        if word < ENTRIES { entries.get(index * ENTRIES + word).copied() } else { None }
    }

    /// How many records there are.
    pub fn table_records(&self) -> u32 {
        let Locator { nodes, entries, .. } = self.locator;
        let features = FACE_RECORDS * self.faces.len() + self.edges.len() + self.vertices.len() + self.spokes.len();
        (1 + features + nodes.len() + entries.len().div_ceil(ENTRIES)) as u32
    }

    /// CRC-32 of all words as they are now; as they were baked it is [`Self::baked_crc`].
    pub fn table_crc(&self) -> u32 {
        self.table_crc_with(&mut || ())
    }

    /// The same; calls `pause` every so often.
    pub(super) fn table_crc_with(&self, pause: &mut dyn FnMut()) -> u32 {
        let (mut crc, mut place) = (0, Some(TableCursor::default()));
        let mut passed = 0_u32;
        while let Some(cursor) = place {
            let found = self.table_word(cursor);
            if let Some(word) = found {
                crc = crate::patch::crc32(crc, word);
            }
            place = cursor.after(found);
            passed = passed.wrapping_add(1);
            if passed.is_multiple_of(PAUSE) {
                pause();
            }
        }
        crc
    }

    fn head(&self, word: usize) -> Option<u32> {
        let Locator { corner, side, nodes, entries } = self.locator;
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
            11 => entries.len() as u32,
            _ => return None,
        })
    }
}

/// Words from one pause to the next.
pub(super) const PAUSE: u32 = 1_024;

/// Entries of the locator in a record.
const ENTRIES: usize = 16;

/// Records of a face: its sides, then its patch.
const FACE_RECORDS: usize = 5;

impl Side<'_> {
    fn word(&self, word: usize) -> Option<u32> {
        match (self, word) {
            (Self::Pole { vertex }, 0) => Some(u32::from(*vertex)),
            (Self::Pole { .. }, _) => None,
            (Self::Edge { edge, reversed, separator }, 0) => {
                let is_ruled = matches!(separator, Separator::Ruled(_));
                Some(u32::from(*edge) | u32::from(*reversed) << 16 | u32::from(is_ruled) << 17 | 1 << 18)
            }
            (Self::Edge { separator, .. }, _) => match separator {
                Separator::Plane { across, .. } if word < 4 => Some(component(*across, word - 1)),
                Separator::Plane { offset, .. } => (word == 4).then_some(offset.to_bits()),
                Separator::Ruled(curve) => curve.word(word - 1),
            },
        }
    }
}

impl SplineCurve<'_> {
    fn word(&self, word: usize) -> Option<u32> {
        match word {
            0 => Some(u32::from(self.degree) | self.coefficients.tag() << 8 | (self.breaks.len() as u32) << 16),
            1 => Some(self.second_derivative.to_bits()),
            _ => match self.breaks.get(word - 2) {
                Some(border) => Some(border.to_bits()),
                None => coefficient_word(self.coefficients, word - 2 - self.breaks.len()),
            },
        }
    }
}

impl Edge<'_> {
    /// Faces, ends and kind, what is proved of the third derivative, then the curve.
    fn word(&self, word: usize) -> Option<u32> {
        let [first, second] = self.faces;
        let face = |of: EdgeFace| u32::from(of.face) | u32::from(of.side) << 16;
        match word {
            0 => Some(face(first) | (self.kind as u32) << 24),
            1 => Some(face(second)),
            2 => Some(pair(self.ends[0], self.ends[1])),
            3 => Some(self.third_derivative.to_bits()),
            4 => Some(self.jump.to_bits()),
            _ => self.curve.word(word - 5),
        }
    }
}

impl Vertex {
    fn word(&self, word: usize) -> Option<u32> {
        match word {
            0..=2 => Some(component(self.point, word)),
            3..=5 => Some(component(self.outward, word - 3)),
            6 => Some(pair(self.first_spoke, self.spokes)),
            7 => Some(u32::from(self.is_open)),
            _ => None,
        }
    }
}

impl Spoke {
    fn word(&self, word: usize) -> Option<u32> {
        match word {
            0..=2 => Some(component(self.direction, word)),
            3 => Some(u32::from(self.edge) | u32::from(self.at_upper_end) << 16),
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
