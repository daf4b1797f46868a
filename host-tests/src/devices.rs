//! The devices by name: what the servo knows of each, and what stands in for it in simulation.

use crate::plant::PlantSettings;
use clap::ValueEnum;
use palpate::device::{Delta, Device, FiveBar, Kinematics, LinkageArm, Paddle, SerialArm, presets};

/// The presets by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceName {
    /// WoodenHaptics as published in 2016: three joints, serial
    #[value(name = "woodenhaptics-2016")]
    WoodenHaptics2016,
    /// Polhem, second version: three joints, a linkage on a turntable
    PolhemV2,
    /// Phantom Premium: three joints, serial
    PhantomPremium,
    /// Novint Falcon: three joints, a delta
    Falcon,
    /// Haply 2diy, third version: two joints
    #[value(name = "haply-2diy-v3")]
    Haply2diyV3,
    /// Haply development kit, first version: two joints
    HaplyKitV1,
    /// Hapkit: one joint
    Hapkit,
}

/// What the servo knows of a device, by its mechanism. Only who matches on it need know that there are several; from there on
/// the loop is generic, on the host as on the target.
#[derive(Clone, Copy, Debug)]
pub enum Preset {
    /// Three joints, serial.
    SerialArm(&'static Device<SerialArm, 3>),
    /// Three joints, a linkage on a turntable.
    LinkageArm(&'static Device<LinkageArm, 3>),
    /// Three joints, a delta.
    Delta(&'static Device<Delta, 3>),
    /// Two joints.
    FiveBar(&'static Device<FiveBar, 2>),
    /// One joint.
    Paddle(&'static Device<Paddle, 1>),
}

impl DeviceName {
    /// Every device.
    pub const ALL: [Self; 7] = [
        Self::WoodenHaptics2016,
        Self::PolhemV2,
        Self::PhantomPremium,
        Self::Falcon,
        Self::Haply2diyV3,
        Self::HaplyKitV1,
        Self::Hapkit,
    ];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::WoodenHaptics2016 => "woodenhaptics-2016",
            Self::PolhemV2 => "polhem-v2",
            Self::PhantomPremium => "phantom-premium",
            Self::Falcon => "falcon",
            Self::Haply2diyV3 => "haply-2diy-v3",
            Self::HaplyKitV1 => "haply-kit-v1",
            Self::Hapkit => "hapkit",
        }
    }

    /// What the servo knows of the device.
    pub fn preset(self) -> Preset {
        match self {
            Self::WoodenHaptics2016 => Preset::SerialArm(&presets::WOODEN_HAPTICS_2016),
            Self::PolhemV2 => Preset::LinkageArm(&presets::POLHEM_V2),
            Self::PhantomPremium => Preset::SerialArm(&presets::PHANTOM_PREMIUM),
            Self::Falcon => Preset::Delta(&presets::NOVINT_FALCON),
            Self::Haply2diyV3 => Preset::FiveBar(&presets::HAPLY_2DIY_V3),
            Self::HaplyKitV1 => Preset::FiveBar(&presets::HAPLY_KIT_V1),
            Self::Hapkit => Preset::Paddle(&presets::HAPKIT),
        }
    }

    /// The simulated device.
    pub const fn plant(self) -> PlantSettings {
        match self {
            Self::WoodenHaptics2016 => PlantSettings::wooden_haptics_2016(),
            Self::PolhemV2 => PlantSettings::polhem_v2(),
            Self::PhantomPremium => PlantSettings::phantom_premium(),
            Self::Falcon => PlantSettings::novint_falcon(),
            Self::Haply2diyV3 => PlantSettings::haply_2diy_v3(),
            Self::HaplyKitV1 => PlantSettings::haply_kit_v1(),
            Self::Hapkit => PlantSettings::hapkit(),
        }
    }

    /// What of the simulated device's inertia and friction no source states; the plant's settings say it number by number.
    pub const fn assumed(self) -> &'static str {
        match self {
            Self::WoodenHaptics2016 => "turntable, rotors and friction are assumed; the links' masses are published",
            Self::PolhemV2 => "turntable, rotors and friction are assumed; the links' masses are published",
            Self::PhantomPremium => "encoder counts are assumed; inertia and friction are published",
            Self::Falcon => "all masses are assumed; friction is of the published size",
            Self::Haply2diyV3 | Self::HaplyKitV1 | Self::Hapkit => "all masses, friction and windings are assumed",
        }
    }

    /// Where the palpate library has the preset: its mechanism's type and its constant, in a source file for an image. None
    /// with less than three joints.
    pub const fn source(self) -> Option<[&'static str; 2]> {
        match self {
            Self::WoodenHaptics2016 => Some(["SerialArm", "WOODEN_HAPTICS_2016"]),
            Self::PolhemV2 => Some(["LinkageArm", "POLHEM_V2"]),
            Self::PhantomPremium => Some(["SerialArm", "PHANTOM_PREMIUM"]),
            Self::Falcon => Some(["Delta", "NOVINT_FALCON"]),
            Self::Haply2diyV3 | Self::HaplyKitV1 | Self::Hapkit => None,
        }
    }
}

/// What a device is to be asked for at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// N.
    pub force: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
}

impl Limits {
    fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>) -> Self {
        Self { force: device.greatest_force, stiffness: device.greatest_stiffness, damping: device.greatest_damping }
    }
}

impl Preset {
    /// The device's limits.
    pub fn limits(self) -> Limits {
        match self {
            Self::SerialArm(device) => Limits::of(device),
            Self::LinkageArm(device) => Limits::of(device),
            Self::Delta(device) => Limits::of(device),
            Self::FiveBar(device) => Limits::of(device),
            Self::Paddle(device) => Limits::of(device),
        }
    }

    /// How much room there is to the rim of the workspace at these joint angles, rad: 1 well inside, 0 on it.
    pub fn room(self, angles: [f64; 3]) -> f32 {
        fn of<K: Kinematics<JOINTS>, const JOINTS: usize>(device: &Device<K, JOINTS>, angles: [f64; 3]) -> f32 {
            let angles = core::array::from_fn(|joint| angles[joint] as f32);
            device.room(&angles, &device.kinematics.pose(angles))
        }
        match self {
            Self::SerialArm(device) => of(device, angles),
            Self::LinkageArm(device) => of(device, angles),
            Self::Delta(device) => of(device, angles),
            Self::FiveBar(device) => of(device, angles),
            Self::Paddle(device) => of(device, angles),
        }
    }

    /// How each motor is fed.
    pub fn feeds(self) -> &'static [palpate::device::drive::Feed] {
        match self {
            Self::SerialArm(device) => &device.feeds,
            Self::LinkageArm(device) => &device.feeds,
            Self::Delta(device) => &device.feeds,
            Self::FiveBar(device) => &device.feeds,
            Self::Paddle(device) => &device.feeds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_told_apart_and_stands_for_a_device_of_as_many_joints_as_its_plant() {
        for (index, device) in DeviceName::ALL.into_iter().enumerate() {
            assert_eq!(DeviceName::from_str(device.name(), false), Ok(device));
            let joints = device.preset().feeds().len();
            assert_eq!(joints, device.plant().mechanism(0.0).joints(), "{device:?}");
            assert_eq!(device.source().is_some(), joints == 3, "{device:?}");
            assert!(!DeviceName::ALL[..index].contains(&device));
        }
        assert_eq!(DeviceName::ALL.len(), DeviceName::value_variants().len());
    }
}
