//! The device.

use crate::plant::{HandSettings, Plant, PlantSettings};
use crate::simulated::board::{AtPins, CLOCK_HZ, SimulatedBench, SimulatedBoard};
use crate::simulated::hand::Hand;
use anyhow::Context as _;
use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, FileHead};
use palpate::commission::Wiring;
use palpate::device::drive::Field;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Duty, SerialArm};
use palpate::math::{Vec3, vec3};
use palpate::scene::{Limits, Material, Motion, Part, Scene, Slot};
use palpate::servo::{Config, ResetReason, Safety, Servo, Settings, Unguarded};
use palpate::track::Placement;
use palpate_bench::sensors::BadFrame;
use palpate_bench::store::{Bodies, Both, Kept, PretendedFlash};
use palpate_bench::{Felt, Panel, Uploads};
use palpate_link::Line;
use std::io;
use std::time::{Duration, Instant};

/// Ticks a second.
const RATE: u32 = 4_000;
/// Bytes that a line of 500,000 baud carries in a tick, either way.
const BYTES: u32 = 12;
/// The second box is so far to the side of the first, metres: 20 mm are between them.
const BESIDE: f32 = 0.06;
/// Where the middle of the workspace is in the scene, metres: just over the dome of the first box.
const MIDDLE: [f32; 3] = [0.03, 0.02, 0.04];
/// Where the hand is at first, metres, in the scene.
const ABOVE: [f64; 3] = [0.03, 0.02, 0.05];

/// The capped box, as the tool bakes it.
static BOX: &Aligned<[u8]> = &Aligned(*include_bytes!("../../../../boards/bodies/capped_box.palp"));

/// Two banks of 64 KB, and faces and edges of some 200 patches.
type Memory = Bodies<16_640, 240, 600>;
type Flash = Kept<240, 600>;
type Shelf = Both<'static, Memory, Flash>;
type Surface = Scene<'static, Slot<'static, Shelf>, 2>;

struct Made(Servo<'static, Surface, SerialArm, 3>);

impl Felt<3> for Made {
    type Surface = Surface;
    type Mechanism = SerialArm;
    type Guard = Unguarded;

    fn servo(&self) -> &Servo<'static, Surface, SerialArm, 3> {
        &self.0
    }

    fn wiring(&self) -> Wiring<3> {
        Wiring::STRAIGHT
    }
}

/// The arm in a hand, at the board's pins.
struct AtArm {
    plant: Plant,
    hand: Hand,
}

impl AtPins<3> for AtArm {
    fn panel(&mut self) -> Panel {
        Panel { enable: self.hand.is_enabling(), enable_disagrees: false, stop: false, ready: true, supply: None }
    }

    fn counts(&mut self) -> Result<[Counts; 3], BadFrame> {
        Ok(self.plant.counts().map(Counts))
    }

    fn advance(&mut self, _: Option<[Field; 3]>, duties: Option<[Duty; 3]>) {
        self.plant.advance(duties.unwrap_or_default().map(|duty| duty.0));
    }
}

/// A line to the boards' loop in this very program. The device lives while it is listened to; its time is its own.
pub struct Simulated {
    board: SimulatedBoard<SimulatedBench<Made, AtArm, 3>>,
    hand: Hand,
    flash: &'static InFlash,
    ticks: u32,
    began: Instant,
    is_paced: bool,
    /// Ticks for which the hand has confirmed what the device asks.
    confirms: Option<u32>,
    bytes_per_tick: u32,
    /// The loop's own record, once it is kept: tick, gap, force.
    own_record: Option<Vec<(u32, f32, Vec3)>>,
}

/// Options of the simulated device.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Whether it has memory for uploaded bodies.
    pub takes_bodies: bool,
    /// Seconds without a host message after which it stops.
    pub link_timeout: f32,
    /// Its reset reason.
    pub reset: ResetReason,
    /// Whether it has flash to store a body: 64 KB.
    pub keeps_bodies: bool,
    /// Bytes that its line carries in a tick, either way.
    pub bytes_per_tick: u32,
}

type InFlash = PretendedFlash<16_384>;

impl Default for Kind {
    /// With memory of both kinds, half a second, just switched on, at 500,000 baud.
    fn default() -> Self {
        Self {
            takes_bodies: true,
            link_timeout: 0.5,
            reset: ResetReason::PowerOn,
            keeps_bodies: true,
            bytes_per_tick: BYTES,
        }
    }
}

/// Leaks a value, which so lives as long as a board's statics.
fn kept<T>(what: T) -> &'static T {
    Box::leak(Box::new(what))
}

/// The boards' default body, as a file holds it.
///
/// # Errors
/// A bug of this program.
pub fn capped_box() -> anyhow::Result<&'static Body<'static>> {
    let head = FileHead::of(&BOX.0)?;
    let faces = Box::leak(vec![Face::VACANT; head.faces].into_boxed_slice());
    let edges = Box::leak(vec![Edge::VACANT; head.edges].into_boxed_slice());
    Ok(kept(Body::from_bytes(&BOX.0, BodyBuffer { faces, edges })?))
}

impl Simulated {
    /// A device that was just switched on, held some 16 mm above the dome of the first box; enable is released.
    ///
    /// # Errors
    /// A bug of this program.
    pub fn new(kind: Kind) -> anyhow::Result<Self> {
        Self::with(kind, kept(InFlash::new()))
    }

    /// Another that is what this one is after a reset: what was kept in its flash is there still.
    ///
    /// # Errors
    /// A bug of this program.
    pub fn reset(&self, kind: Kind) -> anyhow::Result<Self> {
        Self::with(kind, kept(self.flash.after_reset()))
    }

    fn with(kind: Kind, flash: &'static InFlash) -> anyhow::Result<Self> {
        let body = capped_box()?;
        let memory: &'static Memory = kept(Bodies::new());
        let in_flash: &'static Flash = kept(Kept::new(flash.region()));
        let shelf: &'static Shelf = kept(Both(memory, in_flash));
        // Before the loop is made, which feels what is found.
        let writer = flash.writer().context("another device has this flash")?;
        let (keeping, _) = in_flash.main(writer, &mut || ()).context("its flash is handed out once")?;
        let slots = kept([Slot::fixed(body), Slot::exchangeable(body, shelf)]);
        let place = |y: f32| Motion::Resting(Placement { origin: vec3(0.0, y, 0.0), ..Placement::IDENTITY });
        let material = Material::new(400.0, 1.5);
        let parts = [Part::in_slot(&slots[0], place(0.0), material), Part::in_slot(&slots[1], place(BESIDE), material)];
        let scene = kept(Scene::try_new(Limits::of(&WOODEN_HAPTICS_2016, RATE as f32), parts)?);
        let settings = Settings {
            rate_hz: RATE as f32,
            stiffness_n_per_m: 400.0,
            damping_n_s_per_m: 1.5,
            max_force_n: 5.0,
            velocity_corner_hz: 200.0,
            soft_start_s: 0.1,
            body_origin_m: -Vec3::from_array(MIDDLE),
        };
        let servo = Servo::try_new(
            &WOODEN_HAPTICS_2016,
            scene,
            Config {
                settings,
                safety: Safety { link_timeout_s: kind.link_timeout, ..Safety::DEFAULT },
                ..Config::DEFAULT
            },
        )?;
        let hand = Hand::at(ABOVE, MIDDLE.map(f64::from));
        let grip = HandSettings::default();
        let path = Box::new(hand.clone());
        let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), grip, path, f64::from(RATE))?;
        let world = AtArm { plant, hand: hand.clone() };
        let loop_settings = palpate_bench::Settings::new(CLOCK_HZ);
        let mut board = SimulatedBoard::new(Made(servo), world, &loop_settings, kind.reset);
        board.idle = board.idle.saying(settings.rate_hz, settings.max_force_n);
        if kind.takes_bodies {
            let main: &'static dyn Uploads = kept(memory.main().context("its memory is handed out once")?);
            board.idle = board.idle.taking(main);
        }
        let keeping: &'static dyn Uploads = kept(keeping);
        if kind.keeps_bodies {
            board.idle = board.idle.keeping(keeping);
        }
        Ok(Self {
            board,
            hand,
            flash,
            ticks: 0,
            began: Instant::now(),
            is_paced: false,
            confirms: None,
            bytes_per_tick: kind.bytes_per_tick,
            own_record: None,
        })
    }

    /// Limits the simulation to real time.
    #[must_use]
    pub fn paced(self) -> Self {
        Self { is_paced: true, ..self }
    }

    /// The simulated user.
    pub fn hand(&self) -> Hand {
        self.hand.clone()
    }

    /// Runs the device without a host.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    /// Tick, gap and force (m, N) of each tick since the last call; the first call starts to keep them.
    pub fn own_record(&mut self) -> Vec<(u32, f32, Vec3)> {
        self.own_record.replace(Vec::new()).unwrap_or_default()
    }

    /// The motors' duties.
    pub fn duties(&mut self) -> [i16; 3] {
        self.board.bench.board().duties.unwrap_or_default().map(|duty| duty.0)
    }

    fn tick(&mut self) {
        self.board.tick(self.bytes_per_tick);
        self.ticks += 1;
        if let Some(record) = &mut self.own_record {
            let state = self.board.bench.state();
            record.push((state.ticks().wrapping_sub(1), state.gap(), state.force()));
        }
        // The hand confirms what the device asks it to: the button for 0.6 s, unless it holds it already.
        if self.board.bench.asks_to_confirm() {
            self.confirms = self.confirms.map_or(Some(0), |ticks| Some(ticks + 1));
        } else {
            self.confirms = None;
        }
        if let Some(ticks) = self.confirms {
            self.hand.enables(ticks < RATE * 6 / 10);
        }
    }

    /// Simulated time since power-on.
    fn passed(&self) -> Duration {
        Duration::from_secs(1) * self.ticks / RATE
    }
}

impl Line for Simulated {
    fn name(&self) -> String {
        "the simulated device".to_owned()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.board.wire.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let began = self.passed();
        // What comes in the tick after it was asked for in vain is there the next time.
        if wait.is_zero() && self.board.wire.from_device.is_empty() {
            self.tick();
            return Ok(0);
        }
        while self.board.wire.from_device.is_empty() && self.passed() - began < wait {
            self.tick();
        }
        if self.is_paced {
            std::thread::sleep((self.began + self.passed()).saturating_duration_since(Instant::now()));
        }
        let came = self.board.wire.from_device.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.board.wire.from_device.drain(..came)) {
            *place = byte;
        }
        Ok(came)
    }

    fn now(&self) -> Instant {
        self.began + self.passed()
    }
}
