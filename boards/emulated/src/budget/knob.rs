//! The tick of a knob: one joint, from its count to the widths of three phases.

use core::hint::black_box;

use palpate::device::Counts;
use palpate::servo::{Event, Input, Phase};

use super::tally::Tally;
use crate::knob::{SERVO, tick};
use crate::timer::InstructionCounter;

/// Ticks of each feel.
const TICKS: u32 = 8_000;
const FEELS: u8 = 6;
/// Counts of the field's electrical turn over its ticks: 16,384/11/2,000.
const COUNTS_PER_TICK: f32 = 0.744_727;

/// Counts the ticks of a dial that follows its field while it is aligned, and then turns there and back through every
/// feel.
///
/// # Errors
/// It was not aligned, or found a fault.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let mut state = SERVO.start();
    let (mut aligning, mut running) = (Tally::new(), Tally::new());
    let mut led = 0_i32;
    while !state.homed() {
        // The second tick begins it; then comes the ramp, two turns there and one back.
        let along = if led < 6_000 - 2_000 { led } else { 8_000 - led };
        let counts = Counts((along as f32 * COUNTS_PER_TICK) as i32);
        let input = black_box(Input::Sensors { counts: [counts], enable: true });
        SERVO.note(&mut state, Event::Supply { millivolts: 12_000 });
        let (_, instructions) = counter.count(|| tick(&mut state, input));
        aligning.add(instructions);
        if state.ticks() > 801 {
            led += 1;
        }
        if state.fault().is_some() || state.ticks() > 20_000 {
            return Err("the knob's rotor was not aligned");
        }
    }
    for feel in 0..FEELS {
        SERVO.note(&mut state, Event::Chosen { index: feel });
        for index in 0..TICKS {
            // Two radians there and back, and a tremor.
            let way = if index < TICKS / 2 { index } else { TICKS - index } as i32;
            let counts = Counts(way * 5_200 / (TICKS as i32 / 2) - (index as i32 % 7));
            let input = black_box(Input::Sensors { counts: [counts], enable: true });
            SERVO.note(&mut state, Event::Supply { millivolts: 12_000 });
            let (_, instructions) = counter.count(|| tick(&mut state, input));
            if state.phase() == Phase::Running {
                running.add(instructions);
            }
        }
    }
    aligning.print("knob tick, while the rotor is aligned");
    running.print("knob tick");
    if state.fault().is_some() { Err("the knob found a fault on its path") } else { Ok(()) }
}
