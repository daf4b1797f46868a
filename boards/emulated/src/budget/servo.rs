//! The whole servo tick of a device with three joints.

use core::hint::black_box;

use palpate::device::{Counts, Kinematics};
use palpate::math::Vec3;
use palpate::servo::{Event, Input, Tracked};
use palpate::track::Contact;

use super::closest::probe;
use super::tally::Tally;
use crate::body::{DEVICE, SERVO, SETTINGS, State};
use crate::timer::InstructionCounter;

/// Ticks of the path.
const TICKS: u32 = 100_000;
/// Newton steps to the start of the path.
pub(super) const APPROACH: u32 = 20;

/// The name of the figures.
const NAME: &str = if cfg!(feature = "soft-eight") {
    "servo tick, a soft body of 8 modes"
} else if cfg!(feature = "soft-four") {
    "servo tick, a soft body of 4 modes"
} else if cfg!(feature = "soft") {
    "servo tick, a soft body of 1 mode"
} else if cfg!(feature = "folded") {
    "servo tick, folded back"
} else if cfg!(feature = "protected") {
    "servo tick, protected"
} else if cfg!(feature = "smooth") {
    "servo tick, smooth"
} else {
    "servo tick"
};

#[inline(never)]
fn tick(state: &mut State, input: Input<3>) {
    let _ = SERVO.tick(state, input);
}

/// The joints of a device that follows a path exactly.
pub(super) struct Walk {
    angles: [f32; 3],
}

impl Walk {
    /// At the encoders' zero.
    pub(super) fn start() -> Self {
        Self { angles: DEVICE.encoders.map(|encoder| encoder.angle_at_zero_rad) }
    }

    /// One step of Newton's method a tick, from the last tick's angles: the path moves a tenth of a millimetre in
    /// between.
    pub(super) fn counts(&mut self, position: Vec3) -> [Counts; 3] {
        let Some(pose) = DEVICE.kinematics.pose(self.angles) else { panic!("the path leaves the workspace") };
        let [a, b, c] = pose.jacobian;
        let missing = position - pose.position;
        // Cramer's rule.
        let scale = 1.0 / a.dot(b.cross(c));
        let change = [missing.dot(b.cross(c)), a.dot(missing.cross(c)), a.dot(b.cross(missing))];
        let mut counts = [Counts(0); 3];
        for (((count, angle), change), encoder) in
            counts.iter_mut().zip(&mut self.angles).zip(change).zip(&DEVICE.encoders)
        {
            *angle += scale * change;
            *count = Counts(((*angle - encoder.angle_at_zero_rad) / encoder.radians_per_count) as i32);
        }
        counts
    }
}

/// How far polarity pulses have turned the joints of a device that otherwise follows its path, rad.
#[cfg(feature = "folded")]
struct GivesWay([f32; 3]);

#[cfg(feature = "folded")]
impl GivesWay {
    /// A polarity pulse lasts 31 ticks, in which a joint alone comes 0.4 mm at the probe, two milliradians. There is
    /// no pulse, and no joint gives way, once all joints were seen.
    fn counts(&mut self, state: &State, mut counts: [Counts; 3]) -> [Counts; 3] {
        let is_on_trial = state.guard().joints_seen() != [true; 3];
        for joint in 0..3 {
            let push = f32::from(state.duties()[joint].0.signum()) * DEVICE.motors[joint].torque_at_full_n_m.signum();
            self.0[joint] += if is_on_trial { 6.5e-5 * push } else { 0.0 };
            counts[joint].0 += (self.0[joint] / DEVICE.encoders[joint].radians_per_count) as i32;
        }
        counts
    }
}

pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let mut state = SERVO.start();
    let mut walk = Walk::start();
    for _ in 0..APPROACH {
        walk.counts(probe(0) + SETTINGS.body_origin_m);
    }
    let mut ticks = Tally::new();
    let mut touching = Tally::new();
    #[cfg(feature = "folded")]
    let mut gives_way = GivesWay([0.0; 3]);
    let (mut touched, mut met) = (0, [0_u32; 3]);
    for index in 0..TICKS {
        let position = probe(index) + SETTINGS.body_origin_m;
        let counts = walk.counts(position);
        #[cfg(feature = "folded")]
        let counts = gives_way.counts(&state, counts);
        let input = black_box(Input::Sensors { counts, enable: true });
        // As the loop does with each frame: a host that is silent is a fault.
        SERVO.note(&mut state, Event::LinkAlive);
        #[cfg(feature = "protected")]
        SERVO.note(&mut state, Event::Supply { millivolts: 24_000 });
        let ((), instructions) = counter.count(|| tick(&mut state, input));
        ticks.add(instructions);
        touched += u32::from(state.contact() == Contact::Touching);
        if cfg!(feature = "soft") && state.contact() == Contact::Touching {
            touching.add(instructions);
        }
        let feature = state.witness().feature();
        met[usize::from(feature >> 14)] |= 1 << (feature & 31);
    }
    ticks.print(NAME);
    if cfg!(feature = "soft") {
        touching.print_as(NAME, "touched");
    }
    if state.fault().is_some() {
        return Err("the servo found a fault on its path");
    }
    #[cfg(feature = "folded")]
    if state.guard().joints_seen() != [true; 3] {
        return Err("the servo has not seen all joints follow their motors");
    }
    if touched < TICKS / 100 {
        return Err("the servo's path hardly touches the surface");
    }
    if cfg!(not(feature = "around")) && met.map(u32::count_ones) != [6, 12, 8] {
        return Err("the servo's path misses a feature");
    }
    Ok(())
}
