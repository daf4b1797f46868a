//! The devices that ship, one row each: what the servo knows of it, and what stands in for it in simulation.

use super::preset::Preset;
use super::{DeviceFile, OwnDevice, file_of, protection_of};
use crate::plant::PlantSettings;
use palpate::device::{Protection, presets};
use palpate::servo::recommended::{self, Recommended};

/// A device that ships.
#[derive(Clone, Copy, Debug)]
pub struct ShippedDevice {
    /// The name on the command line.
    pub name: &'static str,
    /// Its full name and its kind of mechanism.
    pub about: &'static str,
    /// The servo's description of it.
    pub preset: Preset,
    /// The simulated device.
    pub plant: PlantSettings,
    /// Inertia and friction of the simulated device that are assumed because no source states them; the plant's
    /// settings name them number by number.
    pub assumed: &'static str,
    /// Path of the preset in the palpate library: its mechanism's type and its constant, for the source file of an
    /// image. `None` with less than three joints.
    pub source: Option<[&'static str; 2]>,
    /// Source of the constants, protection and names of the joints of the user's own device; `None` for a shipped one.
    pub constants: Option<(&'static str, Protection<3>, [&'static str; 3])>,
}

impl ShippedDevice {
    /// Its device file, a starting point for the user's own; `None` with less than three joints.
    pub fn file(&self) -> Option<DeviceFile> {
        file_of(self.name, self.preset, &self.plant)
    }

    /// The names of its joints.
    pub fn joint_names(&self) -> [&'static str; 3] {
        self.constants.map_or(["a", "b", "c"], |(.., names)| names)
    }

    /// Recommended settings: the hand feels the surface and not the loop.
    pub fn recommended(&self) -> Recommended {
        match self.name {
            // One's own is what its firmware takes it for, whatever it is called.
            _ if self.constants.is_some() => self.preset.recommended(),
            "woodenhaptics-2016" => recommended::WOODEN_HAPTICS_2016,
            "polhem-v2" => recommended::POLHEM_V2,
            "phantom-premium" => recommended::PHANTOM_PREMIUM,
            "falcon" => recommended::NOVINT_FALCON,
            "haply-2diy-v3" => recommended::HAPLY_2DIY_V3,
            "haply-kit-v1" => recommended::HAPLY_KIT_V1,
            "hapkit" => recommended::HAPKIT,
            _ => self.preset.recommended(),
        }
    }

    /// Its protection.
    pub fn protection(&self) -> Protection<3> {
        self.constants.map_or_else(|| protection_of(self.name), |(_, protection, _)| protection)
    }
}

/// Every device that ships. A new one is a row here, a preset of the library and settings of the plant.
pub static DEVICES: [ShippedDevice; 7] = [
    ShippedDevice {
        name: "woodenhaptics-2016",
        about: "WoodenHaptics as published in 2016: three joints, serial",
        preset: Preset::SerialArm(&presets::WOODEN_HAPTICS_2016),
        plant: PlantSettings::wooden_haptics_2016(),
        assumed: "turntable, rotors and friction are assumed; the links' masses are published",
        source: Some(["SerialArm", "WOODEN_HAPTICS_2016"]),
        constants: None,
    },
    ShippedDevice {
        name: "polhem-v2",
        about: "Polhem, second version: three joints, a linkage on a turntable",
        preset: Preset::LinkageArm(&presets::POLHEM_V2),
        plant: PlantSettings::polhem_v2(),
        assumed: "turntable, rotors and friction are assumed; the links' masses are published",
        source: Some(["LinkageArm", "POLHEM_V2"]),
        constants: None,
    },
    ShippedDevice {
        name: "phantom-premium",
        about: "Phantom Premium: three joints, serial",
        preset: Preset::SerialArm(&presets::PHANTOM_PREMIUM),
        plant: PlantSettings::phantom_premium(),
        assumed: "encoder counts are assumed; inertia and friction are published",
        source: Some(["SerialArm", "PHANTOM_PREMIUM"]),
        constants: None,
    },
    ShippedDevice {
        name: "falcon",
        about: "Novint Falcon: three joints, a delta",
        preset: Preset::Delta(&presets::NOVINT_FALCON),
        plant: PlantSettings::novint_falcon(),
        assumed: "all masses are assumed; friction is of the published size",
        source: Some(["Delta", "NOVINT_FALCON"]),
        constants: None,
    },
    ShippedDevice {
        name: "haply-2diy-v3",
        about: "Haply 2diy, third version: two joints",
        preset: Preset::FiveBar(&presets::HAPLY_2DIY_V3),
        plant: PlantSettings::haply_2diy_v3(),
        assumed: "all masses, friction and windings are assumed",
        source: None,
        constants: None,
    },
    ShippedDevice {
        name: "haply-kit-v1",
        about: "Haply development kit, first version: two joints",
        preset: Preset::FiveBar(&presets::HAPLY_KIT_V1),
        plant: PlantSettings::haply_kit_v1(),
        assumed: "all masses, friction and windings are assumed",
        source: None,
        constants: None,
    },
    ShippedDevice {
        name: "hapkit",
        about: "Hapkit: one joint",
        preset: Preset::Paddle(&presets::HAPKIT),
        plant: PlantSettings::hapkit(),
        assumed: "all masses, friction and windings are assumed",
        source: None,
        constants: None,
    },
];

/// The device of this name.
pub fn named(name: &str) -> Option<&'static ShippedDevice> {
    DEVICES.iter().find(|device| device.name == name)
}

/// One's own device as a row of the table; it lives as long as the program.
pub fn own_device(own: &OwnDevice, from: &str) -> &'static ShippedDevice {
    let mechanism = match own.preset {
        Preset::LinkageArm(_) => "LinkageArm",
        Preset::Delta(_) => "Delta",
        _ => "SerialArm",
    };
    let leaked = |text: String| -> &'static str { Box::leak(text.into_boxed_str()) };
    let names = core::array::from_fn(|joint| leaked(own.file.joint[joint].name.clone()));
    Box::leak(Box::new(ShippedDevice {
        name: leaked(own.file.name.clone()),
        about: "one's own",
        preset: own.preset,
        plant: own.plant,
        assumed: leaked(super::plant::remark(own)),
        source: Some([mechanism, "DEVICE"]),
        constants: Some((leaked(super::source(own, from)), own.protection, names)),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_told_apart_and_stands_for_a_device_of_as_many_joints_as_its_plant() {
        for (index, device) in DEVICES.iter().enumerate() {
            let found = DEVICES.iter().position(|other| other.name == device.name);
            assert_eq!(found, Some(index), "{device:?}");
            let joints = device.preset.feeds().len();
            assert_eq!(joints, device.plant.mechanism(0.0).joints(), "{device:?}");
            assert_eq!(device.source.is_some(), joints == 3, "{device:?}");
        }
    }
}
