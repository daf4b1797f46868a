//! A board that is being accepted: it drives nothing, and says what it is asked.

use palpate::commission::Wiring;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Homing, Reference, SerialArm};
use palpate::patch::SplinePatch;
use palpate::servo::{Config, Output, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate::wire::acceptance::{Counted, Failure, Line, Ticks};
use palpate::wire::telemetry::Queue;
use palpate_bench::accept::{Acceptance, Chip, Examiner, Stopwatch};
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Mailbox, OptionBytes, Port, Watchdog};
use palpate_sim::rig::{
    CLOCK, Made, RATE, SETTINGS, STOPS, Shared, SimulatedBoard, WALL, World, held_at, settings, wired,
};
use palpate_tool::accept::{self, Check, Found, Plan, Report, Surroundings, Verdict, examine, expected, judge};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::time::Duration;

type Arm = Servo<'static, SplinePatch<'static>, SerialArm, 3>;
type Tick = Acceptance<'static, Made<SerialArm>, SimulatedBoard, 3>;

fn arm() -> Arm {
    Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT })
}

/// A stopwatch by which each tick takes as long.
struct Even;

/// What a tick of the script takes by it.
const EVEN: u32 = 1_500;

impl Stopwatch for Even {
    const COUNTED: Counted = Counted::Cycles;

    fn measure(&mut self, work: impl FnOnce()) -> u32 {
        work();
        EVEN
    }
}

/// A board that is being accepted, pressed into a wall, at the other end of a line.
struct Device {
    world: Shared,
    tick: Tick,
    examiner: Examiner<'static, Even>,
    wire: Wire,
    fed: Fed,
    /// What happens in a tick.
    events: fn(&mut World, u32),
    ticks: u32,
    /// The reset reason that a failure leads to.
    resets_to: fn(Failure) -> ResetReason,
    /// Its line is the plug of a chip that a reset drops.
    plug: Plug,
}

/// What becomes of a device's line at a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Plug {
    /// A wire, which does not notice.
    Wire,
    /// A plug that is in.
    In,
    /// One that has gone, and is not found the next so many times.
    Gone(u32),
    /// One that goes for good with the next reset.
    Breaks,
    /// One that never comes back.
    Lost,
}

#[derive(Default)]
struct Wire {
    to: VecDeque<u8>,
    from: VecDeque<u8>,
}

impl Port for Wire {
    fn send(&mut self, byte: u8) -> bool {
        self.from.push_back(byte);
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.to.pop_front()
    }
}

#[derive(Default)]
struct Fed(u32);

impl Watchdog for Fed {
    fn feed(&mut self) {
        self.0 += 1;
    }
}

fn start(servo: fn() -> Arm, reset: ResetReason) -> (Shared, Tick, Examiner<'static, Even>) {
    let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
    let queue: &'static mut Queue<Ticks, 16> = Box::leak(Box::new(Queue::new()));
    let (producer, ticks) = queue.split();
    let (world, board) = wired(&servo(), held_at([0.0, 0.0, -0.004]), &settings());
    let felt = Made(servo(), false, Wiring::STRAIGHT);
    let chip = Chip { core: 0x410f_c241, reset, options: OptionBytes::DELIVERED };
    let examiner = Examiner::new(&felt, &settings(), chip, mailbox, ticks, Even);
    (world, Acceptance::new(felt, board, &settings(), reset, producer, mailbox), examiner)
}

impl Device {
    fn new(events: fn(&mut World, u32), resets_to: fn(Failure) -> ResetReason) -> Self {
        let (world, tick, examiner) = start(arm, ResetReason::PowerOn);
        let (wire, fed, plug) = (Wire::default(), Fed::default(), Plug::Wire);
        Self { world, tick, examiner, wire, fed, events, ticks: 0, resets_to, plug }
    }

    /// A period of it: a tick, and what main does below.
    fn period(&mut self) {
        (self.events)(&mut self.world.borrow_mut(), self.ticks);
        // To the cycle.
        self.world.borrow_mut().cycles = self.ticks.wrapping_mul(CLOCK / RATE as u32);
        self.ticks += 1;
        self.tick.tick();
        assert_eq!(self.world.borrow().enables, [false; 3]);
        self.world.borrow_mut().advance();
        for _ in 0..20 {
            if let Some(failure) = self.examiner.step(&mut self.wire, &mut self.fed) {
                (self.world, self.tick, self.examiner) = start(arm, (self.resets_to)(failure));
                self.wire.to.clear();
                self.plug = match self.plug {
                    // Not found at once: the chip starts first.
                    Plug::In => Plug::Gone(3),
                    Plug::Breaks => Plug::Lost,
                    other => other,
                };
            }
        }
    }
}

impl Read for Device {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        for _ in 0..2_000 {
            if matches!(self.plug, Plug::Gone(_) | Plug::Lost) {
                return Err(io::ErrorKind::BrokenPipe.into());
            }
            self.period();
            if !self.wire.from.is_empty() {
                return self.wire.from.read(buffer);
            }
        }
        Err(io::ErrorKind::TimedOut.into())
    }
}

impl Write for Device {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if matches!(self.plug, Plug::Gone(_) | Plug::Lost) {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        self.wire.to.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A plug that was pulled out comes back after a while, or never.
impl accept::DeviceLine for Device {
    fn reopen(&mut self) -> io::Result<()> {
        self.plug = match self.plug {
            Plug::Gone(0) => Plug::In,
            Plug::Gone(more) => Plug::Gone(more - 1),
            other => other,
        };
        if matches!(self.plug, Plug::Wire | Plug::In) { Ok(()) } else { Err(io::ErrorKind::NotFound.into()) }
    }
}

const MOST: u32 = 300;
/// A device that does not come back is not waited for longer.
const GREETING: Duration = Duration::from_secs(2);

fn known(failure: Failure) -> ResetReason {
    match failure {
        Failure::Hang => ResetReason::Watchdog,
        Failure::Panic => ResetReason::Panic,
        Failure::Exception => ResetReason::Exception,
    }
}

fn found(device: &mut Device, failures: &[Failure]) -> Found {
    let plan = Plan { most: MOST, seconds: 5.0, failures: failures.to_vec(), greeting: GREETING };
    let mut found = examine(device, &plan).unwrap();
    // The simulated device's time is not the host's, which is taken for it here.
    found.seconds = 5.0;
    found
}

/// What an emulator counts: so many instructions a tick.
fn counted(found: &Found, longest: u32) -> Vec<Line> {
    found.lines.iter().map(|line| Line { longest, ..*line }).collect()
}

fn failed(found: &Found, instructions: u32) -> Vec<&'static str> {
    let counted = counted(found, instructions);
    let around = Surroundings { counted: Some(&counted), ..Surroundings::default() };
    let checks = judge(found, &expected(MOST), &around);
    checks.iter().filter(|check| check.verdict == Verdict::Failed).map(|Check { name, .. }| *name).collect()
}

#[test]
fn nothing_is_driven_whatever_is_pressed_and_whatever_the_servo_asks_for() {
    /// Homing that searches for its stops by the motors.
    fn searches() -> Arm {
        let homing = Homing::new(WOODEN_HAPTICS_2016.encoders, Reference::Stops(STOPS), 400, 4, 60_000);
        arm().with_homing(homing)
    }
    fn damps() -> Arm {
        let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
        Servo::new(arm().device(), arm().surface(), Config { safety, ..arm().config() })
    }
    for servo in [arm, searches, damps] {
        let (world, mut tick, _) = start(servo, ResetReason::PowerOn);
        let (mut asked, mut random) = (0, palpate_bench::exercise::random::Random::new(7));
        for _ in 0..20_000 {
            {
                let mut world = world.borrow_mut();
                if random.below(200) == 0 {
                    world.button = random.below(3) > 0;
                }
                world.stop_open = random.below(500) == 0;
                world.bad += u32::from(random.below(5_000) == 0) * 3;
            }
            tick.tick();
            asked += u32::from(matches!(tick.state().output(), Output::Drive(_)));
            assert_eq!(world.borrow().enables, [false; 3]);
            world.borrow_mut().advance();
        }
        assert!(asked > 100, "the servo asked for its motors in {asked} ticks only");
    }
}

#[test]
fn a_good_board_is_accepted_by_its_cycles_too() {
    let mut device = Device::new(|_, _| (), known);
    let found = found(&mut device, &[Failure::Hang, Failure::Panic, Failure::Exception]);
    assert_eq!(failed(&found, 1_000), Vec::<&str>::new());
    assert!((found.identity.clock, found.ticks.len()) == (CLOCK, 51), "{}", found.ticks.len());
    // Every eighth tick (`palpate_bench::heartbeat`).
    assert!(device.fed.0 > 20_000 / 8, "fed {} times", device.fed.0);
    // A counter that does not count, and a core that waits for its memory.
    assert_eq!(failed(&found, EVEN + 1), ["longest tick of the script"]);
    assert_eq!(failed(&found, EVEN / 2 - 1), ["longest tick of the script"]);
    let slow = Found { seconds: 5.2, ..found.clone() };
    assert_eq!(failed(&slow, 1_000), Vec::<&str>::new(), "a tenth of a second for the frame, 2 % for the clock");
    assert_eq!(failed(&Found { seconds: 5.25, ..found.clone() }, 1_000), ["clock"]);
    let mut other = found.clone();
    other.lines[2].digest ^= 1;
    assert_eq!(failed(&other, 1_000), ["state hash", "script"]);
    let mut frozen = found.clone();
    frozen.identity.options &= !(1 << 17);
    assert_eq!(failed(&frozen, 1_000), ["option bytes"], "IWDG_STOP: the watchdog stands still in Stop mode");
    let mut short = found;
    short.lines.pop();
    assert_eq!(failed(&short, 1_000), ["state hash", "script"]);
}

#[test]
fn a_board_whose_plug_a_reset_drops_is_reached_again() {
    let mut device = Device { plug: Plug::In, ..Device::new(|_, _| (), known) };
    let found = found(&mut device, &[Failure::Hang, Failure::Panic, Failure::Exception]);
    assert_eq!(failed(&found, 1_000), Vec::<&str>::new());
    assert_eq!(found.failures.len(), 3);
}

#[test]
fn what_was_found_before_a_line_broke_for_good_is_reported_and_not_accepted() {
    let mut device = Device { plug: Plug::Lost, ..Device::new(|_, _| (), known) };
    let plan = Plan { most: MOST, seconds: 1.0, failures: vec![Failure::Hang], greeting: GREETING };
    assert!(examine(&mut device, &plan).is_err(), "a device that never said who it is");

    let mut device = Device { plug: Plug::Breaks, ..Device::new(|_, _| (), known) };
    let found = found(&mut device, &[Failure::Hang]);
    assert_eq!((failed(&found, 1_000), found.failures.len()), (vec!["to the end"], 0));
    let (expected, around) = (expected(MOST), Surroundings::default());
    let report = Report::new("a port", &found, &expected, &around, judge(&found, &expected, &around)).to_string();
    assert!(report.contains("| passed | state hash |"), "{report}");
    assert!(report.contains("| FAILED | to the end | after the provoked failure Hang: "), "{report}");
}

#[test]
fn a_reset_whose_reason_the_board_does_not_know_is_not_accepted() {
    let mut device = Device::new(|_, _| (), |_| ResetReason::PowerOn);
    let found = found(&mut device, &[Failure::Hang, Failure::Panic, Failure::Exception]);
    assert_eq!(failed(&found, 1_000), ["reset after a hang", "reset after a panic", "reset after an exception"]);
    let mut hung = found;
    hung.failures.clear();
    hung.identity.reset = ResetReason::Watchdog as u8;
    assert_eq!(failed(&hung, 1_000), ["reset reason"]);
}

#[test]
fn bad_frames_of_the_sensors_are_counted_by_their_kind() {
    // One in 3,000 ticks, damaged: too many. Then none, but once three in a row.
    let often = |world: &mut World, tick: u32| world.bad += u32::from(tick % 3_000 == 2_999);
    let found_often = found(&mut Device::new(often, known), &[]);
    assert_eq!(failed(&found_often, 1_000), ["sensors"]);
    let last = found_often.ticks.last().unwrap();
    assert!(last.bad[1] >= 2 && (last.bad[0], last.bad[2], last.in_a_row) == (0, 0, 1), "{last:?}");

    let thrice = |world: &mut World, tick: u32| {
        if tick == 10 {
            (world.bad, world.kind) = (3, BadFrame::Absent);
        }
    };
    let found_thrice = found(&mut Device::new(thrice, known), &[]);
    assert_eq!(failed(&found_thrice, 1_000), ["sensors"]);
    assert_eq!(found_thrice.ticks.last().unwrap().bad, [3, 0, 0, 0, 0]);
    // A magnet that falls off while the joints are turned.
    let loose = |world: &mut World, tick: u32| {
        if tick > 10_000 {
            (world.bad, world.kind) = (1, BadFrame::Magnet);
        }
    };
    let found_loose = found(&mut Device::new(loose, known), &[]);
    assert_eq!(failed(&found_loose, 1_000), ["sensors"]);
    let [others @ .., magnet, 0] = found_loose.ticks.last().unwrap().bad else { panic!("none is frozen") };
    assert!(others == [0; 3] && magnet > 1_000, "{magnet}");
    // The same on a board without sensors is told.
    let counted = counted(&found_thrice, 1_000);
    let around = Surroundings { counted: Some(&counted), bare: true, ..Surroundings::default() };
    let checks = judge(&found_thrice, &expected(MOST), &around);
    assert!(checks.iter().all(|check| check.verdict != Verdict::Failed), "{checks:?}");
}

#[test]
fn a_tick_that_takes_too_long_is_not_accepted() {
    let slow = |world: &mut World, tick: u32| world.reading = if tick == 12_000 { 50_000 } else { 200 };
    let found = found(&mut Device::new(slow, known), &[]);
    let failed = failed(&found, 1_000);
    assert!(failed.contains(&"own tick") && failed.contains(&"overruns"), "{failed:?}");
}

#[test]
fn a_board_reset_by_its_watchdog_is_examined_all_the_same() {
    let (world, mut tick, _) = start(arm, ResetReason::Watchdog);
    world.borrow_mut().button = true;
    (0..1_000).for_each(|_| {
        tick.tick();
        assert_eq!(world.borrow().enables, [false; 3]);
        world.borrow_mut().advance();
    });
    assert_eq!((tick.state().phase(), tick.state().fault()), (Phase::Running, None));
}
