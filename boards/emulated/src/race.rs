//! The race on the target: one contestant answers the probes of a file of the host, its instructions counted probe by
//! probe.
//!
//! `race.in` holds words: the contestant's number, the number of probes, the number of words of its table, the table,
//! the probes. `race.out` gets eight words a probe: instructions, gap, normal, point.

use bytemuck::{cast_slice, cast_slice_mut};
use core::hint::black_box;
use palpate::body::{Body, BodyBuffer, BodyWitness, Edge, Effort, Face};
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_rivals::{ANSWER_WORDS, Answer, Contestant, Grid, Mesh, Newton, Walk};
use semihosting::fs::{self, File};
use semihosting::io::Read;
use static_cell::ConstStaticCell;

use crate::timer::InstructionCounter;

/// Words of the host's file: a table of 512 KB, and 30,000 probes.
static INPUT: ConstStaticCell<[u32; 1 << 18]> = ConstStaticCell::new([0; 1 << 18]);
/// Words of the answers.
static OUTPUT: ConstStaticCell<[u32; 1 << 18]> = ConstStaticCell::new([0; 1 << 18]);
/// Faces and edges of the largest body.
const MAX_FACES: usize = 64;
const MAX_EDGES: usize = 128;
/// Ticks in which palpate finds its start; a rival is given one.
const SETTLING: u32 = 500;
const PERIOD_S: f32 = 2.5e-4;

#[inline(never)]
fn palpate(body: &Body, witness: &mut BodyWitness, position: Vec3) -> Answer {
    body.step(&Controller::SecondOrder, witness, Probe::at(position), PERIOD_S);
    Answer { gap_m: witness.gap, normal: witness.normal, point: witness.witness.surface.point }
}

#[inline(never)]
fn newton(newton: &mut Newton, position: Vec3) -> Answer {
    newton.tick(position)
}

#[inline(never)]
fn tricubic(grid: &Grid, position: Vec3) -> Answer {
    grid.tricubic(position)
}

#[inline(never)]
fn trilinear(grid: &Grid, position: Vec3) -> Answer {
    grid.trilinear(position)
}

#[inline(never)]
fn facets(walk: &mut Walk, position: Vec3) -> Answer {
    walk.facets(position)
}

#[inline(never)]
fn shaded(walk: &mut Walk, position: Vec3) -> Answer {
    walk.shaded(position)
}

/// Runs the contestant that the host asks for.
///
/// # Errors
/// A file that cannot be read or written, or is no race.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let input = INPUT.take();
    read(cast_slice_mut(input))?;
    let ([contestant, probes, words], rest) = input.split_first_chunk().ok_or("race.in has no head")?;
    let (table, rest) = rest.split_at_checked(*words as usize).ok_or("race.in: the table does not fit")?;
    let probes =
        cast_slice::<u32, f32>(rest).as_chunks().0.get(..*probes as usize).ok_or("race.in: too many probes")?;
    let first = Vec3::from_array(*probes.first().ok_or("race.in: no probe")?);
    let contestant =
        Contestant::ALL.into_iter().find(|known| *known as u32 == *contestant).ok_or("no such contestant")?;
    let (mut faces, mut edges) = ([Face::VACANT; MAX_FACES], [Edge::VACANT; MAX_EDGES]);
    let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
    match contestant {
        Contestant::Palpate | Contestant::PalpateOne => {
            let body = Body::from_bytes(cast_slice(table), buffer).map_err(|_| "the body was refused")?;
            let body = if contestant == Contestant::PalpateOne { body.with_effort(Effort::ONE) } else { body };
            let mut witness = body.start();
            for _ in 0..SETTLING {
                palpate(&body, &mut witness, first);
            }
            answer(counter, probes, |position| palpate(&body, &mut witness, position))
        }
        Contestant::Newton => {
            let body = Body::from_bytes(cast_slice(table), buffer).map_err(|_| "the body was refused")?;
            let mut state = Newton::start(&body, first);
            answer(counter, probes, |position| newton(&mut state, position))
        }
        Contestant::Tricubic | Contestant::Trilinear => {
            let grid = Grid::of(table).ok_or("no grid")?;
            if contestant == Contestant::Tricubic {
                answer(counter, probes, |position| tricubic(&grid, position))
            } else {
                answer(counter, probes, |position| trilinear(&grid, position))
            }
        }
        Contestant::Facets | Contestant::Shaded => {
            let mut walk = Mesh::of(table).ok_or("no mesh")?.start(first);
            if contestant == Contestant::Facets {
                answer(counter, probes, |position| facets(&mut walk, position))
            } else {
                answer(counter, probes, |position| shaded(&mut walk, position))
            }
        }
    }
}

fn answer(
    counter: &mut InstructionCounter,
    probes: &[[f32; 3]],
    mut tick: impl FnMut(Vec3) -> Answer,
) -> Result<(), &'static str> {
    let output = OUTPUT.take();
    let rows = output.as_chunks_mut::<ANSWER_WORDS>().0;
    for (probe, row) in probes.iter().zip(&mut *rows) {
        let position = black_box(Vec3::from_array(*probe));
        let (found, instructions) = counter.count(|| tick(position));
        let Answer { gap_m, normal, point } = black_box(found);
        let numbers = [gap_m, normal.x, normal.y, normal.z, point.x, point.y, point.z].map(f32::to_bits);
        let [a, b, c, d, e, f, g] = numbers;
        *row = [instructions, a, b, c, d, e, f, g];
    }
    let written = rows.get(..probes.len()).ok_or("too many probes")?.as_flattened();
    fs::write(c"race.out", cast_slice::<u32, u8>(written)).map_err(|_| "race.out cannot be written")
}

/// Reads the host's file as far as it goes.
fn read(mut into: &mut [u8]) -> Result<(), &'static str> {
    let mut file = File::open(c"race.in").map_err(|_| "race.in cannot be opened")?;
    loop {
        let read = file.read(into).map_err(|_| "race.in cannot be read")?;
        if read == 0 {
            return if into.is_empty() { Err("race.in is too long") } else { Ok(()) };
        }
        into = into.get_mut(read..).unwrap_or_default();
    }
}
