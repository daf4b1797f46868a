//! One step of the controller, its one evaluation included.

use core::hint::black_box;

use palpate::math::{Vec3, sin_cos, vec3};
use palpate::patch::{Patch, SplinePatch};
use palpate::track::{BoundaryMode, Controller, Outcome, Probe, Step, Witness};

use super::tables::table1c::PATCHES;
use super::tally::Tally;
use crate::timer::InstructionCounter;

/// Steps of the walk.
const STEPS: u32 = 20_000;

/// The boundary modes, in the order of their numbers.
const MODES: [(BoundaryMode, &str); 6] = [
    (BoundaryMode::LowerU, "step held at u = 0"),
    (BoundaryMode::UpperU, "step held at u = 1"),
    (BoundaryMode::LowerV, "step held at v = 0"),
    (BoundaryMode::UpperV, "step held at v = 1"),
    (BoundaryMode::Interior, "step on the face"),
    (BoundaryMode::Corner, "step held at a corner"),
];

#[inline(never)]
fn step(patch: &SplinePatch, witness: &mut Witness, position: Vec3) -> Step {
    Controller::SecondOrder.step(patch, witness, Probe::at(position), 2.5e-4)
}

/// A path around and over the patch: three turns that never close, beyond its borders and through it.
fn probe(middle: Vec3, size: f32, step: u32) -> Vec3 {
    let phase = step as f32 * 2e-3;
    // Each within the range for which the sine is good.
    let wave = |rate: f32| sin_cos((phase * rate) % core::f32::consts::TAU).0;
    middle + vec3(wave(1.0), wave(1.37), 0.6 * wave(0.71)) * size
}

pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let patch = black_box(&PATCHES[0]);
    let mut witness = Witness::at(patch, 0.5, 0.5);
    let middle = witness.surface.point;
    let mut tallies = [const { Tally::new() }; 6];
    let mut steps = Tally::new();
    let mut rejected = 0_u32;
    for index in 0..STEPS {
        // A jump now and then: long steps, cut at the border.
        let index = if index % 97 == 0 { index.wrapping_mul(7_919) % STEPS } else { index };
        let position = black_box(probe(middle, patch.size(), index));
        let before = witness.parameters;
        let (found, instructions) = counter.count(|| step(patch, &mut witness, position));
        rejected += u32::from(found.outcome == Outcome::Rejected);
        black_box(found);
        steps.add(instructions);
        // On the face: from the interior to the interior.
        let inside = [before, witness.parameters].as_flattened().iter().all(|x| *x > 0.0 && *x < 1.0);
        if inside || witness.mode != BoundaryMode::Interior {
            tallies[witness.mode as usize - 1].add(instructions);
        }
    }
    for ((_, name), tally) in MODES.iter().zip(&tallies) {
        tally.print(name);
    }
    steps.print("step, any");
    // A mode that was not met prints no figure, and the host misses it.
    if rejected > 0 { Err("a step was rejected") } else { Ok(()) }
}
