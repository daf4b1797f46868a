//! The loop of the boards, compiled for the host, on a simulated board.

use super::{Line, RATE, World};
use anyhow::{Context as _, bail};
use palpate::commission::Wiring;
use palpate::device::{Counts, Device, Duty, Homing, Kinematics, Protection, Reference};
use palpate::math::vec3;
use palpate::patch::SplinePatch;
use palpate::servo::{Guarded, Heartbeat, ResetReason, Servo, Settings};
use palpate::track::Controller;
use palpate::wire::Record;
use palpate::wire::telemetry::Queue;
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Bench, Board, Felt, Idle, Mailbox, NotObeyed, Panel, Passive, Port, Watchdog};
use palpate_shelf::{Found, KeptCalibration, PretendedFlash};
use palpate_sim::devices::preset::Preset;
use palpate_sim::devices::{HomingEntry, OwnDevice};
use palpate_sim::wall::WALL;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Of the simulated board's counter, Hz.
const CLOCK: u32 = 100_000_000;
/// Ticks that the device runs while the line is looked at: two milliseconds.
const TICKS: u32 = 8;
/// Bytes that a line of 500,000 baud carries in a tick, either way, with time to spare.
const BYTES: u32 = 16;

/// Its flash: a page, for a calibration.
type Flash = PretendedFlash<512>;

/// A servo on the device as it was found in flash.
struct Made<K: 'static> {
    servo: Servo<'static, SplinePatch<'static>, K, 3, Guarded<3>>,
    wiring: Wiring<3>,
    is_miscalibrated: bool,
}

impl<K: Kinematics<3> + 'static> Felt<3> for Made<K> {
    type Surface = SplinePatch<'static>;
    type Mechanism = K;
    type Guard = Guarded<3>;

    fn servo(&self) -> &Servo<'static, SplinePatch<'static>, K, 3, Guarded<3>> {
        &self.servo
    }

    fn wiring(&self) -> Wiring<3> {
        self.wiring
    }

    fn is_miscalibrated(&self) -> bool {
        self.is_miscalibrated
    }
}

/// A board whose pins are the simulated device's.
struct SimulatedBoard {
    world: Arc<Mutex<World>>,
    duties: [i16; 3],
}

impl SimulatedBoard {
    fn world(&self) -> MutexGuard<'_, World> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Board<3> for SimulatedBoard {
    fn drive(&mut self, duties: [Duty; 3]) -> Result<(), NotObeyed> {
        self.duties = duties.map(|duty| duty.0);
        Ok(())
    }
}

impl Passive<3> for SimulatedBoard {
    fn now(&self) -> u32 {
        0
    }

    fn acknowledge(&mut self) {}

    fn panel(&mut self) -> Panel {
        Panel { enable: self.world().enable, stop: false, ready: true, supply: None }
    }

    fn read(&mut self) -> Result<[Counts; 3], BadFrame> {
        Ok(self.world().counts().map(Counts))
    }

    fn marks(&mut self) -> [Option<Counts>; 3] {
        self.world().take_marks().map(|mark| mark.map(Counts))
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        self.duties = [0; 3];
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}

/// A tick of a device, whatever its mechanism.
trait Ticks {
    /// A tick, and a period of the simulated device.
    fn tick(&mut self);
}

impl<K: Kinematics<3> + 'static> Ticks for Bench<'static, Made<K>, SimulatedBoard, 3> {
    fn tick(&mut self) {
        Bench::tick(self);
        let duties = self.board().duties;
        self.board().world().advance(duties);
    }
}

/// The serial port, both ends.
#[derive(Default)]
struct Bytes {
    to_device: VecDeque<u8>,
    from_device: Vec<u8>,
}

impl Port for Bytes {
    fn send(&mut self, byte: u8) -> bool {
        self.from_device.push(byte);
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.to_device.pop_front()
    }
}

struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}
}

/// The loop and what runs below it.
type Started = (Box<dyn Ticks>, Idle<'static>);

/// A line to the loop of the boards in this very program.
pub struct HostLine {
    bench: Box<dyn Ticks>,
    idle: Idle<'static>,
    bytes: Bytes,
    flash: &'static Flash,
    start: Box<dyn Fn(&'static Flash) -> anyhow::Result<Started>>,
}

impl HostLine {
    /// A device as its firmware has it from this file, in this world.
    ///
    /// # Errors
    /// A device of fewer joints, or settings that it does not take.
    pub fn new(own: &OwnDevice, world: &Arc<Mutex<World>>) -> anyhow::Result<Self> {
        match own.preset {
            Preset::SerialArm(device) => Self::of(device, own.protection, own.file.homing, world),
            Preset::LinkageArm(device) => Self::of(device, own.protection, own.file.homing, world),
            Preset::Delta(device) => Self::of(device, own.protection, own.file.homing, world),
            Preset::FiveBar(_) | Preset::Paddle(_) => bail!("{} has too few joints", own.file.name),
        }
    }

    fn of<K: Kinematics<3> + Copy>(
        device: &'static Device<K, 3>,
        protection: Protection<3>,
        homing: HomingEntry,
        world: &Arc<Mutex<World>>,
    ) -> anyhow::Result<Self> {
        let flash: &'static Flash = Box::leak(Box::new(Flash::new()));
        let world = Arc::clone(world);
        let start = Box::new(move |flash| started((device, protection), homing, &world, flash));
        let (bench, idle) = start(flash)?;
        Ok(Self { bench, idle, bytes: Bytes::default(), flash, start })
    }
}

/// A device that begins, with what its flash has. What it is made of lives as long as the program, as a board's statics
/// do.
fn started<K: Kinematics<3> + Copy>(
    (built, protection): (&'static Device<K, 3>, Protection<3>),
    homing: HomingEntry,
    world: &Arc<Mutex<World>>,
    flash: &'static Flash,
) -> anyhow::Result<Started> {
    let settings = Settings {
        rate_hz: RATE,
        stiffness_n_per_m: 0.5 * built.max_stiffness_n_per_m,
        damping_n_s_per_m: 0.5 * built.max_damping_n_s_per_m,
        max_force_n: built.max_force_n,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.2,
        body_origin_m: vec3(0.0, 0.0, -1.0),
    };
    let writer = flash.writer().context("its flash has a writer already")?;
    let servo = Servo::try_new(built, &WALL, Controller::SECOND_ORDER, settings)?.try_protect(protection)?;
    // As the boards are homed.
    let (still, patience) = ((0.1 * RATE) as u32, (10.0 * RATE) as u32);
    let by = |reference| Homing::try_new(built.encoders, reference, still, 4, patience).map(Homing::when_asked);
    let servo = match homing {
        HomingEntry::Pose => servo.homing(by(Reference::Pose(built.angles_at_zero()))?),
        HomingEntry::Index => servo.homing(by(Reference::Index(built.angles_at_zero()))?),
        HomingEntry::None => servo,
    };
    let (kept, found) = KeptCalibration::find(writer, built, servo.zero_of());
    let Found { device, wiring, is_miscalibrated } = found;
    let made = Made { servo: servo.calibrated(Box::leak(Box::new(device))), wiring, is_miscalibrated };
    if homing != HomingEntry::None {
        world.lock().unwrap_or_else(PoisonError::into_inner).begin_to_count();
    }
    let board = SimulatedBoard { world: Arc::clone(world), duties: [0; 3] };
    let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
    let queue: &'static mut Queue<Record, 16> = Box::leak(Box::new(Queue::new()));
    let (producer, records) = queue.split();
    let settings = palpate_bench::Settings::new(CLOCK);
    let bench = Bench::new(made, board, &settings, ResetReason::PowerOn, producer, mailbox);
    let idle = Idle::new(mailbox, records, Heartbeat::default()).calibrating(Box::leak(Box::new(kept)));
    Ok((Box::new(bench), idle))
}

impl Line for HostLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.bytes.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            self.bench.tick();
            for _ in 0..BYTES {
                self.idle.step(&mut self.bytes, &mut NoWatchdog);
            }
        }
        Ok(std::mem::take(&mut self.bytes.from_device))
    }

    fn reset(&mut self) -> anyhow::Result<bool> {
        self.flash = Box::leak(Box::new(self.flash.after_reset()));
        (self.bench, self.idle) = (self.start)(self.flash)?;
        self.bytes = Bytes::default();
        Ok(true)
    }
}
