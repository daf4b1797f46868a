//! Replay of a recorded run: passes the counts of each tick through the firmware's code and computes the hash.

use crate::felt::Loaded;
use crate::page::RENDERINGS;
use crate::view;
use crate::view::Sighted;
use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::body::Body;
use palpate::device::{Counts, Device};
use palpate::math::Vec3;
use palpate::scene::Scene;
use palpate::servo::{Config, Event, Guard, Input, Rendering, Safety, Servo, ServoState, Settings};
use palpate::track::Controller;
use palpate::wire::frame::{DELIMITER, Received, Receiver};
use palpate::wire::{Answer, DeviceMessage, Dial, Record};
use palpate_sim::recorded::{Mechanism, Recorded, SceneNumbers};

/// How a run was made.
#[derive(Clone, Debug)]
pub struct Run {
    /// On which device.
    pub on: Recorded,
    /// The loop's settings.
    pub settings: Settings,
    /// How the surface felt.
    pub rendering: Rendering,
    /// Seconds without a host after which it stops.
    pub link_timeout: f32,
    /// The rendered scene; `None` for a single body or patch.
    pub scene: Option<SceneNumbers>,
}

/// How many numbers the loop's settings are.
const SETTINGS: usize = 9;

impl Run {
    /// From the numbers of a recording: rate, stiffness, damping, maximum force, velocity corner, soft start and the
    /// body's origin; then the `of_device` numbers of the device; then those of the scene, if it was one. The rendering is
    /// 0 for plain, 1 for eased, 2 for smooth.
    pub fn of(numbers: &[f32], of_device: usize, link_timeout: f32, rendering: u32) -> Option<Self> {
        let (settings, numbers) = numbers.split_at_checked(SETTINGS)?;
        let (device, scene) = numbers.split_at_checked(of_device)?;
        let &[rate, stiffness, damping, max_force, velocity_corner, soft_start, x, y, z] = settings else {
            return None;
        };
        let body_origin = Vec3::new(x, y, z);
        let scene = if scene.is_empty() { None } else { Some(SceneNumbers::of(scene)?) };
        Some(Self {
            on: Recorded::of(device)?,
            settings: Settings {
                rate_hz: rate,
                stiffness_n_per_m: stiffness,
                damping_n_s_per_m: damping,
                max_force_n: max_force,
                velocity_corner_hz: velocity_corner,
                soft_start_s: soft_start,
                body_origin_m: body_origin,
            },
            rendering: *RENDERINGS.get(rendering as usize)?,
            link_timeout,
            scene,
        })
    }
}

/// A loop that takes recorded sensor values.
pub trait Replay: Send {
    /// One tick.
    fn tick(&mut self, counts: [i32; 3], enable: bool);
    /// Appends the numbers to draw.
    fn view(&self, out: &mut Vec<f32>);
    /// The hash so far, as the tool's summary prints it.
    fn hash(&self) -> u32;
}

struct Replayed<S: Sighted, G: Guard<3> + 'static> {
    surface: &'static S,
    servo: Servo<'static, S, Mechanism, 3, G>,
    state: ServoState<3, S::Witness, G::State>,
    hash: u32,
}

impl<S: Sighted + Sync, G: Guard<3> + Send> Replay for Replayed<S, G>
where
    S::Witness: Send,
    G::State: Send,
{
    fn tick(&mut self, counts: [i32; 3], enable: bool) {
        self.servo.note(&mut self.state, Event::LinkAlive);
        let _ = self.servo.tick(&mut self.state, Input::Sensors { counts: counts.map(Counts), enable });
        self.hash = (self.hash ^ self.state.digest()).wrapping_mul(0x0100_0193);
    }

    fn view(&self, out: &mut Vec<f32>) {
        view::write(&self.state, self.surface, &Controller::SecondOrder, self.state.probe(), out);
    }

    fn hash(&self) -> u32 {
        self.hash
    }
}

/// The loop of a run: over a scene of these bodies, or over the first of them.
///
/// # Errors
/// The loop's reason to refuse the run, in a sentence.
pub fn replay(run: &Run, first: &Loaded, others: &[Loaded]) -> Result<Box<dyn Replay>, String> {
    let Some(scene) = &run.scene else { return begin(run, first.felt) };
    let bodies: Vec<&'static Body<'static>> = [first].into_iter().chain(others).map(|loaded| loaded.body).collect();
    match scene.entries.len() {
        1 => over::<1>(run, scene, &bodies),
        2 => over::<2>(run, scene, &bodies),
        3 => over::<3>(run, scene, &bodies),
        4 => over::<4>(run, scene, &bodies),
        5 => over::<5>(run, scene, &bodies),
        6 => over::<6>(run, scene, &bodies),
        7 => over::<7>(run, scene, &bodies),
        8 => over::<8>(run, scene, &bodies),
        count => Err(alloc::format!("{count} bodies: the page has scenes of 1 to 8")),
    }
}

fn over<const N: usize>(
    run: &Run,
    scene: &SceneNumbers,
    bodies: &[&'static Body<'static>],
) -> Result<Box<dyn Replay>, String> {
    let parts = scene.parts(bodies).and_then(|parts| <[_; N]>::try_from(parts).ok());
    let parts = parts.ok_or("the scene has a body that is not there")?;
    let scene = Scene::try_new(scene.limits, parts).map_err(|error| error.to_string())?;
    begin(run, Box::leak(Box::new(scene)))
}

fn begin<S: Sighted + Sync>(run: &Run, surface: &'static S) -> Result<Box<dyn Replay>, String>
where
    S::Witness: Send,
{
    let device: &'static Device<Mechanism, 3> = Box::leak(Box::new(run.on.device));
    let safety = Safety { link_timeout_s: run.link_timeout, ..Safety::DEFAULT };
    let config = Config { settings: run.settings, rendering: run.rendering, safety, ..Config::DEFAULT };
    if let Some(protection) = run.on.protection {
        let servo = Servo::try_protected(device, surface, protection, config).map_err(|error| error.to_string())?;
        return started(surface, servo);
    }
    started(surface, Servo::try_new(device, surface, config).map_err(|error| error.to_string())?)
}

fn started<S: Sighted + Sync, G: Guard<3> + Send + 'static>(
    surface: &'static S,
    servo: Servo<'static, S, Mechanism, 3, G>,
) -> Result<Box<dyn Replay>, String>
where
    S::Witness: Send,
    G::State: Send,
{
    Ok(Box::new(Replayed { state: servo.start(), surface, servo, hash: 0 }))
}

// A device's own telemetry, frame by frame, as `palpate monitor` reads it.

/// The records received so far.
pub struct Monitor {
    receiver: Receiver<DeviceMessage>,
    /// Whether a frame has ended on the line: earlier bytes may be the rest of one.
    in_step: bool,
    /// Whole records.
    pub records: u32,
    /// Frames that are none.
    pub damaged: u32,
    last: Option<Record>,
    greeted: bool,
    answer: Option<Answer>,
    dial: Option<Dial>,
}

impl Monitor {
    /// Before the first byte.
    pub const fn new() -> Self {
        let receiver = Receiver::new();
        Self { receiver, in_step: false, records: 0, damaged: 0, last: None, greeted: false, answer: None, dial: None }
    }

    /// Takes bytes as they come.
    pub fn feed(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if !self.in_step {
                self.in_step = *byte == DELIMITER;
                continue;
            }
            match self.receiver.feed(*byte) {
                Some(Received::Message(DeviceMessage::Record(record))) => {
                    self.records += 1;
                    self.last = Some(record);
                }
                Some(Received::Message(DeviceMessage::Hello(_))) => self.greeted = true,
                Some(Received::Message(DeviceMessage::Answer(answer))) => self.answer = Some(answer),
                Some(Received::Message(DeviceMessage::Dial(dial))) => self.dial = Some(dial),
                Some(Received::Damaged) => self.damaged += 1,
                Some(Received::Empty | Received::Message(_)) | None => {}
            }
        }
    }

    /// The last words of a knob, see `exports.rs`; why it refused something.
    pub fn heard(&self, out: &mut Vec<f32>) -> String {
        let number = self.answer.map_or(-1.0, |answer| f32::from(answer.number));
        let refused = self.answer.and_then(|answer| answer.refused);
        out.clear();
        out.extend([f32::from(u8::from(self.greeted)), number, f32::from(u8::from(refused.is_some()))]);
        if let Some(Dial { angle, rate, torque, detent, end, .. }) = self.dial {
            out.extend([angle, rate, torque, detent as f32, f32::from(end)]);
        }
        refused.map_or_else(String::new, |refused| refused.to_string())
    }

    /// The last record: tick, phase, fault, mode, contact, feature, gap, probe, force, and what a tick took and its
    /// period at most, seconds. Nothing before the first.
    pub fn view(&self, out: &mut Vec<f32>) {
        out.clear();
        let Some(record) = &self.last else { return };
        let clock = record.clock.max(1) as f32;
        out.extend([
            record.tick as f32,
            f32::from(record.phase),
            f32::from(record.fault),
            f32::from(record.mode),
            f32::from(record.contact),
            f32::from(record.feature),
            record.gap,
        ]);
        out.extend(record.probe);
        out.extend(record.force);
        out.extend([record.took as f32 / clock, record.longest as f32 / clock]);
    }
}
