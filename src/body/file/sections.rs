//! A file cut into its sections, without their content.

use super::super::feature::{Spoke, Vertex};
use super::super::table_words::PAUSE;
use super::error::{FileError, Section};
use crate::patch::crc32;
use bytemuck::PodCastError;
use bytemuck::checked::CheckedCastError;

/// The version of the form of the file that is written and read here.
pub const FILE_VERSION: u32 = 2;

/// `PALP`.
const MAGIC: u32 = u32::from_le_bytes(*b"PALP");

/// Words of a face's record, of an edge's, and of that of the whole body.
pub(super) const FACE_WORDS: usize = 39;
pub(super) const EDGE_WORDS: usize = 8;
pub(super) const BODY_WORDS: usize = 11;

// They are read in place.
const _: () = assert!(size_of::<Vertex>() == 32 && size_of::<Spoke>() == 16);

/// The sections of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sections<'a> {
    pub source: &'a [u32; 8],
    pub body: &'a [u32; BODY_WORDS],
    pub borders: &'a [f32],
    pub coefficients: &'a [f32],
    pub faces: &'a [[u32; FACE_WORDS]],
    pub edges: &'a [[u32; EDGE_WORDS]],
    pub vertices: &'a [Vertex],
    pub spokes: &'a [Spoke],
    pub nodes: &'a [[u16; 8]],
    pub rectangles: &'a [u32],
    pub entries: &'a [u32],
    pub notes: &'a [u32],
}

impl<'a> Sections<'a> {
    /// Cuts a file, once its CRC is right.
    pub fn of(bytes: &'a [u8]) -> Result<Self, FileError> {
        Self::of_with(bytes, &mut || ())
    }

    /// The same; calls `pause` after each [`PAUSE`] words.
    pub fn of_with(bytes: &'a [u8], pause: &mut dyn FnMut()) -> Result<Self, FileError> {
        const { assert!(cfg!(target_endian = "little"), "a body's file is read in place: little-endian targets only") };
        let mut rest = Remaining(checked(bytes, pause)?);
        Ok(Self {
            source: rest.only(Section::Source)?,
            body: rest.only(Section::Body)?,
            borders: bytemuck::cast_slice(rest.section(Section::Borders)?),
            coefficients: bytemuck::cast_slice(rest.section(Section::Coefficients)?),
            faces: rest.records(Section::Faces)?,
            edges: rest.records(Section::Edges)?,
            vertices: rest.in_place(Section::Vertices)?,
            spokes: rest.in_place(Section::Spokes)?,
            nodes: rest.in_place(Section::Nodes)?,
            rectangles: rest.section(Section::Rectangles)?,
            entries: rest.section(Section::Entries)?,
            notes: rest.last(Section::Notes)?,
        })
    }
}

/// The words between the head and the CRC, of a file that is whole.
fn checked<'a>(bytes: &'a [u8], pause: &mut dyn FnMut()) -> Result<&'a [u32], FileError> {
    // No file has more than 4 GB.
    let given = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
    // The head is read by bytes: a file that was cut short still has its version and length.
    let head = |index: usize| Some(u32::from_le_bytes(*bytes.get(4 * index..)?.first_chunk()?));
    let (magic, version, stated) = (head(0), head(1), head(2));
    if magic.is_some_and(|magic| magic != MAGIC) {
        return Err(FileError::Magic);
    }
    if let Some(found) = version.filter(|found| *found != FILE_VERSION) {
        return Err(FileError::Version { found, wanted: FILE_VERSION });
    }
    let stated = stated.unwrap_or(0);
    if stated != given {
        return Err(FileError::Length { stated, given });
    }
    let words: &[u32] = bytemuck::try_cast_slice(bytes).map_err(|error| match error {
        PodCastError::TargetAlignmentGreaterAndInputNotAligned => FileError::Unaligned,
        _ => FileError::Length { stated, given },
    })?;
    let [_, _, _, sections @ .., stated_crc] = words else { return Err(FileError::Length { stated, given }) };
    let found = words[..words.len() - 1].chunks(PAUSE as usize).fold(0, |crc, words| {
        pause();
        words.iter().fold(crc, |crc, word| crc32(crc, *word))
    });
    if found != *stated_crc {
        return Err(FileError::Damaged { stated: *stated_crc, found });
    }
    Ok(sections)
}

/// The words that are not yet cut.
struct Remaining<'a>(&'a [u32]);

impl<'a> Remaining<'a> {
    /// The next section, whose name and length go before it.
    fn section(&mut self, section: Section) -> Result<&'a [u32], FileError> {
        let wrong = FileError::Section { section };
        let [letters, bytes, rest @ ..] = self.0 else { return Err(wrong) };
        let (data, rest) = rest.split_at_checked(*bytes as usize / 4).ok_or(wrong)?;
        if *letters != section.word() || !bytes.is_multiple_of(4) {
            return Err(wrong);
        }
        self.0 = rest;
        Ok(data)
    }

    /// The section that ends the file.
    fn last(&mut self, section: Section) -> Result<&'a [u32], FileError> {
        let data = self.section(section)?;
        if self.0.is_empty() { Ok(data) } else { Err(FileError::Section { section }) }
    }

    /// A section with a single record.
    fn only<const N: usize>(&mut self, section: Section) -> Result<&'a [u32; N], FileError> {
        self.section(section)?.try_into().map_err(|_| FileError::Section { section })
    }

    /// A section with records of `N` words.
    fn records<const N: usize>(&mut self, section: Section) -> Result<&'a [[u32; N]], FileError> {
        match self.section(section)?.as_chunks() {
            (records, []) => Ok(records),
            _ => Err(FileError::Section { section }),
        }
    }

    /// A section whose records are read in place.
    fn in_place<T: bytemuck::CheckedBitPattern>(&mut self, section: Section) -> Result<&'a [T], FileError> {
        let words = self.section(section)?;
        bytemuck::checked::try_cast_slice(words).map_err(|error| match error {
            CheckedCastError::PodCastError(_) => FileError::Section { section },
            // Only a bad file comes here: look for the record.
            CheckedCastError::InvalidBitPattern => {
                let size = size_of::<T>() / 4;
                let is_wrong = |record: &[u32]| bytemuck::checked::try_cast_slice::<u32, T>(record).is_err();
                let record = words.chunks_exact(size.max(1)).position(is_wrong).unwrap_or_default();
                FileError::Code { section, record: record as u32 }
            }
        })
    }
}
