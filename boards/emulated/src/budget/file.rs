//! Bodies from their files: what it takes to check and build one, and that it costs no more to be felt than one of
//! statics.

use core::hint::black_box;

use palpate::body::{Aligned, Body, Edge, Face, FileError, Room};
use semihosting::println;

use super::closest;
use crate::timer::InstructionCounter;

static CAPPED_BOX: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../bodies/capped_box.palp"));
static SPHERE: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../bodies/sphere_body.palp"));

#[inline(never)]
fn load<'a>(bytes: &'a [u8], room: Room<'a>) -> Result<Body<'a>, FileError> {
    Body::from_bytes(bytes, room)
}

/// Loads the files, and walks around the capped box.
///
/// # Errors
/// That a file is refused, or what the walk ran into.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    let room = Room { faces: &mut faces, edges: &mut edges };
    let sphere = counted(counter, "sphere_body", &SPHERE.0, room)?;
    black_box(&sphere);
    let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    let room = Room { faces: &mut faces, edges: &mut edges };
    let capped_box = counted(counter, "capped_box", &CAPPED_BOX.0, room)?;
    closest::walk(counter, &capped_box, "closest point of the capped box from its file", false)
}

fn counted<'a>(
    counter: &mut InstructionCounter,
    name: &str,
    bytes: &'a [u8],
    room: Room<'a>,
) -> Result<Body<'a>, &'static str> {
    let bytes = black_box(bytes);
    let (body, instructions) = counter.count(|| load(bytes, room));
    println!("\"loading {name}, {} bytes\" = {instructions}", bytes.len());
    body.map_err(|_| "a body's file was refused")
}
