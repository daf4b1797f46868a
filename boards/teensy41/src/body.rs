//! Device, settings and body of this board: the file to change first. The build chooses the body (`--body`).

use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Device, Encoder, Protection, SerialArm};
use palpate::math::vec3;
#[cfg(feature = "host")]
use palpate::scene::Slot;
use palpate::servo::Settings;
#[cfg(not(feature = "accept"))]
use palpate_bench::Offers;
#[cfg(feature = "host")]
use palpate_bench::{OneSlot, one_slot, store::RamStore};

/// The device: the preset, with 14-bit angle sensors on the motors' shafts.
pub static DEVICE: Device<SerialArm, 3> = Device {
    encoders: [
        Encoder::geared(16_384.0, -16.0, 0.0),
        Encoder::geared(16_384.0, -12.0, 0.0),
        Encoder::geared(16_384.0, 12.0, 0.0),
    ],
    ..WOODEN_HAPTICS_2016
};

/// The limits of its motors and joints; the board's loop watches the supply.
pub const PROTECTION: Protection<3> = WOODEN_HAPTICS_2016_PROTECTION;

/// 4 kHz and 600 N/m are well inside what the device takes.
pub const SETTINGS: Settings = Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.2,
    body_origin_m: vec3(-0.05, -0.05, -0.06),
};

/// The body: `cargo palpate firmware --board BOARD --body MODEL build --release` puts another one here.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

#[cfg(not(feature = "host"))]
palpate_bench::arm!(tables::Surface = tables::SURFACE, DEVICE, SETTINGS, PROTECTION);
#[cfg(feature = "host")]
palpate_bench::arm!(OneSlot<RamStore> = &SCENE, DEVICE, SETTINGS, PROTECTION);

/// Bodies from a host.
#[cfg(feature = "host")]
static STORE: RamStore = RamStore::new();
/// One patch alone is no body: choose a model of one.
#[cfg(feature = "host")]
static SLOT: Slot<RamStore> = Slot::exchangeable(tables::SURFACE, &STORE);
#[cfg(feature = "host")]
static SCENE: OneSlot<RamStore> = one_slot(&SLOT, &DEVICE, &SETTINGS);

/// Memory for a host, once.
#[cfg(not(feature = "accept"))]
pub fn offers() -> impl Offers {
    #[cfg(feature = "host")]
    return STORE.main();
}
