//! Bodies from files.

use crate::felt::Felt;
use crate::handle::{Handle, Kind};
use crate::pointers::{finite, get, put, row, take_slots};
use crate::status::{Status, code};
use core::ffi::c_void;
use palpate_core::body::{Body, BodyBuffer, Edge, Effort, Face, FileHead};
use palpate_core::math::Vec3;

/// A body whose file and working memory the caller owns.
pub struct Loaded {
    pub felt: Felt,
    /// Checksum of its tables: shows that a handle was loaded again with another file.
    crc: Option<u32>,
}

impl Kind for Loaded {
    const MARK: usize = 0x5041_4c42;
}

/// A body as what stands on it knows it.
#[derive(Clone, Copy)]
pub struct Standing {
    place: *const Handle<Loaded>,
    crc: Option<u32>,
}

impl Standing {
    /// To stand on a body.
    ///
    /// # Safety
    /// As [`Handle::get`], for as long as anything stands on it.
    pub unsafe fn on(place: *const Handle<Loaded>) -> Result<(Self, &'static Felt), Status> {
        // SAFETY: by the caller's promise.
        let loaded = unsafe { Handle::get(place) }?;
        Ok((Self { place, crc: loaded.crc }, &loaded.felt))
    }

    /// The body, if it is still the one.
    ///
    /// # Safety
    /// As [`Handle::get`].
    pub unsafe fn body(self) -> Result<&'static Body<'static>, Status> {
        // SAFETY: by the caller's promise.
        let loaded = unsafe { Handle::get(self.place) }?;
        if loaded.crc == self.crc { Ok(&loaded.felt.0) } else { Err(Status::NotReady) }
    }
}

/// Sizes and format of a file, known before anything is built from it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FileInfo {
    pub faces: u32,
    pub edges: u32,
    pub buffer_bytes: u32,
    pub centre: [f32; 3],
    pub source: [u8; 32],
}

/// Where a closest point lies.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Located {
    pub face: u32,
    pub parameters: [f32; 2],
    pub point: [f32; 3],
    pub distance: f32,
    pub evaluations: u32,
    pub complete: u32,
}

/// Looks at a file.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_file_head(file: *const u8, bytes: usize, info: *mut FileInfo) -> Status {
    let look = || {
        // SAFETY: the caller's file.
        let head = FileHead::of(unsafe { row(file, bytes) }?)?;
        let buffer_bytes = head.faces * size_of::<Face>() + head.edges * size_of::<Edge>();
        let info_of = FileInfo {
            faces: head.faces as u32,
            edges: head.edges as u32,
            buffer_bytes: buffer_bytes as u32,
            centre: head.centre.to_array(),
            source: head.source,
        };
        // SAFETY: the caller's place for it.
        unsafe { put(info, info_of) }
    };
    code(look())
}

/// Makes a body of a file.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_body_load(
    body: *mut Handle<Loaded>,
    body_bytes: usize,
    file: *const u8,
    file_bytes: usize,
    buffer: *mut c_void,
    buffer_bytes: usize,
) -> Status {
    let load = || {
        // SAFETY: the caller's memory for the body.
        let place = unsafe { Handle::vacate(body, body_bytes) }?;
        // SAFETY: the caller's file, which stays.
        let file: &'static [u8] = unsafe { row(file, file_bytes) }?;
        let head = FileHead::of(file)?;
        // SAFETY: the caller's buffer, which stays.
        let (faces, rest, left) = unsafe { take_slots(buffer, buffer_bytes, head.faces, Face::VACANT) }?;
        let edges = if head.edges == 0 {
            &mut []
        } else {
            // SAFETY: what is left of it.
            unsafe { take_slots(rest, left, head.edges, Edge::VACANT) }?.0
        };
        // On any board.
        let body = Body::from_bytes(file, BodyBuffer { faces, edges })?.with_effort(Effort::ONE);
        // SAFETY: the place that was vacated.
        unsafe { Handle::fill(place, Loaded { crc: body.baked_crc(), felt: Felt(body) }) };
        Ok(())
    };
    code(load())
}

/// The closest point from a standing start.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_closest(
    body: *const Handle<Loaded>,
    probe: *const f32,
    located: *mut Located,
) -> Status {
    let locate = || {
        // SAFETY: the caller's handle.
        let Loaded { felt: Felt(body), .. } = unsafe { Handle::get(body) }?;
        // SAFETY: three numbers of the caller's.
        let probe: [f32; 3] = unsafe { get(probe.cast()) }?;
        finite(&probe)?;
        let found = body.locate(Vec3::from_array(probe));
        let located_at = Located {
            face: u32::from(found.face),
            parameters: found.parameters,
            point: found.point.to_array(),
            distance: found.distance(),
            evaluations: u32::from(found.evaluations),
            complete: u32::from(found.complete),
        };
        // SAFETY: the caller's place for it.
        unsafe { put(located, located_at) }
    };
    code(locate())
}
