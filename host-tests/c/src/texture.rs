//! The program's texture: a function of its own, asked in every tick that touches.

use crate::pointers::checked_mut;
use crate::status::{Status, code};
use core::ptr::null_mut;
use core::sync::atomic::{AtomicPtr, Ordering};
use palpate_core::math::Vec3;
use palpate_core::render::{Texture, TextureShape, Touch as Touched};

/// Inputs of a texture.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TouchedNumbers {
    pub parameters: [f32; 2],
    pub point: [f32; 3],
    pub normal: [f32; 3],
    pub along_u: [f32; 3],
    pub velocity: [f32; 3],
    pub push: f32,
}

/// A texture of the program's.
pub type TextureForce = extern "C" fn(*const TouchedNumbers, *mut f32);

/// The library's textures are functions without data: so the program's lies here, one for all of its loops.
static FORCE: AtomicPtr<()> = AtomicPtr::new(null_mut());

/// Takes the program's texture.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_texture(force: Option<TextureForce>) -> Status {
    let pointer = force.map_or(null_mut(), |force| force as *mut ());
    code(checked_mut(pointer).map(|pointer| FORCE.store(pointer, Ordering::Release)))
}

/// The texture at this share of the normal force; none for 0.
pub fn texture(max_share: f32) -> Result<Option<Texture>, Status> {
    if max_share == 0.0 {
        return Ok(None);
    }
    if FORCE.load(Ordering::Acquire).is_null() {
        return Err(Status::SettingsTexture);
    }
    Ok(Some(Texture { shape: TextureShape::Custom(asked), max_fraction: max_share }))
}

fn asked(touch: &Touched) -> Vec3 {
    let pointer = FORCE.load(Ordering::Acquire);
    if pointer.is_null() {
        return Vec3::ZERO;
    }
    // SAFETY: whatever is not null in there was such a function.
    let force = unsafe { core::mem::transmute::<*mut (), TextureForce>(pointer) };
    let touched = TouchedNumbers {
        parameters: touch.parameters,
        point: touch.point.to_array(),
        normal: touch.normal.to_array(),
        along_u: touch.along_u.to_array(),
        velocity: touch.velocity.to_array(),
        push: touch.push,
    };
    let mut given = [0.0; 3];
    force(&raw const touched, given.as_mut_ptr());
    Vec3::from_array(given)
}
