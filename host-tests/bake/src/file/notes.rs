//! The notes of a file: what its body is called, and where its faces are from.

use crate::body::{BakedBody, TableFault};
use crate::model::{Model, Unit};
use crate::patch::Axis;
use crate::split::Provenance;
use palpate::body::FileError;
use thiserror::Error;

/// A host's notes on a body beside its tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Notes {
    /// The model's unit.
    pub unit: Unit,
    /// The model's name.
    pub name: String,
    /// The names of its patches, where they have one.
    pub patches: Vec<Option<String>>,
    /// The notes on each face.
    pub faces: Vec<FaceNotes>,
}

/// A host's notes on a face.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceNotes {
    /// Which part of the model it is.
    pub source: Provenance,
    /// How many derivatives are continuous at each inner span border along `u` and along `v`.
    pub continuity: [Vec<u8>; 2],
}

/// The length of a name that there is not.
const NAMELESS: u32 = u32::MAX;

impl Notes {
    /// Those of a model and its body.
    pub fn of(model: &Model, body: &BakedBody) -> Self {
        let face = |face: &crate::body::BakedFace| {
            let continuity = [Axis::U, Axis::V].map(|axis| {
                let (knots, degree) = (&face.surface.knots[axis as usize], face.surface.degree[axis as usize]);
                let inner = knots.chunk_by(|a, b| a == b).filter(|group| 0.0 < group[0] && group[0] < 1.0);
                inner.map(|group| degree.saturating_sub(group.len()) as u8).collect()
            });
            FaceNotes { source: face.source, continuity }
        };
        Self {
            unit: model.unit,
            name: model.name.clone(),
            patches: model.patches.iter().map(|patch| patch.name.clone()).collect(),
            faces: body.faces.iter().map(face).collect(),
        }
    }

    /// As they stand in the file, a multiple of four bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let word = |bytes: &mut Vec<u8>, word: u32| bytes.extend(word.to_le_bytes());
        word(&mut bytes, self.unit.per_metre() as u32);
        word(&mut bytes, self.patches.len() as u32);
        for name in [Some(&self.name)].into_iter().chain(self.patches.iter().map(Option::as_ref)) {
            word(&mut bytes, name.map_or(NAMELESS, |name| name.len() as u32));
            bytes.extend(name.map(String::as_bytes).unwrap_or_default());
            pad(&mut bytes);
        }
        for FaceNotes { source: Provenance { patch, lower, upper }, continuity } in &self.faces {
            word(&mut bytes, *patch as u32);
            bytes.extend(lower.iter().chain(upper).flat_map(|parameter| parameter.to_le_bytes()));
            bytes.extend(continuity.iter().flatten());
            pad(&mut bytes);
        }
        bytes
    }

    /// From their bytes. `borders` are the numbers of inner span borders of each face along `u` and `v`.
    pub(super) fn read(bytes: &[u8], borders: &[[usize; 2]]) -> Result<Self, FileFault> {
        let mut rest = Rest { bytes, at: 0 };
        let unit = match rest.word()? {
            1 => Unit::Metre,
            100 => Unit::Centimetre,
            1000 => Unit::Millimetre,
            _ => return Err(rest.wrong()),
        };
        let count = rest.word()? as usize;
        let name = rest.name()?.ok_or_else(|| rest.wrong())?;
        // Every patch has a face.
        if count == 0 || count > borders.len() {
            return Err(rest.wrong());
        }
        let patches = (0..count).map(|_| rest.name()).collect::<Result<Vec<_>, _>>()?;
        let mut faces = Vec::with_capacity(borders.len());
        for borders in borders {
            let patch = rest.word()? as usize;
            let mut parameters = || -> Result<[f64; 2], FileFault> { Ok([rest.parameter()?, rest.parameter()?]) };
            let (lower, upper) = (parameters()?, parameters()?);
            if patch >= count || (0..2).any(|axis| lower[axis] >= upper[axis]) {
                return Err(rest.wrong());
            }
            let mut along = |count: usize| rest.take(count).map(<[u8]>::to_vec);
            let continuity = [along(borders[0])?, along(borders[1])?];
            rest.skip_padding()?;
            faces.push(FaceNotes { source: Provenance { patch, lower, upper }, continuity });
        }
        let has_face = |patch: usize| faces.iter().any(|face| face.source.patch == patch);
        if rest.at != bytes.len() || !(0..count).all(has_face) {
            return Err(rest.wrong());
        }
        Ok(Self { unit, name, patches, faces })
    }
}

fn pad(bytes: &mut Vec<u8>) {
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

/// The unread rest.
struct Rest<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Rest<'a> {
    const fn wrong(&self) -> FileFault {
        FileFault::Notes { at: self.at }
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], FileFault> {
        let taken = self.bytes[self.at..].get(..count).ok_or_else(|| self.wrong())?;
        self.at += count;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], FileFault> {
        let wrong = self.wrong();
        self.take(N)?.try_into().map_err(|_| wrong)
    }

    fn word(&mut self) -> Result<u32, FileFault> {
        self.array().map(u32::from_le_bytes)
    }

    /// A number from 0 to 1.
    fn parameter(&mut self) -> Result<f64, FileFault> {
        let wrong = self.wrong();
        let parameter = f64::from_le_bytes(self.array()?);
        if (0.0..=1.0).contains(&parameter) { Ok(parameter) } else { Err(wrong) }
    }

    fn name(&mut self) -> Result<Option<String>, FileFault> {
        let wrong = self.wrong();
        let length = self.word()?;
        if length == NAMELESS {
            return Ok(None);
        }
        let name = str::from_utf8(self.take(length as usize)?).map_err(|_| wrong)?.to_owned();
        self.skip_padding()?;
        Ok(Some(name))
    }

    fn skip_padding(&mut self) -> Result<(), FileFault> {
        let wrong = self.wrong();
        let zeros = self.take(self.at.next_multiple_of(4) - self.at)?;
        if zeros.iter().all(|byte| *byte == 0) { Ok(()) } else { Err(wrong) }
    }
}

// Why there is no file.

/// Why there is no file, or none that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FileFault {
    /// The library refuses the file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The library refuses the tables.
    #[error(transparent)]
    Table(#[from] TableFault),
    /// The notes are not what they should be.
    #[error("the notes for the host (section NOTE) are malformed at byte {at}")]
    Notes {
        /// Where, from the section's first byte.
        at: usize,
    },
    /// A weight of a face is not positive: it is no NURBS patch.
    #[error("face {face} has a weight that is not positive")]
    Weight {
        /// The face.
        face: usize,
    },
    /// Beyond what a file can hold.
    #[error("the tables are too large for a file: {bytes} bytes")]
    TooLarge {
        /// How many bytes there would be.
        bytes: usize,
    },
}
