//! A preset and its plant side by side, whatever the number of joints.

use palpate::device::drive::Supply;
use palpate::device::presets::{
    HAPKIT, HAPLY_2DIY_V3, HAPLY_KIT_V1, NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2, WOODEN_HAPTICS_2016,
};
use palpate::device::{Counts, Device, Duty, Kinematics};
use palpate::math::{Vec3, vec3};
use palpate_sim::plant::{Mechanism, PlantSettings};

pub type Triple = [f64; 3];

/// The library's pose, widened.
pub struct Pose {
    pub position: Triple,
    /// Columns of joints that are not there are zero.
    pub columns: [Triple; 3],
    pub margin: f64,
}

/// What the library makes of a tick.
pub struct Tick {
    pub angles: [f32; 3],
    pub position: Vec3,
}

/// Joint angles, joint rates, force at the probe to what the drives are told.
pub type DriveMap = Box<dyn Fn([f32; 3], [f32; 3], Vec3) -> [i16; 3]>;

pub struct Case {
    pub name: &'static str,
    pub joints: usize,
    pub plant: PlantSettings,
    /// Half the size of the workspace that is tested, m: a ball, a disc or a stretch about its centre.
    pub radius: f64,
    /// `None` where the mechanism cannot be closed.
    pub pose: Box<dyn Fn([f32; 3]) -> Option<Pose>>,
    pub holding: Box<dyn Fn([f32; 3]) -> Triple>,
    pub in_workspace: Box<dyn Fn([f32; 3]) -> bool>,
    pub sense: Box<dyn Fn([i32; 3]) -> Tick>,
    /// From joint angles, joint rates and a force to what the drives are told.
    pub drive: DriveMap,
    pub counts_per_radian: Triple,
}

fn widen(vector: Vec3) -> Triple {
    [f64::from(vector.x), f64::from(vector.y), f64::from(vector.z)]
}

/// The first entries of three, as many as there are joints.
fn few<T: Copy, const JOINTS: usize>(all: [T; 3]) -> [T; JOINTS] {
    core::array::from_fn(|joint| all[joint])
}

/// Three entries, those of joints that are not there filled up.
fn fill<T: Copy, const JOINTS: usize>(some: [T; JOINTS], with: T) -> [T; 3] {
    core::array::from_fn(|joint| some.get(joint).copied().unwrap_or(with))
}

fn case<K: Kinematics<JOINTS> + Copy + 'static, const JOINTS: usize>(
    name: &'static str,
    device: Device<K, JOINTS>,
    plant: PlantSettings,
    radius: f64,
) -> Case {
    let map = device.kinematics;
    Case {
        name,
        joints: JOINTS,
        plant,
        radius,
        pose: Box::new(move |angles| {
            map.pose(few(angles)).map(|pose| Pose {
                position: widen(pose.position),
                columns: fill(pose.jacobian.map(widen), [0.0; 3]),
                margin: f64::from(pose.singularity_margin()),
            })
        }),
        holding: Box::new(move |angles| fill(map.holding_torques(few(angles)).map(f64::from), 0.0)),
        in_workspace: Box::new(move |angles| device.in_workspace(few(angles))),
        sense: Box::new(move |counts| {
            let angles: [f32; JOINTS] =
                core::array::from_fn(|joint| device.encoders[joint].angle(Counts(counts[joint])));
            Tick { angles: fill(angles, 0.0), position: map.pose(angles).unwrap().position }
        }),
        drive: Box::new(move |angles, rates, force| {
            let torques = map.pose(few(angles)).unwrap().torques(force);
            let duties =
                core::array::from_fn(|joint| Duty::from_fraction(device.motors[joint].fraction(torques[joint])));
            fill(device.feed(true, duties, few(rates), Supply::UNMEASURED).map(|duty| duty.0), 0)
        }),
        counts_per_radian: fill(device.encoders.map(|encoder| 1.0 / f64::from(encoder.radians_per_count)), 1.0),
    }
}

/// Every preset, with the part of its workspace that its sources speak of, or half of it.
pub fn cases() -> Vec<Case> {
    vec![
        case("WoodenHaptics 2016", WOODEN_HAPTICS_2016, PlantSettings::wooden_haptics_2016(), 0.1),
        case("Polhem v2", POLHEM_V2, PlantSettings::polhem_v2(), 0.08),
        case("Phantom Premium", PHANTOM_PREMIUM, PlantSettings::phantom_premium(), 0.08),
        case("Hapkit", HAPKIT, PlantSettings::hapkit(), 0.045),
        case("Haply 2diy v3", HAPLY_2DIY_V3, PlantSettings::haply_2diy_v3(), 0.03),
        case("Haply kit v1", HAPLY_KIT_V1, PlantSettings::haply_kit_v1(), 0.025),
        case("Novint Falcon", NOVINT_FALCON, PlantSettings::novint_falcon(), 0.05),
    ]
}

pub fn distance(a: Triple, b: Triple) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}

impl Case {
    pub fn mechanism(&self) -> Box<dyn Mechanism> {
        self.plant.mechanism(0.0)
    }

    /// Joint angles over the workspace as f32, and the very same as f64.
    pub fn workspace(&self) -> Vec<([f32; 3], Triple)> {
        let mechanism = self.mechanism();
        let steps: usize = [21, 21, 11][self.joints - 1];
        let share = |index: usize| 2.0 * index as f64 / (steps - 1) as f64 - 1.0;
        let mut found = Vec::new();
        for n in 0..steps.pow(self.joints as u32) {
            let index = [n % steps, n / steps % steps, n / steps / steps];
            let place: Triple =
                core::array::from_fn(|axis| if axis < self.joints { self.radius * share(index[axis]) } else { 0.0 });
            if distance(place, [0.0; 3]) > self.radius * 1.000_001 {
                continue;
            }
            let angles = mechanism.angles(place).expect("the workspace is within reach").map(|angle| angle as f32);
            found.push((angles, angles.map(f64::from)));
        }
        found
    }

    /// A unit force in as many dimensions as there are joints.
    pub fn force(&self) -> Triple {
        [[1.0, 0.0, 0.0], [0.6, -0.8, 0.0], [0.48, -0.64, 0.6]][self.joints - 1]
    }
}

pub fn narrow([x, y, z]: Triple) -> Vec3 {
    vec3(x as f32, y as f32, z as f32)
}
