//! A body from a file: the same tables as those of a `static`, borrowed from bytes in flash, in RAM or read by a host.
//!
//! The numbers are read in place: a body from a file costs the same in a tick as one that was compiled in. Only faces
//! and edges, which refer to their numbers, are built, in a [`BodyBuffer`] of the caller. All checks come first, in a
//! time that the length of the file bounds. The repository's `docs/reference/body-file.md` documents the format byte by byte.

mod error;
mod records;
mod sections;

pub use error::{FileError, Section};
pub use sections::FILE_VERSION;

use super::feature::{Edge, Face};
use super::locator::{Lists, Locator};
use super::table::{Body, BodyTables};
use super::tick_bound::{TickLimit, WorstTick};
use crate::math::{Vec3, vec3};
use records::Numbers;
use sections::{BODY_WORDS, Sections};

/// Buffer for the faces and edges of a body from a file: 228 bytes a face and 52 an edge on a 32-bit target. [`Body`]
/// has an example.
#[derive(Debug)]
pub struct BodyBuffer<'a> {
    /// For the faces: [`FileHead::faces`] or more.
    pub faces: &'a mut [Face<'a>],
    /// For the edges: [`FileHead::edges`] or more.
    pub edges: &'a mut [Edge<'a>],
}

/// Bytes at an address that is a multiple of 4, as [`Body::from_bytes`] needs them: for `include_bytes!`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(
    /// The bytes.
    pub T,
);

/// The head of a file, before anything is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileHead {
    /// Faces that the buffer needs.
    pub faces: usize,
    /// Edges that the buffer needs.
    pub edges: usize,
    /// SHA-256 of the model file.
    pub source: [u8; 32],
    /// Origin of the tables in the model's frame, metres: a point of the model minus this is a point of the tables.
    pub centre: Vec3,
}

/// The numbers of the whole body, from their record.
struct BodyRecord {
    table_crc: u32,
    is_convex: bool,
    size: f32,
    corner: Vec3,
    side: f32,
    centre: Vec3,
    /// Number of the locator's entries, bits of each, and of its face.
    entries: (u16, u8, u8),
}

impl BodyRecord {
    fn of(record: &[u32; BODY_WORDS]) -> Result<Self, FileError> {
        let wrong = FileError::Code { section: Section::Body, record: 0 };
        let [table_crc, convex, numbers @ .., lists] = *record;
        let is_convex = match convex {
            0 => false,
            1 => true,
            _ => return Err(wrong),
        };
        let [size, x, y, z, side, centre_x, centre_y, centre_z] = numbers.map(f32::from_bits);
        let centre = vec3(centre_x, centre_y, centre_z);
        // The checks of the body cover the other numbers.
        if !centre.is_finite() {
            return Err(wrong);
        }
        let [low, high, entry_bits, face_bits] = lists.to_le_bytes();
        let entries = (u16::from_le_bytes([low, high]), entry_bits, face_bits);
        Ok(Self { table_crc, is_convex, size, corner: vec3(x, y, z), side, centre, entries })
    }
}

impl FileHead {
    /// Checks a file's CRC and its sections, nothing else.
    pub fn of(bytes: &[u8]) -> Result<Self, FileError> {
        let sections = Sections::of(bytes)?;
        let mut source = [0; 32];
        for (bytes, word) in source.as_chunks_mut().0.iter_mut().zip(sections.source) {
            *bytes = word.to_le_bytes();
        }
        let BodyRecord { centre, .. } = BodyRecord::of(sections.body)?;
        Ok(Self { faces: sections.faces.len(), edges: sections.edges.len(), source, centre })
    }

    /// The notes of a file for people, [`Section::Notes`]. The library does not use them.
    pub fn notes(bytes: &[u8]) -> Result<&[u8], FileError> {
        Ok(bytemuck::cast_slice(Sections::of(bytes)?.notes))
    }
}

impl<'a> Body<'a> {
    /// The body of a file, with every number, index and list checked; `buffer` holds its faces and edges.
    ///
    /// The time is bounded by the length of the file: a record takes a bounded number of steps and borders, and no two
    /// records share coefficients. A tick on the body is bounded too, by [`TickLimit::BENCH`]: its effort is lowered until
    /// it fits ([`Body::fitted`]).
    pub fn from_bytes(bytes: &'a [u8], buffer: BodyBuffer<'a>) -> Result<Self, FileError> {
        Self::from_bytes_with(bytes, buffer, TickLimit::BENCH, &mut || ())
    }

    /// [`Self::from_bytes`] with the application's own limit of a tick. Calls `pause` repeatedly, for a watchdog: after
    /// each 1,024 words of a CRC, and between the other checks, which together take a seventh of the time.
    pub fn from_bytes_with(
        bytes: &'a [u8],
        buffer: BodyBuffer<'a>,
        limit: TickLimit,
        pause: &mut dyn FnMut(),
    ) -> Result<Self, FileError> {
        let sections = Sections::of_with(bytes, pause)?;
        pause();
        let BodyRecord { table_crc: stated, is_convex, size, corner, side, entries, .. } =
            BodyRecord::of(sections.body)?;
        finite(sections.borders, Section::Borders)?;
        finite(sections.coefficients, Section::Coefficients)?;
        pause();
        let (faces, edges) = (sections.faces.len(), sections.edges.len());
        let small = FileError::BufferTooSmall { faces: faces as u32, edges: edges as u32 };
        let in_faces = buffer.faces.get_mut(..faces).ok_or(small)?;
        let in_edges = buffer.edges.get_mut(..edges).ok_or(small)?;
        let mut numbers = Numbers { borders: sections.borders, coefficients: sections.coefficients };
        for (index, (face, record)) in in_faces.iter_mut().zip(sections.faces).enumerate() {
            *face = numbers.face(record, index)?;
        }
        for (index, (edge, record)) in in_edges.iter_mut().zip(sections.edges).enumerate() {
            *edge = numbers.edge(record).map_err(|wrong| wrong.at(Section::Edges, index))?;
        }
        if !numbers.coefficients.is_empty() {
            return Err(FileError::UnusedCoefficients { numbers: numbers.coefficients.len() as u32 });
        }
        pause();
        let (entries, entry_bits, face_bits) = entries;
        let (rectangles, candidates) =
            (bytemuck::cast_slice(sections.rectangles), bytemuck::cast_slice(sections.entries));
        let lists = Lists { entries, entry_bits, face_bits, rectangles, candidates };
        let locator = Locator { corner, side, nodes: sections.nodes, lists };
        let tables = BodyTables {
            faces: in_faces,
            edges: in_edges,
            vertices: sections.vertices,
            spokes: sections.spokes,
            locator,
            size_m: size,
            is_convex,
            crc: None,
        };
        let body = tables.try_checked_without_crc()?;
        let (body, WorstTick { cost: evaluations, vertex }, cycles) = body.fitted_with(limit, pause);
        if evaluations > limit.evaluations {
            let spokes = |index: u16| Some((index, body.vertices.get(usize::from(index))?.spokes));
            return Err(FileError::Tick { evaluations, limit: limit.evaluations, vertex: vertex.and_then(spokes) });
        }
        if cycles > limit.cycles {
            return Err(FileError::Cycles { cycles, limit: limit.cycles });
        }
        pause();
        // The words equal those of the same body as a static: the result is the baked CRC.
        match body.table_crc_with(pause) {
            found if found == stated => Ok(body.with_crc(stated)),
            found => Err(FileError::Tables { stated, found }),
        }
    }
}

fn finite(numbers: &[f32], section: Section) -> Result<(), FileError> {
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(FileError::Number { section, index: index as u32 }),
        None => Ok(()),
    }
}
