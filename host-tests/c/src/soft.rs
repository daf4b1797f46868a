//! Bodies that give way: a body and its modes.

use crate::body::{Loaded, Standing};
use crate::felt::Felt;
use crate::handle::{Handle, Kind};
use crate::pointers::{Plain, finite, row, take_slots};
use crate::status::{Status, code};
use core::ffi::c_void;
use palpate_core::body::Soft;
use palpate_core::field::{Bump, FieldBounds, MAX_MODES, Modal, Mode, Quadratic};
use palpate_core::math::Vec3;
use palpate_core::servo::SoftBody;

/// A mode and its motion.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ModeNumbers {
    pub constant: [f32; 3],
    pub linear: [[f32; 3]; 3],
    pub quadratic: [[f32; 3]; 6],
    pub bump_direction: [f32; 3],
    pub bump_at: [f32; 3],
    pub bump_radius: f32,
    pub limit: f32,
    pub motion: f32,
    pub stretch: f32,
    pub bend: f32,
    pub twist: f32,
    pub mass: f32,
    pub damping: f32,
    pub stiffness: f32,
}

// SAFETY: floats alone.
unsafe impl Plain for ModeNumbers {}

impl ModeNumbers {
    fn mode(&self) -> Mode {
        let Self { motion, stretch, bend, twist, .. } = *self;
        let bump = Bump {
            direction: Vec3::from_array(self.bump_direction),
            at: Vec3::from_array(self.bump_at),
            radius: self.bump_radius,
        };
        Mode {
            field: Quadratic {
                constant: Vec3::from_array(self.constant),
                linear: self.linear.map(Vec3::from_array),
                quadratic: self.quadratic.map(Vec3::from_array),
            },
            bump: if self.bump_radius == 0.0 { None } else { Some(bump) },
            limit: self.limit,
            bounds: FieldBounds { motion, stretch, bend, twist },
        }
    }

    const fn modal(&self) -> Modal {
        Modal { mass_kg: self.mass, damping_n_s_per_m: self.damping, stiffness_n_per_m: self.stiffness }
    }
}

/// A body whose modes lie in memory of the caller's.
pub struct Softened {
    standing: Standing,
    felt: Felt<SoftBody<'static>>,
    /// Hash of its modes: shows that a handle was loaded again with others.
    hash: u32,
}

impl Kind for Softened {
    const MARK: usize = 0x5041_4c47;
}

/// A body that gives way as a loop on it knows it.
#[derive(Clone, Copy)]
pub struct SoftStanding {
    place: *const Handle<Softened>,
    hash: u32,
}

impl SoftStanding {
    /// Whether body and modes are still those.
    ///
    /// # Safety
    /// As [`Handle::get`].
    pub unsafe fn check(self) -> Result<(), Status> {
        // SAFETY: by the caller's promise.
        let soft = unsafe { Handle::get(self.place) }?;
        // SAFETY: as above.
        unsafe { soft.standing.body() }?;
        if soft.hash == self.hash { Ok(()) } else { Err(Status::NotReady) }
    }
}

impl Softened {
    /// To stand on it.
    ///
    /// # Safety
    /// As [`Handle::get`], for as long as anything stands on it.
    pub unsafe fn stand(
        place: *const Handle<Self>,
    ) -> Result<(SoftStanding, &'static Felt<SoftBody<'static>>), Status> {
        // SAFETY: by the caller's promise.
        let soft = unsafe { Handle::get(place) }?;
        let standing = SoftStanding { place, hash: soft.hash };
        // SAFETY: as above.
        unsafe { standing.check() }?;
        Ok((standing, &soft.felt))
    }
}

/// Gives a body modes.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_soft_body_load(
    soft: *mut Handle<Softened>,
    soft_bytes: usize,
    body: *const Handle<Loaded>,
    modes: *const ModeNumbers,
    count: usize,
    rate: f32,
    buffer: *mut c_void,
    buffer_bytes: usize,
) -> Status {
    let load = || {
        // SAFETY: the caller's memory for it.
        let place = unsafe { Handle::vacate(soft, soft_bytes) }?;
        // SAFETY: the caller's body, which stays.
        let (standing, Felt(body)) = unsafe { Standing::on(body) }?;
        if count == 0 || count > MAX_MODES {
            return Err(Status::SoftModes);
        }
        // SAFETY: the caller's modes: floats alone.
        let numbers = unsafe { row(modes.cast::<f32>(), count * (size_of::<ModeNumbers>() / size_of::<f32>())) }?;
        finite(numbers)?;
        // SAFETY: the same.
        let given = unsafe { row(modes, count) }?;
        // SAFETY: the caller's buffer, which stays.
        let (slots, ..) = unsafe { take_slots(buffer, buffer_bytes, count, VACANT) }?;
        let mut motion = [Modal { mass_kg: 0.0, damping_n_s_per_m: 0.0, stiffness_n_per_m: 1.0 }; MAX_MODES];
        for ((slot, motion), numbers) in slots.iter_mut().zip(&mut motion).zip(given) {
            (*slot, *motion) = (numbers.mode(), numbers.modal());
        }
        let motion = motion.get(..count).ok_or(Status::SoftModes)?;
        let felt = Felt(SoftBody::new(Soft::new(*body, slots)?, motion, rate)?);
        let hash = numbers.iter().fold(rate.to_bits(), |hash, number| (hash ^ number.to_bits()).wrapping_mul(PRIME));
        // SAFETY: the place that was vacated.
        unsafe { Handle::fill(place, Softened { standing, felt, hash }) };
        Ok(())
    };
    code(load())
}

/// Of FNV-1a.
const PRIME: u32 = 0x0100_0193;

const VACANT: Mode = Mode { field: Quadratic::ZERO, bump: None, limit: 0.0, bounds: FieldBounds::ZERO };
