//! The whole servo tick of a device with three joints.

use core::hint::black_box;

use palpate::device::Counts;
use palpate::math::sin_cos;
use palpate::servo::{Event, Input, ServoState};
use semihosting::println;

use super::tally::Tally;
use crate::body::SERVO;
use crate::timer::InstructionCounter;

/// Ticks of the path.
const TICKS: u32 = 20_000;

#[inline(never)]
fn tick(state: &mut ServoState<3>, input: Input<3>) {
    SERVO.tick(state, input);
}

/// Counts of the three encoders on a path over, through and beyond the demo's surface.
fn counts(tick: u32) -> [Counts; 3] {
    let phase = tick as f32 * 1.5e-3;
    let wave = |rate: f32| sin_cos((phase * rate) % core::f32::consts::TAU).0;
    // The workspace centre, and somewhat less than the joints' travel over the patch.
    [
        Counts((-1_800.0 * wave(1.0)) as i32),
        Counts((-1_320.0 + 1_000.0 * wave(1.37)) as i32),
        Counts((3_460.0 + 1_400.0 * wave(0.71)) as i32),
    ]
}

pub fn run(counter: &mut InstructionCounter) {
    let mut state = SERVO.start();
    let mut ticks = Tally::new();
    let (mut touched, mut modes) = (0, [false; 7]);
    for index in 0..TICKS {
        let input = black_box(Input::Sensors { counts: counts(index), enable: true });
        // As the loop does with each frame: a host that is silent is a fault.
        SERVO.note(&mut state, Event::LinkAlive);
        let ((), instructions) = counter.count(|| tick(&mut state, input));
        ticks.add(instructions);
        touched += u32::from(state.contact as u8 == 2);
        modes[state.witness.mode as usize] = true;
    }
    ticks.print("servo tick");
    println!("\"ticks in contact\" = {touched}");
    println!("\"modes visited\" = {}", modes.iter().filter(|visited| **visited).count());
    println!("\"faults\" = {}", u32::from(state.fault.is_some()));
}
