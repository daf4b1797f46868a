//! Queries without history on the body of any file: in front of its faces, and anywhere in the locator's cube.

use core::hint::black_box;

use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, MAX_FACES, TickLimit};
use palpate::math::{Vec3, vec3};
use palpate::patch::Patch as _;
use semihosting::println;

use crate::timer::InstructionCounter;

static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(env!("PALPATE_COLD_FILE")));

const QUERIES: usize = 1_000;
/// Metres, how far in front of a face.
const IN_FRONT: f32 = 0.4e-3;

/// Numbers from 0 to 1, the same in every run.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }
}

/// Loads the body and asks.
///
/// # Errors
/// That the file is refused.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let (mut faces, mut edges) = ([Face::VACANT; MAX_FACES], [Edge::VACANT; 4 * MAX_FACES]);
    let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
    let loaded = Body::from_bytes_with(&FILE.0, buffer, TickLimit::NONE, &mut || ());
    let body = loaded.map_err(|_| "the body's file was refused")?;
    let in_front = |random: &mut Random| {
        let face = &body.faces()[(random.next() * body.faces().len() as f32) as usize];
        let surface = face.patch.evaluate(random.next(), random.next());
        let outward = surface.tangent_u.cross(surface.tangent_v).normalize_or_zero();
        surface.point + outward * (IN_FRONT * face.patch.orientation())
    };
    count(counter, &body, "in front of a face", in_front);
    let (corner, side) = (body.locator().corner, body.locator().side);
    let anywhere = |random: &mut Random| corner + vec3(random.next(), random.next(), random.next()) * side;
    count(counter, &body, "anywhere", anywhere);
    Ok(())
}

fn count(counter: &mut InstructionCounter, body: &Body<'_>, what: &str, probe: impl Fn(&mut Random) -> Vec3) {
    let (mut random, mut counts) = (Random(1), [0; QUERIES]);
    for of in &mut counts {
        let probe = black_box(probe(&mut random));
        (_, *of) = counter.count(|| black_box(body.locate(probe)));
    }
    counts.sort_unstable();
    println!("\"cold query, {what}, median\" = {}", counts[QUERIES / 2]);
    println!("\"cold query, {what}, worst\" = {}", counts[QUERIES - 1]);
}
