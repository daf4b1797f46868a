//! The closest pair of two patches, each a face of a body.

use crate::body::{Loaded, Standing};
use crate::handle::{Handle, Kind};
use crate::pointers::{Plain, checked_mut, finite, get, put};
use crate::status::{Status, code};
use palpate_core::body::Body;
use palpate_core::math::Vec3;
use palpate_core::patch::SplinePatch;
use palpate_core::track::{PairTracker, PairWitness, Placement};

/// Two witness points, and the faces they lie on.
pub struct Paired {
    on: [(Standing, u16); 2],
    witness: PairWitness,
}

impl Kind for Paired {
    const MARK: usize = 0x5041_4c50;
}

/// Where the second body stands in the frame of the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Pose {
    pub axes: [[f32; 3]; 3],
    pub origin: [f32; 3],
    pub velocity: [f32; 3],
    pub angular_velocity: [f32; 3],
}

// SAFETY: floats alone.
unsafe impl Plain for Pose {}

/// Result of a step.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Apart {
    pub first: [f32; 3],
    pub second: [f32; 3],
    pub difference: [f32; 3],
    pub distance: f32,
    pub first_parameters: [f32; 2],
    pub second_parameters: [f32; 2],
}

impl Pose {
    fn placement(&self) -> Result<Placement, Status> {
        finite(self.axes.as_flattened())?;
        for vector in [&self.origin, &self.velocity, &self.angular_velocity] {
            finite(vector)?;
        }
        Ok(Placement {
            axes: self.axes.map(Vec3::from_array),
            origin: Vec3::from_array(self.origin),
            velocity: Vec3::from_array(self.velocity),
            angular_velocity: Vec3::from_array(self.angular_velocity),
        })
    }
}

fn patch_of(body: &'static Body<'static>, face: u32) -> Result<(u16, &'static SplinePatch<'static>), Status> {
    let index = u16::try_from(face).map_err(|_| Status::OutOfRange)?;
    body.faces().get(usize::from(index)).map(|face| (index, &face.patch)).ok_or(Status::OutOfRange)
}

/// Makes a pair with its points in the middle of two faces.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_pair_start(
    pair: *mut Handle<Paired>,
    pair_bytes: usize,
    first: *const Handle<Loaded>,
    first_face: u32,
    second: *const Handle<Loaded>,
    second_face: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's memory for the pair.
        let place = unsafe { Handle::vacate(pair, pair_bytes) }?;
        // SAFETY: the caller's bodies, which stay.
        let ((a, body_a), (b, body_b)) = unsafe { (Standing::on(first)?, Standing::on(second)?) };
        let ((face_a, f), (face_b, h)) = (patch_of(&body_a.0, first_face)?, patch_of(&body_b.0, second_face)?);
        let witness = PairWitness::at(f, h, [0.5; 2], [0.5; 2]);
        // SAFETY: the place that was vacated.
        unsafe { Handle::fill(place, Paired { on: [(a, face_a), (b, face_b)], witness }) };
        Ok(())
    };
    code(start())
}

/// One step towards the closest pair.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_pair_step(pair: *mut Handle<Paired>, pose: *const Pose, apart: *mut Apart) -> Status {
    let step = || {
        // SAFETY: the caller's handle, nobody else's.
        let Paired { on: [(a, face_a), (b, face_b)], witness } = unsafe { Handle::get_mut(pair) }?;
        // SAFETY: the caller's numbers.
        let placement = unsafe { get(pose) }?.placement()?;
        checked_mut(apart)?;
        // SAFETY: the bodies it was started on, which the caller keeps.
        let (body_a, body_b) = unsafe { (a.body()?, b.body()?) };
        let ((_, f), (_, h)) = (patch_of(body_a, u32::from(*face_a))?, patch_of(body_b, u32::from(*face_b))?);
        let step = PairTracker::default().step(f, h, &placement, witness, 1.0);
        let found = Apart {
            first: witness.a.surface.point.to_array(),
            second: witness.b.surface.point.to_array(),
            difference: step.difference.to_array(),
            distance: palpate_core::math::sqrt(step.difference.length_squared()),
            first_parameters: witness.a.parameters,
            second_parameters: witness.b.parameters,
        };
        // SAFETY: the caller's place for it.
        unsafe { put(apart, found) }
    };
    code(step())
}
