//! A long seeded run of the servo that visits everything it can do: every boundary mode, phase and fault, contact in
//! and out, every rendering and mechanism. The same code runs on a board and on the host, and what it prints must be
//! the same.

pub mod laps;
pub mod random;
pub mod script;
pub mod tally;

use palpate::device::Encoder;
use palpate::device::Kinematics;
use palpate::device::presets::{NOVINT_FALCON, POLHEM_V2, WOODEN_HAPTICS_2016};
use palpate::servo::{Guard, Surface};

use laps::{FALCON_REACH, POLHEM_REACH, ServoOf, WOODEN_HAPTICS_REACH};
use script::Script;
use tally::Tally;

/// Ticks of the whole run.
pub const TICKS: u32 = 1_000_000;
/// Ticks of [`run_soft`].
pub const SOFT_TICKS: u32 = 100_000;
/// Ticks from one line to the next.
pub const TICKS_PER_LINE: u32 = 50_000;

/// Runs the ticks, and receives their tally.
pub trait Runner {
    /// Runs a tick, which `work` is: once.
    fn tick(&mut self, work: impl FnOnce());

    /// The tally of a lap so far, and whether that is all of it.
    fn line(&mut self, lap: &'static str, tally: &Tally, is_last: bool);
}

/// A runner that only receives tallies.
struct Listener<F>(F);

impl<F: FnMut(&str, &Tally)> Runner for Listener<F> {
    fn tick(&mut self, work: impl FnOnce()) {
        work();
    }

    fn line(&mut self, lap: &'static str, tally: &Tally, _: bool) {
        (self.0)(lap, tally);
    }
}

/// Runs every servo in turn, [`TICKS`] in all, and gives the tally of a lap so far every [`TICKS_PER_LINE`] ticks.
pub fn run(say: &mut impl FnMut(&str, &Tally)) {
    run_by(&mut Listener(say), u32::MAX);
}

/// The same with a runner, and at most `most` ticks of each lap: the tally is given at its end too.
pub fn run_by(runner: &mut impl Runner, most: u32) {
    let serial = &WOODEN_HAPTICS_2016.encoders;
    let mut laps = Laps { runner, most };
    laps.lap("plain", &laps::PLAIN, serial, WOODEN_HAPTICS_REACH, 150_000);
    laps.lap("body", &laps::BODY, serial, WOODEN_HAPTICS_REACH, 300_000);
    laps.lap("rich", &laps::RICH, serial, WOODEN_HAPTICS_REACH, 100_000);
    laps.lap("coupled", &laps::COUPLED, &NOVINT_FALCON.encoders, FALCON_REACH, 50_000);
    laps.lap("short", &laps::SHORT, &NOVINT_FALCON.encoders, FALCON_REACH, 50_000);
    laps.lap("watchful", &laps::WATCHFUL, &POLHEM_V2.encoders, POLHEM_REACH, 200_000);
    laps.lap("guarded", &laps::GUARDED, serial, WOODEN_HAPTICS_REACH, 50_000);
    laps.lap("broken", &laps::BROKEN, serial, WOODEN_HAPTICS_REACH, 50_000);
    laps.lap("corrupt", &laps::CORRUPT, serial, WOODEN_HAPTICS_REACH, 50_000);
}

/// Runs a soft body, which the boards' images do not hold: [`SOFT_TICKS`], with their tally as of [`run`].
pub fn run_soft(say: &mut impl FnMut(&str, &Tally)) {
    let mut laps = Laps { runner: &mut Listener(say), most: u32::MAX };
    laps.lap("soft", &laps::SOFT, &WOODEN_HAPTICS_2016.encoders, WOODEN_HAPTICS_REACH, SOFT_TICKS);
}

struct Laps<'a, R> {
    runner: &'a mut R,
    most: u32,
}

impl<R: Runner> Laps<'_, R> {
    fn lap<K: Kinematics<3>, S: Surface, G: Guard<3>>(
        &mut self,
        name: &'static str,
        servo: &ServoOf<K, S, G>,
        encoders: &[Encoder; 3],
        reach: [[f32; 2]; 3],
        ticks: u32,
    ) {
        let ticks = ticks.min(self.most);
        let mut script = Script::new(1, encoders, reach);
        let mut state = servo.start();
        let mut tally = Tally::default();
        while tally.ticks < ticks {
            let order = script.next_order();
            if let Some(reset) = order.restart {
                state = servo.start_after(reset);
            }
            for event in order.events.into_iter().flatten() {
                servo.note(&mut state, event);
            }
            let before = state.contact();
            self.runner.tick(|| {
                let _ = servo.tick(&mut state, order.input);
            });
            tally.add(before, &state);
            let is_last = tally.ticks == ticks;
            if is_last || tally.ticks.is_multiple_of(TICKS_PER_LINE) {
                self.runner.line(name, &tally, is_last);
            }
        }
    }
}
