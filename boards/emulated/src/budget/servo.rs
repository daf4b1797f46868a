//! The whole servo tick of a device with three joints.

use core::hint::black_box;

use palpate::device::Counts;
use palpate::math::sin_cos;
use palpate::render::Contact;
use palpate::servo::{Event, Input, Tracked};

use super::tally::Tally;
use crate::body::{SERVO, State};
use crate::timer::InstructionCounter;

/// Ticks of the path.
const TICKS: u32 = 100_000;

#[inline(never)]
fn tick(state: &mut State, input: Input<3>) {
    SERVO.tick(state, input);
}

/// Counts of the three encoders on a path over, through and beyond the demo's surface.
fn counts(tick: u32) -> [Counts; 3] {
    let phase = tick as f32 * 1.5e-3;
    let wave = |rate: f32| sin_cos((phase * rate) % core::f32::consts::TAU).0;
    // About the workspace centre: at first over the patch and through it, growing to beyond its corners.
    let growth = 1.0 + 0.5 * tick as f32 / TICKS as f32;
    let [a, b, c] = [1_800.0, 1_000.0, 1_400.0].map(|travel: f32| travel * growth);
    [
        Counts((-a * wave(1.0)) as i32),
        Counts((-1_320.0 + b * wave(1.37)) as i32),
        Counts((3_460.0 + c * wave(0.71)) as i32),
    ]
}

pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let mut state = SERVO.start();
    let mut ticks = Tally::new();
    let (mut touched, mut met) = (0, [0_u32; 3]);
    for index in 0..TICKS {
        let input = black_box(Input::Sensors { counts: counts(index), enable: true });
        // As the loop does with each frame: a host that is silent is a fault.
        SERVO.note(&mut state, Event::LinkAlive);
        let ((), instructions) = counter.count(|| tick(&mut state, input));
        ticks.add(instructions);
        touched += u32::from(state.contact == Contact::Touching);
        let feature = state.witness.feature();
        met[usize::from(feature >> 14)] |= 1 << (feature & 31);
    }
    ticks.print("servo tick");
    if state.fault.is_some() {
        return Err("the servo found a fault on its path");
    }
    if touched < TICKS / 100 {
        return Err("the servo's path hardly touches the surface");
    }
    semihosting::println!("{:?}", met.map(u32::count_ones));
    if met.map(u32::count_ones) != [6, 12, 8] {
        return Err("the servo's path misses a feature");
    }
    Ok(())
}
