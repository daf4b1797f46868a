//! The devices that are protected, and what stands in for them.

use palpate::device::presets::{
    NOVINT_FALCON, NOVINT_FALCON_PROTECTION, PHANTOM_PREMIUM, PHANTOM_PREMIUM_PROTECTION, POLHEM_V2,
    POLHEM_V2_PROTECTION, WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION,
};
use palpate::device::{Delta, Device, LinkageArm, Protection, SerialArm};
use palpate::math::Vec3;
use palpate::servo::Settings;
use palpate_sim::plant::{PlantSettings, ThermalSettings};

pub const RATE: f64 = 4_000.0;

/// A device of three joints, what protects it, and what stands in for it.
pub struct Bench<K: 'static> {
    pub name: &'static str,
    pub device: &'static Device<K, 3>,
    pub protection: Protection<3>,
    pub plant: PlantSettings,
    pub heat: [ThermalSettings; 3],
}

pub const WOODEN_HAPTICS: Bench<SerialArm> = Bench {
    name: "WoodenHaptics 2016",
    device: &WOODEN_HAPTICS_2016,
    protection: WOODEN_HAPTICS_2016_PROTECTION,
    plant: PlantSettings::wooden_haptics_2016(),
    heat: PlantSettings::WOODEN_HAPTICS_HEAT,
};

pub const POLHEM: Bench<LinkageArm> = Bench {
    name: "Polhem v2",
    device: &POLHEM_V2,
    protection: POLHEM_V2_PROTECTION,
    plant: PlantSettings::polhem_v2(),
    heat: PlantSettings::POLHEM_HEAT,
};

pub const PHANTOM: Bench<SerialArm> = Bench {
    name: "Phantom Premium",
    device: &PHANTOM_PREMIUM,
    protection: PHANTOM_PREMIUM_PROTECTION,
    plant: PlantSettings::phantom_premium(),
    heat: PlantSettings::PHANTOM_HEAT,
};

pub const FALCON: Bench<Delta> = Bench {
    name: "Novint Falcon",
    device: &NOVINT_FALCON,
    protection: NOVINT_FALCON_PROTECTION,
    plant: PlantSettings::novint_falcon(),
    heat: PlantSettings::FALCON_HEAT,
};

/// The gains that the preset recommends at most.
pub fn settings<K>(device: &Device<K, 3>, body_origin: Vec3) -> Settings {
    Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: device.max_stiffness_n_per_m,
        damping_n_s_per_m: device.max_damping_n_s_per_m,
        max_force_n: device.max_force_n,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.1,
        body_origin_m: body_origin,
    }
}
