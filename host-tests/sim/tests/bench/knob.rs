//! The knob on the shared loop: its pins, its stage, its panel.

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin, OutputPin};
use embedded_hal::pwm::{ErrorType as WidthErrorType, SetDutyCycle};
use palpate::commission::Wiring;
use palpate::device::drive::ThreePhase;
use palpate::device::sensor::Frozen;
use palpate::device::{Counts, Device, Dial};
use palpate::servo::{Fault, Guarded, Knob, Phase, ResetReason};
use palpate::wire::Record;
use palpate::wire::telemetry::{Consumer, Queue};
use palpate_bench::sensors::{BadFrame, Sensors};
use palpate_bench::{
    Bench, Counter, CurrentFault, CurrentWatched, Felt, Lines, Mailbox, OneChannel, Parts, PhaseCurrents, Settings,
    Supply, Timer,
};
use palpate_sim::knob::{CURRENTS, JOG, KnobServo, MODULATION, PROTECTION, SEARCH, SETTINGS, SUPPLY, device, servo};
use palpate_sim::plant::{DialSettings, Fingers, MagneticFault};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

const CLOCK: u32 = 170_000_000;
const STEPS: u16 = 6_800;

static DEVICE: Device<Dial, 1> = device(None);
static SERVO: KnobServo = servo(&DEVICE, SEARCH, PROTECTION);

pub struct This;

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Guarded<1>;

    fn servo(&self) -> &KnobServo {
        &SERVO
    }

    fn wiring(&self) -> Wiring<1> {
        Wiring::STRAIGHT
    }
}

/// What the pins are wired to.
pub struct World {
    pub dial: palpate_sim::plant::Dial,
    pub button: bool,
    stop_open: bool,
    ready: [bool; 2],
    volts: f32,
    are_currents_measured: bool,
    widths: [u16; 3],
    pub enabled: bool,
    cycles: u32,
    reading: u32,
}

pub type Shared = Rc<RefCell<World>>;

pub struct In(Shared, fn(&World) -> bool);

impl PinErrorType for In {
    type Error = Infallible;
}

impl InputPin for In {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok((self.1)(&self.0.borrow()))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

pub struct Enable(Shared);

impl PinErrorType for Enable {
    type Error = Infallible;
}

impl OutputPin for Enable {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().enabled = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().enabled = true;
        Ok(())
    }
}

pub struct Width(Shared, usize);

impl WidthErrorType for Width {
    type Error = Infallible;
}

impl SetDutyCycle for Width {
    fn max_duty_cycle(&self) -> u16 {
        STEPS
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.borrow_mut().widths[self.1] = duty;
        Ok(())
    }
}

pub struct Clock(Shared);

impl Counter for Clock {
    fn now(&self) -> u32 {
        let mut world = self.0.borrow_mut();
        world.cycles = world.cycles.wrapping_add(40);
        world.cycles
    }
}

impl Timer for Clock {
    fn acknowledge(&mut self) {}
}

impl Supply for Clock {
    fn volts(&mut self) -> Option<f32> {
        Some(self.0.borrow().volts)
    }
}

/// The sensor behind the dial, watched as the boards' driver watches it.
pub struct Behind(Shared, Frozen);

impl Sensors<1> for Behind {
    fn read(&mut self) -> Result<[Counts; 1], BadFrame> {
        let mut world = self.0.borrow_mut();
        world.cycles = world.cycles.wrapping_add(world.reading);
        let counts = world.dial.counts().ok_or(BadFrame::Absent)?;
        if world.dial.has_lost_magnet() {
            return Err(BadFrame::Magnet);
        }
        if self.1.is_frozen(counts as u32) { Err(BadFrame::Frozen) } else { Ok([Counts(counts)]) }
    }
}

/// The measurement of the phases' currents.
pub struct Amps(Shared);

impl PhaseCurrents for Amps {
    fn amps(&mut self) -> Option<[f32; 3]> {
        let world = self.0.borrow();
        world.are_currents_measured.then(|| world.dial.currents().map(|current| current as f32))
    }
}

pub type Stage = ThreePhase<Width, Width, Width, Enable>;
pub type Board = Parts<
    Clock,
    Clock,
    Behind,
    CurrentWatched<[Stage; 1], Amps>,
    OneChannel<In>,
    In,
    In,
    Clock,
    palpate::device::drive::NoPin,
    2,
>;

pub struct Rig {
    pub world: Shared,
    pub bench: Bench<'static, This, Board, 1>,
    pub mailbox: &'static Mailbox,
    records: Option<Consumer<'static, Record>>,
}

impl Rig {
    pub fn new(reset: ResetReason) -> Self {
        Self::with(DialSettings::gimbal_knob(), reset)
    }

    /// Of this dial.
    pub fn with(dial: DialSettings, reset: ResetReason) -> Self {
        let world = World {
            dial: palpate_sim::plant::Dial::new(dial, f64::from(SETTINGS.rate_hz)),
            button: false,
            stop_open: false,
            ready: [true; 2],
            volts: 12.0,
            are_currents_measured: true,
            widths: [0; 3],
            enabled: false,
            cycles: 0,
            reading: 200,
        };
        let world = Rc::new(RefCell::new(world));
        let of = || Rc::clone(&world);
        let widths = (Width(of(), 0), Width(of(), 1), Width(of(), 2));
        let board = Parts {
            counter: Clock(of()),
            timer: Clock(of()),
            sensors: Behind(of(), Frozen::AS5047P),
            drives: CurrentWatched::new([ThreePhase::new(widths, Enable(of()), MODULATION)], Amps(of()), CURRENTS),
            lines: Lines {
                enable: OneChannel { pin: In(of(), |world| world.button), pressed_level: true },
                stop: In(of(), |world| world.stop_open),
                ready: [In(of(), |world| world.ready[0]), In(of(), |world| world.ready[1])],
                supply: Clock(of()),
            },
            light: palpate::device::drive::NoPin,
        };
        let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
        let queue: &'static mut Queue<Record, 64> = Box::leak(Box::new(Queue::new()));
        let (producer, records) = queue.split();
        let settings = Settings { supply: Some(SUPPLY), jog: Some(JOG), ..Settings::new(CLOCK) };
        let bench = Bench::new(This, board, &settings, reset, producer, mailbox);
        Self { world, bench, mailbox, records: Some(records) }
    }

    pub fn tick(&mut self) {
        self.bench.tick();
        let mut world = self.world.borrow_mut();
        let widths = world.enabled.then(|| world.widths.map(|width| f64::from(width) / f64::from(STEPS)));
        world.dial.advance(widths);
        world.cycles = world.cycles.wrapping_add(CLOCK / SETTINGS.rate_hz as u32);
    }

    pub fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick());
    }

    pub fn set(&self, change: impl FnOnce(&mut World)) {
        change(&mut self.world.borrow_mut());
    }

    pub fn enabled(&self) -> bool {
        self.world.borrow().enabled
    }

    pub fn fault(&self) -> Option<Fault> {
        self.bench.state().fault().map(|(fault, _)| fault)
    }

    /// Main's end of the queue, once.
    pub fn take_records(&mut self) -> Consumer<'static, Record> {
        self.records.take().expect("asked once")
    }

    /// Presses the button that was released.
    pub fn press(&mut self) {
        self.set(|world| world.button = false);
        self.ticks(250);
        self.set(|world| world.button = true);
    }

    /// Halfway through the alignment.
    pub fn aligning() -> Self {
        Self::new(ResetReason::PowerOn).align()
    }

    fn align(self) -> Self {
        let mut rig = self;
        rig.press();
        rig.ticks(SEARCH.ticks() / 2);
        assert!(rig.enabled() && rig.bench.state().phase() == Phase::Calibrate);
        rig
    }

    pub fn running() -> Self {
        Self::aligning().run()
    }

    pub fn running_with(dial: DialSettings) -> Self {
        Self::with(dial, ResetReason::PowerOn).align().run()
    }

    /// Running, with a sensor so quiet that what is felt of a feel is hardly its noise.
    pub fn running_quietly() -> Self {
        let mut dial = DialSettings::gimbal_knob();
        dial.sensor.noise /= 8.0;
        Self::running_with(dial)
    }

    fn run(self) -> Self {
        let mut rig = self;
        rig.ticks(SEARCH.ticks());
        assert_eq!((rig.bench.state().homed(), rig.enabled()), (true, false), "that press asked for the alignment");
        rig.press();
        rig.ticks(1_200);
        assert_eq!((rig.bench.state().phase(), rig.fault()), (Phase::Running, None));
        assert!(rig.enabled());
        rig
    }
}

#[test]
fn a_button_that_is_held_at_reset_moves_nothing_and_one_press_aligns_and_the_next_is_felt() {
    let mut rig = Rig::new(ResetReason::PowerOn);
    rig.set(|world| world.button = true);
    for _ in 0..4_000 {
        rig.tick();
        assert!(!rig.enabled());
    }
    let mut rig = Rig::running();
    assert_eq!(rig.bench.state().witness().feel(), 0);
    rig.mailbox.choose(3);
    rig.tick();
    assert_eq!((rig.bench.state().witness().feel(), rig.enabled()), (3, true));
}

/// What is done to the world, and whether the stage must be off after so many ticks.
pub type Harm = (&'static str, fn(&mut World), u32);

/// A supply is believed to be gone by its fourth reading, a frame by the third that is missing.
pub const HARMS: [Harm; 9] = [
    ("button let go of", |world| world.button = false, 1),
    ("stop, or its wire", |world| world.stop_open = true, 1),
    ("fault line, or its wire", |world| world.ready[0] = false, 1),
    ("reset line, or its wire", |world| world.ready[1] = false, 1),
    ("supply dips", |world| world.volts = 8.0, 4),
    ("sensor absent", |world| world.dial.spoil(Some(MagneticFault::Absent)), 3),
    ("magnet gone", |world| world.dial.spoil(Some(MagneticFault::Magnet)), 3),
    ("sensor frozen", |world| world.dial.spoil(Some(MagneticFault::Stuck)), 1_003),
    ("late tick", |world| world.reading = CLOCK / 3_000, 5),
];

#[test]
fn whatever_breaks_while_it_is_aligned_and_while_it_is_felt_disables_the_stage() {
    for (when, make) in [("aligning", Rig::aligning as fn() -> Rig), ("running", Rig::running)] {
        for (what, harm, within) in HARMS {
            let mut rig = make();
            rig.set(harm);
            rig.ticks(within);
            assert!(!rig.enabled(), "{what}, {when}");
            assert_eq!(rig.world.borrow().widths, [0; 3], "{what}, {when}");
            for _ in 0..400 {
                rig.tick();
                assert!(!rig.enabled() && rig.world.borrow().dial.currents() == [0.0; 3], "{what}, {when}");
            }
        }
    }
}

#[test]
fn the_measured_supply_scales_what_the_stage_gives() {
    // The spring, turned away from its rest and held there. Nothing but the reading changes.
    let mut rig = Rig::running_quietly();
    rig.mailbox.choose(3);
    rig.set(|world| world.dial.hold(Fingers { damping: 0.05, rate: 2.0, ..Fingers::NONE }));
    rig.ticks(1_000);
    rig.set(|world| world.dial.hold(Fingers::clamp(world.dial.angle())));
    let [at_12, at_13_8, at_10_2] = [12.0_f32, 13.8, 10.2].map(|volts| {
        rig.set(|world| world.volts = volts);
        rig.ticks(200);
        let mut swing = 0_u32;
        for _ in 0..200 {
            rig.tick();
            let widths = rig.world.borrow().widths;
            swing += u32::from(widths.iter().max().unwrap() - widths.iter().min().unwrap());
        }
        assert!(rig.enabled() && swing > 2_000, "{:?} {swing}", rig.fault());
        f64::from(swing)
    });
    for (volts, swing) in [(13.8, at_13_8), (10.2, at_10_2)] {
        let ratio = swing / at_12 * volts / 12.0;
        println!("{volts} V: {ratio}");
        // By the constant it would be off by 15 %. The dead time that is made up for is no share of the supply.
        assert!((ratio - 1.0).abs() < 0.05, "{volts} V: {ratio}");
    }
}

#[test]
fn a_short_an_open_phase_and_a_lost_measurement_of_the_currents_stop_the_motor() {
    for (when, make) in [("aligning", Rig::aligning as fn() -> Rig), ("running", Rig::running)] {
        // A hand that turns the dial against the spring, so that each phase is needed.
        let turned = || {
            let mut rig = make();
            if when == "running" {
                rig.mailbox.choose(3);
                rig.set(|world| world.dial.hold(Fingers { damping: 0.05, rate: 2.0, ..Fingers::NONE }));
                rig.ticks(1_000);
            }
            rig
        };
        let mut sound = turned();
        sound.ticks(2_000);
        assert_eq!(sound.bench.board().drives.fault(), None, "{when}");
        type Harm = (&'static str, fn(&mut World), CurrentFault, u32);
        let harms: [Harm; 5] = [
            // Ohm's law on 2 V or less: more than 1.2 A within L/R, and two readings of it.
            ("short", |world| world.dial.short(0.3), CurrentFault::Over, 2_000),
            ("phase 1 open", |world| world.dial.lose(Some(0)), CurrentFault::Open, 2_000),
            ("phase 2 open", |world| world.dial.lose(Some(1)), CurrentFault::Open, 2_000),
            ("phase 3 open", |world| world.dial.lose(Some(2)), CurrentFault::Open, 2_000),
            ("not measured", |world| world.are_currents_measured = false, CurrentFault::Unmeasured, 2),
        ];
        for (what, harm, fault, within) in harms {
            let mut rig = turned();
            rig.set(harm);
            let found = (1..=within).find(|_| {
                rig.tick();
                rig.bench.board().drives.fault().is_some()
            });
            println!("{what}, {when}: {found:?}");
            assert_eq!(rig.bench.board().drives.fault(), Some(fault), "{what}, {when}");
            assert_eq!((rig.fault(), rig.enabled()), (Some(Fault::Drive), false), "{what}, {when}");
        }
    }
}
