//! The loop of the boards, compiled for the host, on a simulated board.

use super::{Line, RATE, World};
use anyhow::{Context as _, bail};
use palpate::commission::Wiring;
use palpate::device::drive::Field;
use palpate::device::{Counts, Device, Duty, Homing, Kinematics, Protection, Reference};
use palpate::math::vec3;
use palpate::patch::SplinePatch;
use palpate::servo::{Config, Guarded, ResetReason, Servo, Settings};
use palpate_bench::sensors::BadFrame;
use palpate_bench::store::{Built, Found, KeptCalibration, PretendedFlash};
use palpate_bench::{Felt, Panel};
use palpate_sim::devices::preset::Preset;
use palpate_sim::devices::{HomingEntry, OwnDevice};
use palpate_sim::simulated::{AtPins, CLOCK_HZ, SimulatedBoard, Ticks};
use palpate_sim::wall::WALL;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

/// The simulated bench, at the board's pins.
struct AtBench(Arc<Mutex<World>>);

impl AtBench {
    fn world(&self) -> MutexGuard<'_, World> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl AtPins<3> for AtBench {
    fn panel(&mut self) -> Panel {
        Panel { enable: self.world().enable, enable_disagrees: false, stop: false, ready: true, supply: None }
    }

    fn counts(&mut self) -> Result<[Counts; 3], BadFrame> {
        Ok(self.world().counts().map(Counts))
    }

    fn marks(&mut self) -> [Option<Counts>; 3] {
        self.world().take_marks().map(|mark| mark.map(Counts))
    }

    fn advance(&mut self, _: Option<[Field; 3]>, duties: Option<[Duty; 3]>) {
        self.world().advance(duties.unwrap_or_default().map(|duty| duty.0));
    }
}

/// A board, whatever the mechanism at its pins.
type Started = SimulatedBoard<Box<dyn Ticks>>;

/// A line to the loop of the boards in this very program.
pub struct HostLine {
    board: Started,
    flash: &'static Flash,
    start: Box<dyn Fn(&'static Flash) -> anyhow::Result<Started>>,
    world: Arc<Mutex<World>>,
}

impl HostLine {
    /// A device as its firmware has it from this file, in this world.
    ///
    /// # Errors
    /// A device of fewer joints, or settings that it does not take.
    pub fn new(own: &OwnDevice, world: &Arc<Mutex<World>>) -> anyhow::Result<Self> {
        match own.preset {
            Preset::SerialArm(device) => Self::of(device, own, world),
            Preset::LinkageArm(device) => Self::of(device, own, world),
            Preset::Delta(device) => Self::of(device, own, world),
            Preset::FiveBar(_) | Preset::Paddle(_) => bail!("{} has too few joints", own.file.name),
        }
    }

    fn of<K: Kinematics<3> + Copy>(
        device: &'static Device<K, 3>,
        own: &OwnDevice,
        world: &Arc<Mutex<World>>,
    ) -> anyhow::Result<Self> {
        let flash: &'static Flash = Box::leak(Box::new(Flash::new()));
        let (world, at_line) = (Arc::clone(world), Arc::clone(world));
        let (protection, wiring, homing) = (own.protection, own.wiring(), own.file.homing);
        let start = Box::new(move |flash| started((device, protection, wiring), homing, &world, flash));
        let board = start(flash)?;
        Ok(Self { board, flash, start, world: at_line })
    }
}

/// Starts a device with the content of its flash. Its parts are leaked, so that they live as long as a board's statics.
fn started<K: Kinematics<3> + Copy>(
    (built, protection, wiring): (&'static Device<K, 3>, Protection<3>, Wiring<3>),
    homing: HomingEntry,
    world: &Arc<Mutex<World>>,
    flash: &'static Flash,
) -> anyhow::Result<Started> {
    let settings = Settings {
        rate_hz: RATE,
        stiffness_n_per_m: 0.5 * built.max_stiffness_n_per_m,
        damping_n_s_per_m: 0.5 * built.max_damping_n_s_per_m,
        max_force_n: 0.5 * built.max_force_n,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.2,
        body_origin_m: vec3(0.0, 0.0, -1.0),
    };
    let writer = flash.writer().context("its flash has a writer already")?;
    let servo = Servo::try_protected(built, &WALL, protection, Config { settings, ..Config::DEFAULT })?;
    // As the boards are homed.
    let (still, patience) = ((0.1 * RATE) as u32, (10.0 * RATE) as u32);
    let by = |reference| Homing::try_new(built.encoders, reference, still, 4, patience).map(Homing::when_asked);
    let servo = match homing {
        HomingEntry::Pose => servo.with_homing(by(Reference::Pose(built.angles_at_zero()))?),
        HomingEntry::Index => servo.with_homing(by(Reference::Index(built.angles_at_zero()))?),
        HomingEntry::None => servo,
    };
    let (kept, found) = KeptCalibration::find(
        writer,
        Built { device: built, wiring, homed_by: servo.zero_of(), gains: settings.gains() },
    );
    let Found { device, wiring, is_miscalibrated } = found;
    let made = Made { servo: servo.calibrated(Box::leak(Box::new(device))), wiring, is_miscalibrated };
    if homing != HomingEntry::None {
        world.lock().unwrap_or_else(PoisonError::into_inner).begin_to_count();
    }
    let settings = palpate_bench::Settings::new(CLOCK_HZ);
    let SimulatedBoard { bench, idle, wire } =
        SimulatedBoard::new(made, AtBench(Arc::clone(world)), &settings, ResetReason::PowerOn);
    let idle = idle.calibrating(Box::leak(Box::new(kept)));
    Ok(SimulatedBoard { bench: Box::new(bench), idle, wire })
}

impl Line for HostLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.board.wire.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            self.board.tick(BYTES);
        }
        Ok(std::mem::take(&mut self.board.wire.from_device))
    }

    fn press(&mut self, pressed: bool) -> anyhow::Result<bool> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner).enable = pressed;
        Ok(true)
    }

    fn reset(&mut self) -> anyhow::Result<bool> {
        self.flash = Box::leak(Box::new(self.flash.after_reset()));
        self.board = (self.start)(self.flash)?;
        Ok(true)
    }
}
