//! The knob: the firmware's loop on a simulated dial, a hand that turns it, and the same parts of a feel as frames for
//! a device on the line.

use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use core::f32::consts::TAU;
use palpate::device::drive::Feed;
use palpate::device::presets::GIMBAL_KNOB;
use palpate::device::{Counts, Device, Dial};
use palpate::render::{Detents, DialFriction, Ends, Feel, FeelPart, Notch, Spring, Wave};
use palpate::scene::Command;
use palpate::servo::{Config, Event, Guard, Input, Knob, KnobWitness, Servo, ServoState, Settings, Unguarded};
use palpate::wire::{HostMessage, PROTOCOL, frame};

/// The knob of the boards, its motor driven by current: what the voltage of a phase does is no matter of the feel.
static DEVICE: Device<Dial, 1> = Device { feeds: [Feed::Current], ..GIMBAL_KNOB };
static FEELS: [Feel; 1] = [Feel::FREE];
/// As the boards let go of a torque, N·m/s.
static KNOB: Knob = Knob::new(&DEVICE, &FEELS, 1.2);
const RATE_HZ: f32 = 4_000.0;
static SERVO: Servo<'static, Knob, Dial, 1> = Servo::new(
    &DEVICE,
    &KNOB,
    Config {
        settings: Settings { rate_hz: RATE_HZ, max_force_n: GIMBAL_KNOB.max_force_n, ..Settings::DEFAULT },
        ..Config::DEFAULT
    },
);

/// Rotor and dial, kg·m², and what slows them, N·m·s/rad and N·m.
const INERTIA: f32 = 5e-5;
const VISCOUS: f32 = 2e-4;
const COULOMB: f32 = 1e-3;
/// Fingers on the rim: N·m/rad towards where they are, damped critically, and their strength, N·m.
const GRIP: f32 = 0.25;
const GRIP_DAMPING: f32 = 7e-3;
const STRONGEST: f32 = 0.12;
/// Steps of integration in a tick.
const STEPS: u32 = 4;

/// A part of a feel from its numbers, in the order of their fields; without a torque, stiffness or range it is taken
/// away. Which: 0 detents, 1 clicks, 2 texture, 3 spring, 4 end stops, 5 damping, 6 friction, 7 notch, 8 none is left.
pub fn part(which: u32, [a, b, c, d]: [f32; 4]) -> FeelPart {
    let wave = || (b > 0.0).then_some(Wave { pitch_rad: a, torque_n_m: b, centre_rad: c });
    match which {
        0 => FeelPart::Detents(wave()),
        // The torque is that at which the next detent takes over.
        1 => FeelPart::Clicks((b > 0.0).then_some(Detents {
            pitch: a,
            stiffness: b / (SNAP * a),
            damping: 3e-4,
            snap: SNAP,
            first: c as i32,
            last: d as i32,
            // End stops push beside it, and both within what the motor bears.
            wall_stiffness: 0.4,
            max_force: b,
        })),
        2 => FeelPart::Texture(wave()),
        3 => FeelPart::Spring((a > 0.0).then_some(Spring { stiffness_n_m_per_rad: a, rest_rad: b, max_torque_n_m: c })),
        4 => FeelPart::Ends((c > 0.0).then_some(Ends {
            between_rad: [a, b],
            stiffness_n_m_per_rad: c,
            damping_n_m_s_per_rad: d,
        })),
        5 => FeelPart::Damping(a),
        6 => FeelPart::Friction((a > 0.0).then_some(DialFriction { torque_n_m: a, whole_at_rad_per_s: b })),
        7 => FeelPart::Notch((c > 0.0).then_some(Notch { at_rad: a, width_rad: b, torque_n_m: c })),
        _ => FeelPart::Free,
    }
}

/// Hysteresis of clicks, in pitches.
const SNAP: f32 = 0.55;

/// A frame for a device: a part under a number, or instead of one −1 for a greeting, −2 for a sign of life.
pub fn frame(number: i32, part: FeelPart) -> Vec<u8> {
    let message = match u16::try_from(number) {
        Ok(number) => HostMessage::Command { number, command: Command::Feel(part) },
        Err(_) if number == -1 => HostMessage::Hello { protocol: PROTOCOL },
        Err(_) => HostMessage::Alive,
    };
    let mut buffer = [0; frame::MAX_FRAME];
    // The buffer holds any frame.
    frame::pack(&message, &mut buffer).map(<[u8]>::to_vec).unwrap_or_default()
}

/// The dial with its loop.
pub struct Turned {
    state: ServoState<1, KnobWitness, <Unguarded as Guard<1>>::State>,
    angle: f32,
    rate: f32,
    hand: f32,
    /// The maximum change of the feel's torque from tick to tick in the last run, N·m.
    step: f32,
}

impl Turned {
    /// A dial at rest.
    pub fn new() -> Self {
        Self { state: SERVO.start(), angle: 0.0, rate: 0.0, hand: 0.0, step: 0.0 }
    }

    /// Sets a part of the feel, with all the checks of a device.
    ///
    /// # Errors
    /// The refused number, in a sentence.
    pub fn set(&mut self, part: FeelPart) -> Result<(), String> {
        KNOB.set(self.state.witness_mut(), part).map_err(|error| error.to_string())
    }

    /// A number of ticks, in which fingers turn evenly to an angle, radians, or hold nothing.
    pub fn run(&mut self, ticks: u32, to: f32, holds: bool) {
        let from = if holds { self.hand } else { self.angle };
        let torque = GIMBAL_KNOB.motors[0].torque_at_full_n_m;
        let period = 1.0 / (RATE_HZ * STEPS as f32);
        let speed = (to - from) * RATE_HZ / ticks.max(1) as f32;
        self.step = 0.0;
        for tick in 0..ticks {
            let before = self.state.witness().torque();
            let count = self.angle / GIMBAL_KNOB.encoders[0].radians_per_count;
            // The cast truncates; the place of a count is its middle.
            let count = count as i32 - i32::from(count < 0.0);
            SERVO.note(&mut self.state, Event::LinkAlive);
            let _ = SERVO.tick(&mut self.state, Input::Sensors { counts: [Counts(count)], enable: true });
            self.step = self.step.max((self.state.witness().torque() - before).abs());
            let motor = torque * self.state.duties()[0].fraction();
            for step in 0..STEPS {
                let place = from + (to - from) * (tick as f32 + (step + 1) as f32 / STEPS as f32) / ticks as f32;
                let pull = GRIP * (place - self.angle) + GRIP_DAMPING * (speed - self.rate);
                let pull = if holds { pull.clamp(-STRONGEST, STRONGEST) } else { 0.0 };
                // Dry friction is whole from 0.3 rad/s on.
                let friction = VISCOUS * self.rate + COULOMB * (self.rate / 0.3).clamp(-1.0, 1.0);
                self.rate += (motor + pull - friction) / INERTIA * period;
                self.angle += self.rate * period;
            }
        }
        self.hand = to;
    }

    /// Angle of the dial and of its springs and stops, rad; rate, rad/s; the feel's torque, N·m; detent; end; phase;
    /// fault; maximum change of torque in the last run, N·m.
    pub fn view(&self, out: &mut Vec<f32>) {
        let dial = KNOB.dial(self.state.witness(), self.state.angles()[0], self.state.phase());
        let whole = self.state.witness().angle().unwrap_or(self.angle);
        let fault = self.state.fault().map_or(0, |(fault, _)| fault.code());
        out.extend([self.angle, whole, self.rate, dial.torque_n_m]);
        out.extend([dial.detent as f32, f32::from(dial.end)]);
        out.extend([f32::from(self.state.phase() as u8), f32::from(fault), self.step]);
    }

    /// The torque of the feel at rest, N·m, at evenly spaced angles of a turn around an angle, radians.
    pub fn curve(&self, middle: f32, count: u32, out: &mut Vec<f32>) {
        let feel = self.state.witness().own().copied().unwrap_or(Feel::FREE);
        let at = |index: u32| middle + TAU * (index as f32 / count as f32 - 0.5);
        // Clicks find the nearest detent from anywhere.
        let mut click = 0;
        out.extend((0..=count).map(|index| feel.torque(&mut click, at(index), 0.0)));
    }
}
