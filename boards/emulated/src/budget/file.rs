//! Bodies from their files: the cost of checking and building one; a tick costs no more than on a body of statics.

use core::hint::black_box;

use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, FileError, TickLimit};
use semihosting::println;

use super::closest;
use crate::body::EFFORT;
use crate::timer::InstructionCounter;

static CAPPED_BOX: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../bodies/capped_box.palp"));
static SPHERE: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../bodies/sphere_body.palp"));

#[inline(never)]
fn load<'a>(bytes: &'a [u8], room: BodyBuffer<'a>, pause: &mut dyn FnMut()) -> Result<Body<'a>, FileError> {
    Body::from_bytes_with(bytes, room, TickLimit::BENCH, pause)
}

/// Loads the files, and walks around the capped box.
///
/// # Errors
/// That a file is refused, or what the walk ran into.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    let room = BodyBuffer { faces: &mut faces, edges: &mut edges };
    longest_stage(counter, "sphere_body", &SPHERE.0, room);
    let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    let room = BodyBuffer { faces: &mut faces, edges: &mut edges };
    let sphere = counted(counter, "sphere_body", &SPHERE.0, room)?;
    black_box(&sphere);
    let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    let room = BodyBuffer { faces: &mut faces, edges: &mut edges };
    let capped_box = counted(counter, "capped_box", &CAPPED_BOX.0, room)?;
    closest::walk(counter, &capped_box, "closest point of the capped box from its file", false)
}

fn counted<'a>(
    counter: &mut InstructionCounter,
    name: &str,
    bytes: &'a [u8],
    room: BodyBuffer<'a>,
) -> Result<Body<'a>, &'static str> {
    let bytes = black_box(bytes);
    let (body, instructions) = counter.count(|| load(bytes, room, &mut || ()));
    println!("\"loading {name}, {} bytes\" = {instructions}", bytes.len());
    body.map(|body| body.with_effort(EFFORT)).map_err(|_| "a body's file was refused")
}

/// The longest that a watchdog waits while a file is loaded.
#[inline(never)]
fn longest_stage<'a>(counter: &InstructionCounter, name: &str, bytes: &'a [u8], room: BodyBuffer<'a>) {
    let (mut last, mut longest) = (0, 0);
    let begun = counter.started();
    let mut pause = || {
        let now = counter.since(begun);
        (longest, last) = (longest.max(now - last), now);
    };
    let body = load(black_box(bytes), room, &mut pause);
    pause();
    black_box(&body);
    println!("\"loading {name}, the longest stage\" = {longest}");
}
