//! The closest point of a body, followed from tick to tick.

use crate::body::{Loaded, Standing};
use crate::handle::{Handle, Kind};
use crate::pointers::{finite, get, put};
use crate::status::{Status, code};
use palpate_core::body::{Body, BodyStep, BodyWitness};
use palpate_core::math::Vec3;
use palpate_core::servo::Tracked as _;
use palpate_core::track::{Controller, Outcome, Probe};

/// The period does not matter to the law of second order: its step is certified, not timed.
const PERIOD: f32 = 1.0;

/// A witness point, the body it lies on, and what the last tick has done.
pub struct Tracking {
    standing: Standing,
    witness: BodyWitness,
    probe: Vec3,
    step: Option<BodyStep>,
}

impl Kind for Tracking {
    const MARK: usize = 0x5041_4c54;
}

/// Result of a tick.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Touch {
    pub point: [f32; 3],
    pub normal: [f32; 3],
    pub gap: f32,
    pub parameters: [f32; 2],
    pub feature: u32,
    pub contact: u32,
    pub located: u32,
    pub rejected: u32,
    pub searched: u32,
    pub unexplained: u32,
    pub too_deep: u32,
    pub evaluations: u32,
}

impl Tracking {
    fn track(&mut self, body: &Body<'_>, probe: Vec3) {
        self.step = Some(body.track(&Controller::SecondOrder, &mut self.witness, Probe::at(probe), PERIOD));
        self.probe = probe;
    }

    fn touch(&self, body: &Body<'_>) -> Touch {
        let witness = &self.witness;
        let step = self.step.as_ref();
        Touch {
            point: witness.witness.surface.point.to_array(),
            normal: witness.normal.to_array(),
            gap: witness.gap,
            parameters: witness.witness.parameters,
            feature: u32::from(witness.feature()),
            contact: witness.contact as u32,
            located: u32::from(witness.is_located),
            rejected: u32::from(step.is_some_and(|step| step.outcome == Outcome::Rejected)),
            searched: u32::from(step.is_some_and(|step| step.searched)),
            unexplained: u32::from(step.is_some_and(|step| step.unexplained)),
            too_deep: u32::from(body.is_too_deep(witness)),
            evaluations: step.map_or(0, |step| u32::from(step.evaluations)),
        }
    }
}

/// Makes a tracker that knows nothing.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_start(
    tracker: *mut Handle<Tracking>,
    tracker_bytes: usize,
    body: *const Handle<Loaded>,
) -> Status {
    // SAFETY: the caller's handles.
    code(unsafe { begin(tracker, tracker_bytes, body, |body| Ok(body.start())) })
}

/// Makes a tracker whose witness point lies on a face.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_start_on(
    tracker: *mut Handle<Tracking>,
    tracker_bytes: usize,
    body: *const Handle<Loaded>,
    face: u32,
    u: f32,
    v: f32,
) -> Status {
    let start = |body: &Body<'_>| {
        finite(&[u, v])?;
        let on = u16::try_from(face).ok().filter(|face| usize::from(*face) < body.faces().len());
        Ok(body.start_on(on.ok_or(Status::OutOfRange)?, [u, v]))
    };
    // SAFETY: the caller's handles.
    code(unsafe { begin(tracker, tracker_bytes, body, start) })
}

unsafe fn begin(
    tracker: *mut Handle<Tracking>,
    tracker_bytes: usize,
    body: *const Handle<Loaded>,
    start: impl FnOnce(&Body<'_>) -> Result<BodyWitness, Status>,
) -> Result<(), Status> {
    // SAFETY: the caller's memory for the tracker.
    let place = unsafe { Handle::vacate(tracker, tracker_bytes) }?;
    // SAFETY: the caller's body, which stays.
    let (standing, body) = unsafe { Standing::on(body) }?;
    let witness = start(&body.0)?;
    // SAFETY: the place that was vacated.
    unsafe { Handle::fill(place, Tracking { standing, witness, probe: Vec3::ZERO, step: None }) };
    Ok(())
}

/// Moves the witness point.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_track(tracker: *mut Handle<Tracking>, probe: *const f32) -> Status {
    let track = || {
        // SAFETY: the caller's handle, nobody else's.
        let tracking = unsafe { Handle::get_mut(tracker) }?;
        // SAFETY: three numbers of the caller's.
        let probe: [f32; 3] = unsafe { get(probe.cast()) }?;
        finite(&probe)?;
        // SAFETY: the body it was started on, which the caller keeps.
        let body = unsafe { tracking.standing.body() }?;
        tracking.track(body, Vec3::from_array(probe));
        Ok(())
    };
    code(track())
}

/// Normal, gap and contact after [`palpate_track`].
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_update_contact(tracker: *mut Handle<Tracking>, touch: *mut Touch) -> Status {
    let meet = || {
        // SAFETY: the caller's handle, nobody else's.
        let tracking = unsafe { Handle::get_mut(tracker) }?;
        // SAFETY: the body it was started on, which the caller keeps.
        let body = unsafe { tracking.standing.body() }?;
        let step = tracking.step.ok_or(Status::NotReady)?;
        if !step.searched {
            body.update_contact(&mut tracking.witness, tracking.probe, &step);
        }
        // SAFETY: the caller's place for it.
        unsafe { put(touch, tracking.touch(body)) }
    };
    code(meet())
}

/// A whole tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step(tracker: *mut Handle<Tracking>, probe: *const f32, touch: *mut Touch) -> Status {
    let step = || {
        // SAFETY: the caller's handle, nobody else's.
        let tracking = unsafe { Handle::get_mut(tracker) }?;
        // SAFETY: three numbers of the caller's.
        let probe: [f32; 3] = unsafe { get(probe.cast()) }?;
        finite(&probe)?;
        crate::pointers::checked_mut(touch)?;
        // SAFETY: the body it was started on, which the caller keeps.
        let body = unsafe { tracking.standing.body() }?;
        let probe = Vec3::from_array(probe);
        let step = body.step(&Controller::SecondOrder, &mut tracking.witness, Probe::at(probe), PERIOD);
        (tracking.step, tracking.probe) = (Some(step), probe);
        // SAFETY: the caller's place for it.
        unsafe { put(touch, tracking.touch(body)) }
    };
    code(step())
}
