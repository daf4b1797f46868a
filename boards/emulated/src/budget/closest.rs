//! One tick of the body's tracker: the switch between features, and one step on the active one; then what the loop asks
//! of the point.

use core::hint::black_box;

use palpate::body::{Body, BodyStep, BodyWitness, Feature};
use palpate::math::{Vec3, sin_cos, vec3};
use palpate::track::{Contact, Controller, Outcome, Probe};

use super::tables::CAPPED_BOX;
use super::tally::Tally;
use crate::timer::InstructionCounter;

/// Ticks of the walk.
const TICKS: u32 = 100_000;
/// Ticks between two jumps of the probe, after which the body is searched again.
const TICKS_PER_JUMP: u32 = 4_999;
/// The middle of the capped box, and how far the probe goes from it, metres: beyond each corner, and through the body.
#[cfg(not(feature = "around"))]
const PATH: [Vec3; 2] = [vec3(0.03, 0.02, 0.015), vec3(0.045, 0.034, 0.032)];
#[cfg(feature = "around")]
const PATH: [Vec3; 2] = crate::body::AROUND;

#[inline(never)]
fn tick(body: &Body, witness: &mut BodyWitness, position: &Vec3) -> BodyStep {
    body.track(&Controller::SecondOrder, witness, Probe::at(*position), 2.5e-4)
}

#[inline(never)]
fn meet(body: &Body, witness: &mut BodyWitness, position: &Vec3, step: &BodyStep) {
    body.update_contact(witness, *position, step);
}

/// Kinds of ticks.
const KINDS: [&str; 8] = [
    "on a face, in front of it",
    "on a face, pressed into it",
    "at the border of a face",
    "on an edge",
    "on a vertex",
    "from behind",
    "at a switch",
    "in the search",
];

/// The kind of a tick.
fn kind(before: &BodyWitness, after: &BodyWitness, step: &BodyStep) -> usize {
    match (after.feature, before.contact) {
        _ if !(before.is_located && after.is_located) => 7,
        _ if step.switched || before.feature != after.feature => 6,
        // The tracker's and the audit's, in turn.
        (_, Contact::Behind) => 5,
        (Feature::Vertex(_), _) => 4,
        (Feature::Edge(_), _) => 3,
        _ if !(before.witness.is_free && after.witness.is_free) => 2,
        (Feature::Face(_), Contact::Touching) => 1,
        (Feature::Face(_), Contact::InFront) => 0,
    }
}

/// A path through and around the body that never closes, 0.4 m/s at 4 kHz at most.
pub fn probe(tick: u32) -> Vec3 {
    // Each within the range for which the sine is good.
    let wave = |rate: f32| sin_cos((tick as f32 * 1e-3 * rate) % core::f32::consts::TAU).0;
    let [middle, travel] = PATH;
    middle + travel * vec3(wave(1.0), wave(1.37), wave(1.73))
}

/// The walk on the statics, kind by kind.
///
/// # Errors
/// The walk missed a feature, or a step was rejected.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    walk(counter, &CAPPED_BOX, "closest point of the capped box", true)
}

/// The walk on a body that is the capped box. `in_parts`: with each kind of tick by itself.
///
/// # Errors
/// The walk missed a feature, or a step was rejected.
pub fn walk(counter: &mut InstructionCounter, body: &Body<'_>, name: &str, in_parts: bool) -> Result<(), &'static str> {
    let body = black_box(body);
    let mut witness = body.start();
    let mut tallies = [const { Tally::new() }; KINDS.len()];
    let (mut any, mut contact, mut both) = (Tally::new(), Tally::new(), Tally::new());
    let mut met = [0_u32; 3];
    let mut rejected = 0_u32;
    for index in 0..TICKS {
        let index = if (index / TICKS_PER_JUMP) % 2 == 1 { index + TICKS } else { index };
        let position = black_box(probe(index));
        let before = witness;
        let (step, instructions) = counter.count(|| tick(body, &mut witness, &position));
        // As `Body::step` does.
        let mut sum = instructions;
        if !step.searched {
            let ((), spent) = counter.count(|| meet(body, &mut witness, &position, &step));
            contact.add(spent);
            sum += spent;
        }
        both.add(sum);
        rejected += u32::from(step.outcome == Outcome::Rejected);
        black_box(step);
        any.add(instructions);
        tallies[kind(&before, &witness, &step)].add(instructions);
        let code = witness.feature.code();
        met[usize::from(code >> 14)] |= 1 << (code & 31);
    }
    if in_parts {
        for (kind, tally) in KINDS.iter().zip(&tallies) {
            tally.print_as(name, kind);
        }
    }
    any.print_as(name, "any");
    if in_parts {
        contact.print("normal, gap and contact at the closest point");
        both.print("closest point of the capped box with normal, gap and contact, any");
    }
    if rejected > 0 {
        return Err("a step on the capped box was rejected");
    }
    if met.map(u32::count_ones) != [6, 12, 8] {
        return Err("the walk around the capped box misses a feature");
    }
    Ok(())
}
