//! A simulated device on a bench, in which failures are planted.

use super::chip::{Chip, ChipFailures};
use super::{Change, Found, Setting};
use crate::devices::{Preset, ShippedDevice};
use palpate::body::{Body, TableCursor};
use palpate::commission::Wiring;
use palpate::device::{Counts, Device, Homing, Kinematics, ProbePose, Protection, Reference, SupplyRange};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::scene::Commanded;
use palpate::servo::{BakedTables, Config, Guard, PatchWitness, Phase, ResetReason, Safety, Servo, Surface, Touched};
use palpate::track::{Controller, Probe};
use palpate::wire::HostMessage;
use palpate_bench::Settings;
use palpate_sim::feel::wall;
use palpate_sim::magnetic::{SharedTable, Table};
use palpate_sim::plant::{Direction, HandPath, HandSettings, MechanismSettings, Plant, PlantSettings, Vector};
use palpate_sim::rig::{CLOCK, Made, RATE, Rig, World};
use palpate_sim::simulated::capped_box;
use std::cell::{Cell, RefMut};
use std::rc::Rc;

/// Ticks in a millisecond.
const TICKS_PER_MS: f64 = RATE / 1_000.0;
/// Ticks after which a failure counts as not detected, and with the check of tables, whose two passes take longer.
const PATIENCE: u32 = 12_000;
const PATIENCE_WITH_TABLES: u32 = 30_000;
/// Ticks for which a program that does not start is watched.
const NO_START: u32 = 2_000;
/// Ticks after the motors are off, in which a fault may follow a hold.
const AFTER: u32 = 400;
/// Steps of the plant in a tick: enough for a polarity check's pulses of 8 ms.
const SUB_STEPS: u32 = 8;
/// Depth of a hand that presses, m.
const PRESSED: f64 = 0.004;
/// Height of a hand in free air, m.
const FREE: f64 = 0.01;
/// How a hand holds the probe.
pub(super) const FIRM: HandSettings = HandSettings { stiffness: 2_000.0, damping: 20.0, mass: 0.0 };

/// A device in which failures are planted.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    device: &'static ShippedDevice,
}

/// The bench as a change sees and moves it before a tick.
pub struct Touch<'a> {
    /// Ticks since the start.
    pub tick: u32,
    /// The far side of the pins.
    pub world: RefMut<'a, World>,
    /// The magnetic sensors.
    pub magnets: Option<RefMut<'a, Table>>,
    /// Messages that the host sends.
    pub sends: Vec<HostMessage>,
    /// Set, it replaces a coordinate of every pose.
    pub poison: &'a Cell<Option<f32>>,
    /// The chip's failures.
    pub chip: &'a mut ChipFailures,
    /// Set, the first word of the capped box's tables has changed ([`Setting::Tabled`]).
    pub word_changes: bool,
    /// Contacts that were given up so far.
    pub lost: u32,
    /// Counts of the first joint in a tick at a fifth of the maximum rate.
    pub slow: i32,
    /// Whether with these that joint leaves its range.
    pub leaves_range: bool,
    /// Depth from which on a contact is given up, m.
    pub deepest: f64,
    /// The maximum force, N.
    pub max_force: f64,
    /// The axis of the wall's normal.
    axis: usize,
}

impl Touch<'_> {
    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        f64::from(self.tick) / RATE
    }

    /// From now on the hand aims at these heights over the wall, m, from one time, s, to the next.
    pub fn follow(&mut self, heights: &[[f64; 2]], slide: f64) {
        let path = Heights { since: self.world.plant.time(), axis: self.axis, heights: heights.to_vec(), slide };
        self.world.plant.follow(Box::new(path));
    }

    /// From now on the hand holds the probe like this.
    pub fn hold(&mut self, hand: HandSettings) {
        self.world.plant.hold(hand);
    }
}

/// A hand over a wall, straight from height to height; it slides to and fro along it.
struct Heights {
    since: f64,
    axis: usize,
    heights: Vec<[f64; 2]>,
    /// Amplitude, m; at 0.8 Hz, with a tremor of 0.3 mm at 8 Hz.
    slide: f64,
}

impl HandPath for Heights {
    fn target(&self, time: f64) -> Vector {
        let time = time - self.since;
        let next = self.heights.iter().position(|[at, _]| *at > time).unwrap_or(self.heights.len());
        let height = match (next.checked_sub(1).map(|last| self.heights[last]), self.heights.get(next)) {
            (Some([start, from]), Some([end, to])) => from + (to - from) * (time - start) / (end - start),
            (Some([_, height]), None) => height,
            (None, first) => first.map_or(0.0, |[_, height]| *height),
        };
        let mut target = [0.0; 3];
        target[self.axis] = height;
        if self.axis > 0 && self.slide > 0.0 {
            target[self.axis - 1] = self.slide * (5.0 * time).sin();
            // A hand trembles.
            target[self.axis] += 3e-4 * (50.0 * time).sin();
        }
        target
    }

    fn velocity(&self, time: f64) -> Vector {
        const STEP: f64 = 1e-5;
        let [before, after] = [time - STEP, time + STEP].map(|time| self.target(time));
        core::array::from_fn(|axis| (after[axis] - before[axis]) / (2.0 * STEP))
    }
}

/// A mechanism with a switch that makes its pose a number that is none.
#[derive(Debug)]
struct Poisoned<K>(K, Cell<Option<f32>>);

impl<K: Kinematics<JOINTS>, const JOINTS: usize> Kinematics<JOINTS> for Poisoned<K> {
    fn pose(&self, angles: [f32; JOINTS]) -> Option<ProbePose<JOINTS>> {
        self.held_pose(angles).map(|(pose, _)| pose)
    }

    fn held_pose(&self, angles: [f32; JOINTS]) -> Option<(ProbePose<JOINTS>, [f32; JOINTS])> {
        let (mut pose, weight) = self.0.held_pose(angles)?;
        if let Some(bad) = self.1.get() {
            pose.position.x = bad;
        }
        Some((pose, weight))
    }
}

/// The wall with the tables of the capped box, the first word of which may change, or for another rate.
#[derive(Debug)]
struct Tabled {
    wall: &'static SplinePatch<'static>,
    body: &'static Body<'static>,
    changed: Cell<bool>,
    is_for_any_rate: bool,
}

impl Surface for Tabled {
    type Witness = PatchWitness;

    fn rest(&self) -> PatchWitness {
        self.wall.rest()
    }

    fn is_for(&self, _: f32) -> bool {
        self.is_for_any_rate
    }

    fn follow(&self, controller: &Controller, witness: &mut PatchWitness, probe: Probe, period: f32) -> Touched {
        self.wall.follow(controller, witness, probe, period)
    }

    fn release(&self, witness: &mut PatchWitness) {
        self.wall.release(witness);
    }
}

impl BakedTables for Tabled {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        let changed = u32::from(self.changed.get() && cursor == TableCursor::default());
        self.body.table_word(cursor).map(|word| word ^ changed)
    }

    fn table_records(&self) -> u32 {
        self.body.table_records()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.body.baked_crc()
    }
}

impl Commanded for Tabled {}

fn length(vector: Vector) -> f64 {
    vector.iter().map(|axis| axis * axis).sum::<f64>().sqrt()
}

fn leaked<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

impl Subject {
    /// A device that ships, or one's own.
    pub const fn new(device: &'static ShippedDevice) -> Self {
        Self { device }
    }

    /// The number of its joints.
    pub fn joints(&self) -> usize {
        self.device.preset.feeds().len()
    }

    /// Whether it is a delta.
    pub const fn is_delta(&self) -> bool {
        matches!(self.device.plant.mechanism, MechanismSettings::Delta(_))
    }

    /// The effect of a failure; `None` where the device has no loop of that setting.
    pub fn plant(&self, setting: Setting, change: Change) -> Option<Found> {
        let protection = self.device.protection();
        match self.device.preset {
            Preset::SerialArm(device) => self.on(device, Some(protection), setting, change),
            Preset::LinkageArm(device) => self.on(device, Some(protection), setting, change),
            Preset::Delta(device) => self.on(device, Some(protection), setting, change),
            Preset::FiveBar(device) => self.on(device, None, setting, change),
            Preset::Paddle(device) => self.on(device, None, setting, change),
        }
    }

    fn on<K: Kinematics<JOINTS> + Copy + 'static, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
        protection: Option<Protection<JOINTS>>,
        setting: Setting,
        change: Change,
    ) -> Option<Found> {
        let Device {
            kinematics,
            encoders,
            motors,
            feeds,
            dry_friction_n_m,
            joint_range_rad,
            min_margin_m_per_rad,
            max_joint_rate_rad_per_s,
            max_force_n,
            max_stiffness_n_per_m,
            max_damping_n_s_per_m,
        } = *device;
        let device: &'static Device<Poisoned<K>, JOINTS> = leaked(Device {
            kinematics: Poisoned(kinematics, Cell::new(None)),
            encoders,
            motors,
            feeds,
            dry_friction_n_m,
            joint_range_rad,
            min_margin_m_per_rad,
            max_joint_rate_rad_per_s,
            max_force_n,
            max_stiffness_n_per_m,
            max_damping_n_s_per_m,
        });
        let recommended = self.device.recommended();
        let link_timeout_s = if setting == Setting::Linked { 0.05 } else { f32::INFINITY };
        // A wall that catches nothing that sinks.
        let mut body_origin_m = Vec3::ZERO;
        if setting == Setting::Heavier {
            body_origin_m.z = -0.5;
        }
        let config = Config {
            settings: palpate::servo::Settings { body_origin_m, ..recommended.settings },
            rendering: recommended.rendering,
            safety: Safety { link_timeout_s, ..Safety::DEFAULT },
            homing: None,
            ..Config::DEFAULT
        };
        let run = Run { setting, change, voltage: if device.needs_supply() { 12.0 } else { 24.0 }, joints: JOINTS };
        let surface = wall(JOINTS);
        match setting {
            Setting::Protected | Setting::ReversedMotor(_) | Setting::ReversedEncoder(_) | Setting::NoSupply => {
                let mut protection = protection?;
                if setting == Setting::NoSupply {
                    protection.supply = Some(SupplyRange::TWENTY_FOUR);
                }
                let servo = Servo::protected(device, surface, protection, config);
                Some(run.on(servo, &device.kinematics.1, self.plant_of(setting)))
            }
            Setting::Misplaced => {
                let counts = [Counts(40); JOINTS];
                let reference = Reference::KnownPose { angles: device.angles_at_zero(), counts, tolerance: 20 };
                let homing = Homing::try_new(device.encoders, reference, 40, 4, 4_000).ok()?.when_asked();
                let servo = Servo::new(device, surface, Config { homing: Some(homing), ..config });
                Some(run.on(servo, &device.kinematics.1, self.plant_of(setting)))
            }
            Setting::Tabled | Setting::OtherRate => {
                let is_for_any_rate = setting == Setting::Tabled;
                let (body, changed) = (capped_box().ok()?, Cell::new(false));
                let surface: &'static Tabled = leaked(Tabled { wall: surface, body, changed, is_for_any_rate });
                let servo = Servo::new(device, surface, config);
                Some(run.with(servo, &device.kinematics.1, Some(&surface.changed), self.plant_of(setting)))
            }
            _ => Some(run.on(Servo::new(device, surface, config), &device.kinematics.1, self.plant_of(setting))),
        }
    }

    fn plant_of(&self, setting: Setting) -> PlantSettings {
        let mut plant = self.device.plant.in_sub_steps(SUB_STEPS);
        let turn = |direction: &mut Direction| {
            *direction = if *direction == Direction::With { Direction::Against } else { Direction::With };
        };
        match setting {
            Setting::ReversedMotor(joint) => turn(&mut plant.joints[joint].motor_direction),
            Setting::ReversedEncoder(joint) => turn(&mut plant.joints[joint].encoder_direction),
            Setting::Heavier => plant.gravity *= 1.1,
            _ => {}
        }
        plant
    }
}

/// A run with a failure in it.
#[derive(Clone, Copy)]
struct Run {
    setting: Setting,
    change: Change,
    voltage: f32,
    joints: usize,
}

impl Run {
    fn on<K, G, const JOINTS: usize>(
        self,
        servo: Servo<'static, SplinePatch<'static>, K, JOINTS, G>,
        poison: &Cell<Option<f32>>,
        plant: PlantSettings,
    ) -> Found
    where
        K: Kinematics<JOINTS> + 'static,
        G: Guard<JOINTS> + 'static,
    {
        self.with(servo, poison, None, plant)
    }

    fn with<K, G, const JOINTS: usize, S>(
        self,
        servo: Servo<'static, S, K, JOINTS, G>,
        poison: &Cell<Option<f32>>,
        changed: Option<&Cell<bool>>,
        plant: PlantSettings,
    ) -> Found
    where
        K: Kinematics<JOINTS> + 'static,
        G: Guard<JOINTS> + 'static,
        S: Commanded + 'static,
    {
        let axis = self.joints - 1;
        let is_free = matches!(
            self.setting,
            Setting::Protected
                | Setting::Unprotected
                | Setting::ReversedMotor(_)
                | Setting::ReversedEncoder(_)
                | Setting::NoSupply
                | Setting::Heavier
                | Setting::NoStart
        );
        let is_heavier = self.setting == Setting::Heavier;
        let heights = if is_heavier {
            vec![[0.0; 2]]
        } else if is_free {
            vec![[0.0, FREE]]
        } else {
            vec![[0.0, FREE], [0.02, -PRESSED]]
        };
        let path = Box::new(Heights { since: 0.0, axis, heights, slide: 0.0 });
        let plant = Plant::new(&plant, FIRM, path, RATE).expect("a shipped device reaches its workspace's middle");
        let volts = 1e3 * self.voltage;
        let supply = SupplyRange { min_mv: (volts / 1.2) as u32, max_mv: (volts * 1.25) as u32 };
        let is_untested = self.setting == Setting::StopUntested;
        let board = Settings { supply: Some(supply), tests_stop: is_untested, ..Settings::new(CLOCK) };
        let reset = if let Setting::Reset(reason) = self.setting { reason } else { ResetReason::PowerOn };
        let made = Made(servo, self.setting == Setting::Miscalibrated, Wiring::STRAIGHT);
        let mut rig = Rig::made(made, plant, &board, reset);
        rig.set(|world| world.supply = self.voltage);
        let magnets = (self.setting == Setting::Magnetic).then(|| rig.with_magnetic_sensors());
        let mut chip = Chip::new(rig.mailbox);
        if self.setting == Setting::NoStart {
            chip.start_with_sticking_bits();
        }
        let before_force = matches!(
            self.setting,
            Setting::Reset(_)
                | Setting::StopUntested
                | Setting::Miscalibrated
                | Setting::Misplaced
                | Setting::OtherRate
                | Setting::NoSupply
                | Setting::NoStart
                | Setting::ReversedEncoder(_)
        );
        // The button is seen released, then pressed, for as long as a loop without the failure takes to give force.
        for (pressed, ticks) in [(false, 250), (true, if before_force { 0 } else { 800 })] {
            rig.set(|world| world.button = pressed);
            for tick in 0..ticks {
                if self.setting == Setting::Linked && tick % 40 == 0 {
                    rig.send(HostMessage::Alive);
                }
                chip.tick(&mut rig, &board);
            }
        }
        assert!(before_force || (rig.state().phase() == Phase::Running && !rig.is_off()), "{:?}", rig.fault());
        self.watch((&mut rig, &mut chip, &board), magnets.as_ref(), poison, changed)
    }

    fn watch<K, G, const JOINTS: usize, S>(
        self,
        (rig, chip, board): (&mut Rig<K, G, JOINTS, S>, &mut Chip, &Settings),
        magnets: Option<&SharedTable>,
        poison: &Cell<Option<f32>>,
        changed: Option<&Cell<bool>>,
    ) -> Found
    where
        K: Kinematics<JOINTS> + 'static,
        G: Guard<JOINTS> + 'static,
        S: Commanded + 'static,
    {
        let (servo, shared) = (rig.bench.felt().0, Rc::clone(&rig.world));
        let (settings, device) = (servo.config().settings, servo.device());
        let force = f64::from(settings.max_force_n.min(device.max_force_n));
        let per_tick = device.max_joint_rate_rad_per_s / RATE as f32 / device.encoders[0].radians_per_count.abs();
        let mut found = Found { off_ms: None, fault: None, motion_mm: 0.0, speed_m_per_s: 0.0 };
        let mut until = match self.setting {
            Setting::Tabled => PATIENCE_WITH_TABLES,
            Setting::NoStart => NO_START,
            _ => PATIENCE,
        };
        let mut driven = 0;
        let (mut since, mut start, mut longest) = (None, None, 0);
        let mut tick = 0;
        while tick < until {
            let lost = rig.state().contacts_lost();
            let world = shared.borrow_mut();
            let counts = world.plant.counts();
            let slow = ((0.2 * per_tick) as i32).max(1);
            let encoder = &device.encoders[0];
            let next = (counts[0] + world.turned[0] + slow) as f32 + 0.5;
            let next = next * encoder.radians_per_count + encoder.angle_at_zero_rad;
            let [least, most] = device.joint_range_rad[0];
            let mut failures = chip.failures;
            let mut touch = Touch {
                tick,
                world,
                magnets: magnets.map(|magnets| magnets.borrow_mut()),
                sends: Vec::new(),
                poison,
                chip: &mut failures,
                word_changes: false,
                lost,
                leaves_range: next < least || most < next,
                slow,
                deepest: (2.0 * force / f64::from(settings.stiffness_n_per_m)).max(0.01),
                max_force: force,
                axis: self.joints - 1,
            };
            let acts = (self.change)(&mut touch);
            let (sends, word_changes) = (std::mem::take(&mut touch.sends), touch.word_changes);
            drop(touch);
            chip.failures = failures;
            sends.into_iter().for_each(|message| rig.send(message));
            changed.inspect(|changed| changed.set(word_changes));
            let before = rig.world.borrow().plant.position();
            chip.tick(rig, board);
            tick += 1;
            driven += u32::from(!rig.is_off());
            (since, start) = if acts { (since.or(Some(tick - 1)), start) } else { (None, None) };
            if found.off_ms.is_some() {
                continue;
            }
            if since.is_none() && longest == 0 && rig.fault().is_some() {
                // A fault before the failure is none that it was found by.
                break;
            }
            let (now, velocity) = {
                let world = rig.world.borrow();
                (world.plant.position(), world.plant.velocity())
            };
            if let Some(since) = since {
                longest = longest.max(tick - since);
                let from: Vector = *start.get_or_insert(before);
                let moved = length(core::array::from_fn(|axis| now[axis] - from[axis]));
                found.motion_mm = found.motion_mm.max(1e3 * moved);
                found.speed_m_per_s = found.speed_m_per_s.max(length(velocity));
            }
            if self.setting != Setting::NoStart && rig.is_off() && longest > 0 {
                (found.off_ms, until) = (Some(f64::from(longest) / TICKS_PER_MS), tick + AFTER);
            }
        }
        if self.setting == Setting::NoStart {
            // Off from before the failure acts.
            found.off_ms = Some(f64::from(driven) / TICKS_PER_MS);
        }
        found.fault = rig.fault();
        found
    }
}
