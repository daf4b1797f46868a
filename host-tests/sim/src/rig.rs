//! A simulated bench: the device in a hand, amplifiers that read their pins, a panel with wires that may break.

use crate::magnetic::{Joints, SharedTable, table};
use crate::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use embedded_hal::digital::{ErrorType as PinErrorType, InputPin, OutputPin};
use embedded_hal::pwm::{ErrorType as WidthErrorType, SetDutyCycle};
use palpate::commission::Wiring;
use palpate::device::drive::{SetPointDrive, SetPointRange};
use palpate::device::{Counts, Kinematics, StopSearch, SupplyRange};
use palpate::math::vec3;
use palpate::patch::SplinePatch;
use palpate::scene::Commanded;
use palpate::servo::{Fault, Guard, Heartbeat, Phase, ResetReason, Servo, ServoState, Unguarded};
use palpate::wire::telemetry::{Consumer, Queue};
use palpate::wire::{HostMessage, PROTOCOL, Record, frame};
use palpate_bench::sensors::{BadFrame, Counters, Readings, Sensors, max_step};
use palpate_bench::{
    Bench, Counter, Felt, Idle, Lines, Mailbox, OneChannel, Parts, Port, ReadBack, Settings, Supply, Timer,
    TwoChannels, Watchdog,
};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// Rate of the servo, Hz.
pub const RATE: f64 = 4_000.0;
/// Rate of the simulated board's counter, Hz.
pub const CLOCK: u32 = 170_000_000;
/// Increment of the counter at each reading.
const LOOK: u32 = 40;

/// Settings of the servo.
pub const SETTINGS: palpate::servo::Settings = palpate::servo::Settings {
    rate_hz: RATE as f32,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.1,
    body_origin_m: vec3(0.0, 0.0, 0.0),
};

pub use crate::wall::WALL;

/// The stops of the simulated arm, from its hanging pose.
pub const STOPS: [StopSearch; 3] = [
    StopSearch { angle_rad: 1.55, speed_rad_per_s: 1.0, torque_n_m: 0.2, clearance_rad: 0.2, travel_rad: 3.3 },
    StopSearch { angle_rad: 2.15, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
    StopSearch { angle_rad: 1.75, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
];

/// Everything that the pins are wired to.
pub struct World {
    /// The device in a hand.
    pub plant: Plant,
    /// Whether the button is pressed.
    pub button: bool,
    /// Whether its second contact is closed; `None` while that works.
    pub second_contact: Option<bool>,
    /// Whether the contact of the stop button is open: pressed, or its wire is off.
    pub stop_open: bool,
    /// Whether the wires of the ready lines are whole.
    pub ready_wires: [bool; 3],
    /// Whether the amplifiers work.
    pub amplifiers_well: bool,
    /// Supply voltage, V.
    pub supply: f32,
    /// The converter's reading of that voltage in this tick; `None` if it fails.
    pub measured: fn(f32) -> Option<f32>,
    /// Whether a conversion that is started ends.
    pub converts: bool,
    /// The converter's reading of the chip's own reference, as a fraction of the right one.
    pub reference: f32,
    /// Number of frames to come that are bad.
    pub bad: u32,
    /// The kind of the bad frames.
    pub kind: BadFrame,
    /// Of every `[_, n]` frames this number is bad, one after the other; `[0, 1]` is none.
    pub bad_of: [u32; 2],
    /// Frames so far.
    pub frames: u32,
    /// Counts by which the counters differ from the plant: joints that a test turns itself.
    pub turned: [i32; 3],
    /// Counts that the timers captured at marks since the last query.
    pub caught: [Option<i32>; 3],
    /// Cycles that reading the sensors takes.
    pub reading: u32,
    /// Width of the set-points, as a fraction of their period.
    pub widths: [f64; 3],
    /// Levels of the enable lines.
    pub enables: [bool; 3],
    /// Whether something holds one of them high.
    pub is_enable_shorted: bool,
    /// Whether each motor's winding is open.
    pub open_windings: [bool; 3],
    /// Whether the timer of the set-points has opened its outputs, without the program.
    pub outputs_open: bool,
    /// Level of the LED's line.
    pub light: bool,
    /// Value of its counter.
    pub cycles: u32,
}

impl World {
    /// A period of the device, and the rest of the board's.
    pub fn advance(&mut self) {
        let duties = self.currents().map(|current| (current * 32_767.0).round() as i16);
        self.plant.advance(duties);
        self.cycles = self.cycles.wrapping_add(CLOCK / RATE as u32);
    }

    /// Whether an amplifier has supply enough to be ready.
    fn is_powered(&self) -> bool {
        self.supply > 8.0
    }

    /// The motors' currents, by the amplifiers' own configuration: 10 % is full current backwards, 90 % forwards.
    pub fn currents(&self) -> [f64; 3] {
        core::array::from_fn(|joint| {
            let is_driven = self.enables[joint] && !self.outputs_open && self.is_powered() && self.amplifiers_well;
            if is_driven && !self.open_windings[joint] {
                ((self.widths[joint] - 0.5) / 0.4).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        })
    }
}

/// The world, shared by the pins that read and write it.
pub type Shared = Rc<RefCell<World>>;

/// A level that is read.
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

/// A level that is set.
pub struct Out(Shared, fn(&mut World, bool));

impl PinErrorType for Out {
    type Error = Infallible;
}

impl OutputPin for Out {
    fn set_low(&mut self) -> Result<(), Infallible> {
        (self.1)(&mut self.0.borrow_mut(), false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        (self.1)(&mut self.0.borrow_mut(), true);
        Ok(())
    }
}

/// A pulse width of 8,500 steps.
pub struct Width(Shared, usize);

impl WidthErrorType for Width {
    type Error = Infallible;
}

impl SetDutyCycle for Width {
    fn max_duty_cycle(&self) -> u16 {
        8_500
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.borrow_mut().widths[self.1] = f64::from(duty) / 8_500.0;
        Ok(())
    }
}

/// The counter of cycles.
pub struct SimulatedClock(Shared);

impl Counter for SimulatedClock {
    fn now(&self) -> u32 {
        let mut world = self.0.borrow_mut();
        world.cycles = world.cycles.wrapping_add(LOOK);
        world.cycles
    }
}

/// A timer whose interrupts the test is.
pub struct Interrupts;

impl Timer for Interrupts {
    fn acknowledge(&mut self) {}
}

/// The measurement of the supply: as on the boards, a conversion is read in the tick after the one that starts it, and
/// counts if it is over and found the chip's own reference within a tenth.
pub struct Volts {
    world: Shared,
    is_good: bool,
}

impl Supply for Volts {
    fn volts(&mut self) -> Option<f32> {
        let world = self.world.borrow();
        let was_good = self.is_good;
        self.is_good = world.converts && (world.reference - 1.0).abs() <= 0.1;
        if was_good { (world.measured)(world.supply) } else { None }
    }
}

/// Three 16-bit timers.
pub struct Timers(Shared);

impl<const JOINTS: usize> Readings<JOINTS> for Timers {
    fn readings(&mut self) -> [u32; JOINTS] {
        let world = self.0.borrow();
        let counts = world.plant.counts();
        core::array::from_fn(|joint| (counts[joint] + world.turned[joint]) as u32 & 0xffff)
    }

    fn caught(&mut self) -> [Option<u32>; JOINTS] {
        let caught = std::mem::take(&mut self.0.borrow_mut().caught);
        core::array::from_fn(|joint| caught[joint].map(|count| count as u32 & 0xffff))
    }
}

/// The sensors: counters, or magnetic sensors of 2¹⁴ counts a turn on the boards' driver.
enum Reader<const JOINTS: usize> {
    Counters(Counters<Timers, JOINTS>),
    Magnetic(SharedTable, Joints<JOINTS>),
}

/// Sensors that deliver some bad frames, and that take time.
pub struct Spoilt<const JOINTS: usize> {
    world: Shared,
    reader: Reader<JOINTS>,
    /// Difference of counters and joints at the first reading: in most tests the loop is homed from the start.
    ahead: Option<[i32; JOINTS]>,
}

impl<const JOINTS: usize> Sensors<JOINTS> for Spoilt<JOINTS> {
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        {
            let mut world = self.world.borrow_mut();
            world.cycles = world.cycles.wrapping_add(world.reading);
            world.frames += 1;
            let [bad, of] = world.bad_of;
            let is_bad = world.bad > 0 || world.frames % of < bad;
            world.bad = world.bad.saturating_sub(1);
            if is_bad {
                return Err(world.kind);
            }
        }
        let counts = match &mut self.reader {
            Reader::Counters(counters) => counters.read()?,
            Reader::Magnetic(table, angles) => {
                let (world, mut table) = (self.world.borrow(), table.borrow_mut());
                for ((chip, counts), turned) in table.chips.iter_mut().zip(world.plant.counts()).zip(world.turned) {
                    // The last bit of such a sensor is never quiet.
                    chip.angle = ((counts + turned) as u32 & 0x3fff) as u16 ^ (world.frames & 1) as u16;
                }
                drop((world, table));
                angles.read()?
            }
        };
        let joints = self.world.borrow().plant.counts();
        let ahead = *self.ahead.get_or_insert_with(|| core::array::from_fn(|joint| counts[joint].0 - joints[joint]));
        Ok(core::array::from_fn(|joint| Counts(counts[joint].0 - ahead[joint])))
    }

    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        let Reader::Counters(counters) = &mut self.reader else { return [None; JOINTS] };
        let (marks, ahead) = (counters.marks(), self.ahead.unwrap_or([0; JOINTS]));
        core::array::from_fn(|joint| marks[joint].map(|mark| Counts(mark.0 - ahead[joint])))
    }

    fn gains(&self) -> [u8; JOINTS] {
        match &self.reader {
            Reader::Counters(_) => [0; JOINTS],
            Reader::Magnetic(_, angles) => angles.gains(),
        }
    }
}

type Amplifier = SetPointDrive<Width, Out>;
/// The amplifiers, whose enable lines are read back.
type Amplifiers<const JOINTS: usize> = ReadBack<[Amplifier; JOINTS], Box<dyn Fn() -> bool>>;
/// All that a board has for the loop.
pub type SimulatedBoard<const JOINTS: usize = 3> = Parts<
    SimulatedClock,
    Interrupts,
    Spoilt<JOINTS>,
    Amplifiers<JOINTS>,
    TwoChannels<In, In>,
    In,
    In,
    Volts,
    Out,
    JOINTS,
>;

/// The bytes of a host.
struct Sent(std::vec::IntoIter<u8>);

impl Port for Sent {
    fn send(&mut self, _: u8) -> bool {
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.0.next()
    }
}

/// No watchdog.
struct Unwatched;

impl Watchdog for Unwatched {
    fn feed(&mut self) {}
}

/// A servo that a test made, whether it could not be made with the calibration that is kept, and its wiring.
pub struct Made<K: 'static, G = Unguarded, const JOINTS: usize = 3, S: 'static = SplinePatch<'static>>(
    pub Servo<'static, S, K, JOINTS, G>,
    pub bool,
    pub Wiring<JOINTS>,
);

impl<K, G, const JOINTS: usize, S> Felt<JOINTS> for Made<K, G, JOINTS, S>
where
    K: Kinematics<JOINTS> + 'static,
    G: Guard<JOINTS> + 'static,
    S: Commanded + 'static,
{
    type Surface = S;
    type Mechanism = K;
    type Guard = G;

    fn servo(&self) -> &Servo<'static, S, K, JOINTS, G> {
        &self.0
    }

    fn wiring(&self) -> Wiring<JOINTS> {
        self.2
    }

    fn is_miscalibrated(&self) -> bool {
        self.1
    }
}

/// The loop on the simulated bench.
pub struct Rig<
    K: Kinematics<JOINTS> + 'static,
    G: Guard<JOINTS> + 'static = Unguarded,
    const JOINTS: usize = 3,
    S: Commanded + 'static = SplinePatch<'static>,
> {
    /// The far side of the pins.
    pub world: Shared,
    /// The loop.
    pub bench: Bench<'static, Made<K, G, JOINTS, S>, SimulatedBoard<JOINTS>, JOINTS>,
    /// Commands to the loop.
    pub mailbox: &'static Mailbox,
    records: Option<Consumer<'static, Record>>,
}

/// The loop's settings on the rig.
pub fn settings() -> Settings {
    Settings { supply: Some(SupplyRange::TWENTY_FOUR), ..Settings::new(CLOCK) }
}

/// A hand that comes down from 10 mm within 20 ms: a probe that starts inside a wall makes no contact.
struct Down(Vector);

impl HandPath for Down {
    fn target(&self, time: f64) -> Vector {
        let [x, y, z] = self.0;
        [x, y, z + 0.01 * (1.0 - time / 0.02).clamp(0.0, 1.0)]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, if time < 0.02 { -0.5 } else { 0.0 }]
    }
}

/// A hand that holds the probe here, once it is there.
///
/// # Panics
/// If the place is out of reach.
pub fn held_at(place: Vector) -> Plant {
    let hand = HandSettings { stiffness: 2_000.0, damping: 20.0, mass: 0.0 };
    Plant::new(&PlantSettings::wooden_haptics_2016(), hand, Box::new(Down(place)), RATE).unwrap()
}

/// A device at the pins of a board.
pub fn wired<S, K: Kinematics<JOINTS> + 'static, G: Guard<JOINTS> + 'static, const JOINTS: usize>(
    servo: &Servo<'static, S, K, JOINTS, G>,
    plant: Plant,
    settings: &Settings,
) -> (Shared, SimulatedBoard<JOINTS>) {
    let world = World {
        plant,
        button: false,
        second_contact: None,
        stop_open: false,
        ready_wires: [true; 3],
        amplifiers_well: true,
        supply: 24.0,
        measured: Some,
        converts: true,
        reference: 1.0,
        bad: 0,
        kind: BadFrame::Damaged,
        bad_of: [0, 1],
        frames: 0,
        turned: [0; 3],
        caught: [None; 3],
        reading: 200,
        widths: [0.5; 3],
        enables: [false; 3],
        is_enable_shorted: false,
        open_windings: [false; 3],
        outputs_open: false,
        light: false,
        // Near its end, so that it wraps.
        cycles: u32::MAX - 1_000,
    };
    let world = Rc::new(RefCell::new(world));
    let board = pins(&world, servo, settings);
    (world, board)
}

/// A board at the pins of a device.
fn pins<S, K: Kinematics<JOINTS> + 'static, G: Guard<JOINTS> + 'static, const JOINTS: usize>(
    world: &Shared,
    servo: &Servo<'static, S, K, JOINTS, G>,
    settings: &Settings,
) -> SimulatedBoard<JOINTS> {
    let of = || Rc::clone(world);
    let device = servo.device();
    let steps = device
        .encoders
        .map(|encoder| max_step(&encoder, device.max_joint_rate_rad_per_s, RATE as f32, settings.bad_frames));
    let enables: [fn(&mut World, bool); 3] = [
        |world, level| world.enables[0] = level,
        |world, level| world.enables[1] = level,
        |world, level| {
            world.enables[2] = level;
        },
    ];
    // A broken wire is pulled down at the pin; an amplifier without supply pulls nothing up.
    let ready: [fn(&World) -> bool; 3] = [
        |world| world.ready_wires[0] && world.is_powered() && world.amplifiers_well,
        |world| world.ready_wires[1] && world.is_powered(),
        |world| world.ready_wires[2] && world.is_powered(),
    ];
    let amplifier =
        |joint: usize| SetPointDrive::new(Width(of(), joint), Out(of(), enables[joint]), SetPointRange::TEN_TO_NINETY);
    let at_pins = of();
    let reads_enabled: Box<dyn Fn() -> bool> = Box::new(move || {
        let world = at_pins.borrow();
        world.is_enable_shorted || world.enables != [false; 3]
    });
    Parts {
        counter: SimulatedClock(of()),
        timer: Interrupts,
        sensors: Spoilt { world: of(), reader: Reader::Counters(Counters::new(Timers(of()), steps)), ahead: None },
        drives: ReadBack::new(core::array::from_fn(amplifier), reads_enabled),
        lines: Lines {
            enable: TwoChannels::new(
                OneChannel { pin: In(of(), |world| world.button), pressed_level: true },
                OneChannel {
                    pin: In(of(), |world| !world.second_contact.unwrap_or(world.button)),
                    pressed_level: false,
                },
                RATE as f32,
            ),
            stop: In(of(), |world| world.stop_open),
            ready: core::array::from_fn(|joint| In(of(), ready[joint])),
            supply: Volts { world: of(), is_good: true },
        },
        light: Out(of(), |world, level| world.light = level),
    }
}

impl<K: Kinematics<JOINTS> + 'static, G: Guard<JOINTS> + 'static, const JOINTS: usize, S: Commanded + 'static>
    Rig<K, G, JOINTS, S>
{
    /// A servo at the pins of a board that was reset for this reason.
    ///
    /// # Panics
    /// As [`Bench::new`].
    pub fn new(servo: Servo<'static, S, K, JOINTS, G>, plant: Plant, settings: &Settings, reset: ResetReason) -> Self {
        Self::made(Made(servo, false, Wiring::STRAIGHT), plant, settings, reset)
    }

    /// As [`Rig::new`], of a servo that was made with a calibration or without.
    pub fn made(made: Made<K, G, JOINTS, S>, plant: Plant, settings: &Settings, reset: ResetReason) -> Self {
        let (world, board) = wired(&made.0, plant, settings);
        Self::at(world, made, board, settings, reset)
    }

    fn at(
        world: Shared,
        made: Made<K, G, JOINTS, S>,
        board: SimulatedBoard<JOINTS>,
        settings: &Settings,
        reset: ResetReason,
    ) -> Self {
        // They live as long as the test, as a board's statics do.
        let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
        let queue: &'static mut Queue<Record, 4_096> = Box::leak(Box::new(Queue::new()));
        let (producer, records) = queue.split();
        let bench = Bench::new(made, board, settings, reset, producer, mailbox);
        Self { world, bench, mailbox, records: Some(records) }
    }

    /// The board is reset and starts again at the same device: its lines rest, and the amplifiers are disabled.
    pub fn restart(&mut self, settings: &Settings, reset: ResetReason) {
        self.set(|world| (world.enables, world.widths, world.outputs_open) = ([false; 3], [0.5; 3], false));
        let servo = *self.bench.felt().servo();
        let board = pins(&self.world, &servo, settings);
        let made = Made(servo, self.bench.felt().is_miscalibrated(), self.bench.felt().wiring());
        *self = Self::at(Rc::clone(&self.world), made, board, settings, reset);
    }

    /// Magnetic sensors in the place of the counters, started; their failures are planted in the table.
    ///
    /// # Panics
    /// If they do not start.
    pub fn with_magnetic_sensors(&mut self) -> SharedTable {
        let (shared, mut joints) = table(CLOCK, LOOK.into());
        joints.start().unwrap();
        let sensors = &mut self.bench.board().sensors;
        (sensors.reader, sensors.ahead) = (Reader::Magnetic(Rc::clone(&shared), joints), None);
        shared
    }

    /// The receiving end of the telemetry queue.
    ///
    /// # Panics
    /// If it was taken before.
    pub fn take_records(&mut self) -> Consumer<'static, Record> {
        self.records.take().unwrap()
    }

    /// The last record that was sent.
    ///
    /// # Panics
    /// If the queue's end was taken.
    pub fn last_record(&mut self) -> Option<Record> {
        let records = self.records.as_mut().unwrap();
        core::iter::from_fn(|| records.dequeue()).last()
    }

    /// A command of a host, which greets first, over the board's port.
    ///
    /// # Panics
    /// If it does not fit a frame.
    pub fn send(&self, command: HostMessage) {
        let mut buffer = [0; frame::MAX_FRAME];
        let mut bytes = frame::pack(&HostMessage::Hello { protocol: PROTOCOL }, &mut buffer).unwrap().to_vec();
        bytes.extend_from_slice(frame::pack(&command, &mut buffer).unwrap());
        let (count, mut line) = (bytes.len(), Sent(bytes.into_iter()));
        let mut queue = Queue::<_, 2>::new();
        let (_, records) = queue.split();
        let mut idle = Idle::new(self.mailbox, records, Heartbeat::default());
        (0..count).for_each(|_| idle.step(&mut line, &mut Unwatched));
    }

    /// A tick of the loop and a period of the device.
    pub fn tick(&mut self) {
        self.bench.tick();
        self.world.borrow_mut().advance();
    }

    /// Ticks of the loop.
    pub fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick());
    }

    /// Ticks, each of which leaves every amplifier disabled.
    ///
    /// # Panics
    /// If one does not.
    #[track_caller]
    pub fn ticks_off(&mut self, ticks: u32) {
        for tick in 0..ticks {
            self.tick();
            assert!(self.is_off(), "tick {tick}: {:?} {:?}", self.state().phase(), self.world.borrow().enables);
        }
    }

    /// Changes the far side of the pins.
    pub fn set(&self, change: impl FnOnce(&mut World)) {
        change(&mut self.world.borrow_mut());
    }

    /// Whether every amplifier is disabled, or no set-point reaches any.
    pub fn is_off(&self) -> bool {
        let world = self.world.borrow();
        world.outputs_open || world.enables == [false; 3]
    }

    /// The servo's state.
    pub fn state(&self) -> &ServoState<JOINTS, S::Witness, G::State> {
        self.bench.state()
    }

    /// The servo's fault.
    pub fn fault(&self) -> Option<Fault> {
        self.state().fault().map(|(fault, _)| fault)
    }

    /// Presses the released button and waits until the loop renders force.
    ///
    /// # Panics
    /// If it does not within 800 ticks.
    #[track_caller]
    pub fn press_until_it_runs(&mut self) {
        self.set(|world| world.button = false);
        // More than the 25 ms for which a hold goes on, and the 25 ms for which a release must last.
        self.ticks(250);
        self.set(|world| world.button = true);
        self.ticks(800);
        assert_eq!((self.state().phase(), self.fault()), (Phase::Running, None));
        assert!(!self.is_off());
    }
}
