//! The device in the reader's hand, and that hand: three slides for the mouse, or a device of a device file.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::device::drive::Feed;
use palpate::device::{Counts, Device, Encoder, Kinematics, Motor, ProbePose};
use palpate::math::Vec3;
use palpate::servo::recommended::Recommended;
use palpate_sim::devices::{OwnDevice, Preset};
use palpate_sim::recorded::{Mechanism, with_mechanism};

/// The mechanism of the held device.
#[derive(Clone, Copy, Debug)]
pub enum HeldMechanism {
    /// Three slides at right angles: a joint angle of a radian is a metre.
    Slides,
    /// A device of a device file.
    Arm(Mechanism),
}

impl Kinematics<3> for HeldMechanism {
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        match self {
            Self::Slides => {
                let jacobian = [Vec3::X, Vec3::Y, Vec3::Z];
                Some(ProbePose { position: Vec3::from_array(angles), jacobian })
            }
            Self::Arm(mechanism) => mechanism.pose(angles),
        }
    }

    fn held_pose(&self, angles: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
        match self {
            Self::Slides => self.pose(angles).map(|pose| (pose, [0.0; 3])),
            Self::Arm(mechanism) => mechanism.held_pose(angles),
        }
    }
}

/// The device type of the page's loop.
pub type HeldDevice = Device<HeldMechanism, 3>;

/// A device, and where its joints are.
#[derive(Clone, Debug)]
pub struct Held {
    /// As the loop takes it.
    pub device: &'static HeldDevice,
    /// Recommended settings; `None` for the slides.
    pub recommended: Option<Recommended>,
    /// Its name; empty for the slides.
    pub name: String,
    /// Joint angles, rad.
    angles: [f32; 3],
    /// Those with the probe in the centre of the workspace.
    home: [f32; 3],
}

/// Maximum force of the slides' motors, N.
const SLIDES_FORCE: f32 = 20.0;
/// Newton steps of one motion, and how often one that leaves the workspace is halved.
const STEPS: u32 = 8;
const HALVINGS: u32 = 6;
/// A probe that is nearer has arrived, m: roundings of a metre.
const ARRIVED: f32 = 2e-7;
/// The workspace margin at which the hand meets the device's end.
const LEAST_MARGIN: f32 = 0.05;
/// How far the loop lets a joint move in a tick, of the maximum.
const OF_RATE: f32 = 0.8;
/// Poses a joint among which the one nearest to the workspace's centre is sought.
const POSES: usize = 9;
/// Step of the search for the ends of the workspace, m, and its limit.
const STEP_OUT: f32 = 2e-3;
const FARTHEST: f32 = 0.8;

impl Held {
    /// The slides for a body of this size, metres. An encoder resolves the 2⁻¹⁸th part of the size: a quarter of a
    /// micrometre of 6 cm.
    pub fn slides(size: f32) -> Self {
        let reach = 16.0 * size;
        let device = Device {
            kinematics: HeldMechanism::Slides,
            // The pose at count zero is exact: there is no line to be in the middle of.
            encoders: [Encoder { radians_per_count: size / 262_144.0, angle_at_zero_rad: 0.0 }; 3],
            motors: [Motor { torque_at_full_n_m: SLIDES_FORCE }; 3],
            feeds: [Feed::Current; 3],
            dry_friction_n_m: [0.0; 3],
            // The rim of 0.05 is one of radians: the slides have none.
            joint_range_rad: [[-reach - 1.0, reach + 1.0]; 3],
            min_margin_m_per_rad: 0.01,
            // A mouse jumps.
            max_joint_rate_rad_per_s: f32::MAX,
            max_force_n: SLIDES_FORCE,
            max_stiffness_n_per_m: 10_000.0,
            max_damping_n_s_per_m: 50.0,
        };
        let device: &'static _ = Box::leak(Box::new(device));
        Self { device, recommended: None, name: String::new(), angles: [0.0; 3], home: [0.0; 3] }
    }

    /// A device from the text of its file, which messages call `label`.
    ///
    /// # Errors
    /// The file's first fault, as the tool words it.
    pub fn of_file(text: &str, label: &str) -> Result<Self, String> {
        let own = OwnDevice::parse(text, label).map_err(|error| error.to_string())?;
        let device = match own.preset {
            Preset::SerialArm(device) => with_mechanism(device, HeldMechanism::Arm(device.kinematics.into())),
            Preset::LinkageArm(device) => with_mechanism(device, HeldMechanism::Arm(device.kinematics.into())),
            Preset::Delta(device) => with_mechanism(device, HeldMechanism::Arm(device.kinematics.into())),
            Preset::FiveBar(_) | Preset::Paddle(_) => return Err(alloc::format!("{label}: joint: three are needed")),
        };
        let device: &'static _ = Box::leak(Box::new(device));
        let recommended = Some(own.preset.recommended());
        let mut held = Self { device, recommended, name: own.file.name, angles: [0.0; 3], home: [0.0; 3] };
        held.angles = held.nearest_pose();
        if held.reach(Vec3::ZERO, f32::INFINITY).length() > ARRIVED * 10.0 {
            let reason = "is out of the mechanism's reach, or of the joints' ranges";
            let entry = own.file.mechanism.centre();
            return Err(alloc::format!("{label}: {entry}: {reason}: change it, or `joint.range`"));
        }
        held.home = held.angles;
        Ok(held)
    }

    /// Moves the probe towards a place until it is there, leaves the workspace, or a joint has moved by `most`, rad;
    /// where it is then, metres.
    pub fn reach(&mut self, place: Vec3, most: f32) -> Vec3 {
        if matches!(self.device.kinematics, HeldMechanism::Slides) {
            self.angles = place.to_array();
            return place;
        }
        let (mut left, mut at) = (most, self.place());
        for _ in 0..STEPS {
            let Some(pose) = self.device.kinematics.pose(self.angles) else { break };
            at = pose.position;
            let away = place - at;
            if away.length() < ARRIVED || left <= 0.0 {
                break;
            }
            let [a, b, c] = pose.jacobian;
            let across = [b.cross(c), c.cross(a), a.cross(b)];
            let step = across.map(|across| across.dot(away) / a.dot(b.cross(c)));
            let largest = step.iter().fold(0.0_f32, |largest, step| largest.max(step.abs()));
            let mut part = if largest > left { left / largest } else { 1.0 };
            let moved = |part: f32| core::array::from_fn(|joint| self.angles[joint] + part * step[joint]);
            let mut next: [f32; 3] = moved(part);
            for _ in 0..HALVINGS {
                if self.is_inside(next) {
                    break;
                }
                part *= 0.5;
                next = moved(part);
            }
            if !self.is_inside(next) {
                break;
            }
            self.angles = next;
            left -= part * largest;
            at = self.place();
        }
        at
    }

    /// From the workspace's centre to a place, or as far as the workspace goes.
    pub fn restart(&mut self, place: Vec3) -> Vec3 {
        self.angles = self.home;
        let steps = (place.length() / STEP_OUT) as u32 + 1;
        let mut at = Vec3::ZERO;
        for step in 1..=steps {
            at = self.reach(place * (step as f32 / steps as f32), f32::INFINITY);
        }
        at
    }

    /// How far joints may move in a tick of some seconds, rad.
    pub fn most_in(&self, period: f32) -> f32 {
        OF_RATE * period * self.device.max_joint_rate_rad_per_s
    }

    /// The counts of its encoders.
    pub fn counts(&self) -> [Counts; 3] {
        core::array::from_fn(|joint| {
            let Encoder { radians_per_count, angle_at_zero_rad } = self.device.encoders[joint];
            let count = (self.angles[joint] - angle_at_zero_rad) / radians_per_count;
            // The cast truncates.
            Counts((count + if count < 0.0 { -0.5 } else { 0.5 }) as i32)
        })
    }

    /// For a reader: maximum force and stiffness; how far a count moves the probe at most in the workspace's centre; and
    /// how far the workspace goes from there to both sides along x, y and z. SI units. Nothing for the slides.
    pub fn describe(&self, out: &mut Vec<f32>) {
        if self.recommended.is_none() {
            return;
        }
        out.extend([self.device.max_force_n, self.device.max_stiffness_n_per_m]);
        let jacobian = self.device.kinematics.pose(self.home).map_or([Vec3::ZERO; 3], |pose| pose.jacobian);
        let counts = jacobian.iter().zip(&self.device.encoders);
        let counts = counts.map(|(column, encoder)| column.length() * encoder.radians_per_count.abs());
        out.push(counts.fold(0.0, f32::max));
        let mut probe = self.clone();
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            out.extend([-axis, axis].map(|way| probe.extent(way)));
        }
    }

    /// How far the workspace goes from its centre, m.
    fn extent(&mut self, way: Vec3) -> f32 {
        self.angles = self.home;
        let mut far = 0.0;
        while far < FARTHEST {
            let place = way * (far + STEP_OUT);
            if (self.reach(place, f32::INFINITY) - place).length() > ARRIVED * 10.0 {
                break;
            }
            far += STEP_OUT;
        }
        far
    }

    /// Whether the joints may be there; at the very end of a range a rounded count would lie outside.
    fn is_inside(&self, angles: [f32; 3]) -> bool {
        let margin = |pose: ProbePose<3>| self.device.workspace_margin(self.device.to_stop(&angles), &pose);
        self.device.kinematics.pose(angles).is_some_and(|pose| margin(pose) > LEAST_MARGIN)
    }

    fn place(&self) -> Vec3 {
        self.device.kinematics.pose(self.angles).map_or(Vec3::ZERO, |pose| pose.position)
    }

    /// Of evenly spaced poses the one that has the probe nearest to the workspace's centre.
    fn nearest_pose(&self) -> [f32; 3] {
        let mut best = ([0.0; 3], f32::INFINITY);
        for index in 0..POSES * POSES * POSES {
            let parts = [index % POSES, index / POSES % POSES, index / POSES / POSES];
            let angles = core::array::from_fn(|joint| {
                let [least, most] = self.device.joint_range_rad[joint];
                least + (most - least) * (parts[joint] as f32 + 0.5) / POSES as f32
            });
            let far = self.device.kinematics.pose(angles).map(|pose| pose.position.length());
            if let Some(far) = far.filter(|far| *far < best.1 && self.is_inside(angles)) {
                best = (angles, far);
            }
        }
        best.0
    }
}

// The hand that holds the device: it wants to be where the pointer is, and the device pushes back.

/// How a hand holds a handle.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    /// Mass of hand and handle, kg.
    pub mass: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
}

impl Grip {
    /// A light grip: 50 g, pulled to the pointer by 400 N/m and critically damped, `2 √(k m)`.
    pub const LIGHT: Self = Self { mass: 0.05, stiffness: 400.0, damping: 8.944_272 };
}

/// Where the handle is, and how fast.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hand {
    /// Metres.
    pub position: Vec3,
    /// m/s.
    pub velocity: Vec3,
}

/// A place that is farther from where the hand went is where a stop holds it, m.
const STOPPED: f32 = 1e-5;
/// The longest step of the integration, s.
const STEP: f32 = 1.25e-4;

impl Hand {
    /// Moves on by a period, s, towards a place that itself moves on to `to`, under the device's force, N, which it
    /// holds for so long. Semi-implicit Euler.
    pub fn advance(&mut self, grip: &Grip, [from, to]: [Vec3; 2], force: Vec3, period: f32) {
        let steps = (period / STEP) as u32 + 1;
        let step = period / steps as f32;
        let wanted = (to - from) / period;
        for index in 0..steps {
            let place = from + (to - from) * ((index + 1) as f32 / steps as f32);
            let pull = (place - self.position) * grip.stiffness + (wanted - self.velocity) * grip.damping;
            self.velocity += (pull + force) * (step / grip.mass);
            self.position += self.velocity * step;
        }
    }

    /// Stands where the device has stopped it, if it has.
    pub fn stop_at(&mut self, place: Vec3) {
        if (place - self.position).length() > STOPPED {
            *self = Self { position: place, velocity: Vec3::ZERO };
        }
    }
}
