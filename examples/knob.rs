//! A knob with detents: put your encoder and your motor where `Wheel` is. `cargo run --example knob`

use palpate::device::{Counts, Duty, Encoder, Motor, VelocityFilter};
use palpate::render::Detents;

const RATE: f32 = 4_000.0;
const ENCODER: Encoder = Encoder::geared(16_384.0, 1.0, 0.0);
const MOTOR: Motor = Motor::current_driven(0.02, 1.5, 1.0);
/// A detent every 15°, eleven of them, 25 mN·m at most, hard ends.
const DETENTS: Detents = Detents {
    pitch: 0.2618,
    stiffness: 0.15,
    damping: 2e-4,
    snap: 0.55,
    first: -5,
    last: 5,
    wall_stiffness: 0.6,
    max_force: 0.025,
};

fn main() {
    let filter = VelocityFilter::new(150.0, RATE);
    let (mut wheel, mut detent, mut last, mut speed) = (Wheel::default(), 0, 0.0, 0.0);
    for tick in 0..8_000 {
        let angle = ENCODER.angle(Counts((wheel.angle / ENCODER.radians_per_count).floor() as i32));
        speed = filter.next(speed, angle - last);
        last = angle;
        let torque = DETENTS.force(&mut detent, angle, speed);
        // A finger that pulls harder and harder from detent to detent, and lets go in between.
        let pull = if tick % 2_000 < 1_000 { 2.4e-5 * (tick % 2_000) as f32 } else { 0.0 };
        wheel.turn(Duty::from_fraction(MOTOR.fraction(torque)), pull);
        if tick % 400 == 0 {
            println!("{:5.2} s  detent {detent:2}  angle {angle:6.3} rad  torque {torque:7.4} N·m", tick as f32 / RATE);
        }
    }
}

include!("wheel/mod.rs");
