//! Settings of this board: the file to change first. The build chooses device (`--device`), body (`--body`)
//! and rate (`--rate`).

use palpate::body::Effort;
#[cfg(feature = "host")]
use palpate::body::{Body, TickLimit};
#[cfg(feature = "host")]
use palpate::scene::Slot;
use palpate::servo::{Safety, Settings, recommended};
#[cfg(not(feature = "accept"))]
use palpate_bench::Offers;
#[cfg(feature = "host")]
use palpate_bench::{OneSlot, one_slot, store::RamStore};

/// The device: this board's own, or that of `--device`.
pub mod own {
    include!(env!("PALPATE_DEVICE_FILE"));
}

const _: () = palpate_bench::check_feeds(&own::DEVICE, true);

/// Servo rate, Hz: 4,000, or that of `--rate`.
pub const RATE_HZ: u32 = include!(concat!(env!("OUT_DIR"), "/rate.rs"));
#[cfg(feature = "host")]
const _: () =
    assert!(RATE_HZ <= 4_000, "bodies from a host are bounded for 4 kHz: a faster loop has no feature `host`");

/// Recommended for the device; the body lies where `--at` has it.
pub const SETTINGS: Settings = Settings {
    rate_hz: RATE_HZ as f32,
    body_origin_m: include!(concat!(env!("OUT_DIR"), "/origin.rs")),
    ..recommended::of(&own::DEVICE).settings
};

/// A host that has commanded something and falls silent for a tenth of a second is gone.
pub const SAFETY: Safety = Safety {
    link_timeout_s: if cfg!(feature = "host") { 0.1 } else { Safety::DEFAULT.link_timeout_s },
    ..Safety::DEFAULT
};

/// The body: `cargo palpate firmware --board BOARD --body MODEL build --release` puts another one here.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// Work of the tracker in a tick: at 4 kHz the worst on the capped box takes 35 % of a period at 150 MHz, by 7,000 counted
/// instructions of 1.9 cycles. The rest is for bodies of higher degree, the link and protection; `palpate bake
/// --table-report` bounds the tick of a body, `palpate cycles --rates` has the loads of faster loops.
pub const EFFORT: Effort = palpate_bench::effort(crate::chip::CLOCK, RATE_HZ);
#[cfg(not(feature = "host"))]
// The compiler bounds the tick of the body, which takes it a while if that is large.
#[allow(long_running_const_eval)]
static SURFACE: tables::Surface = tables::with_effort(EFFORT);

#[cfg(not(feature = "host"))]
palpate_bench::arm!(tables::Surface = &SURFACE, own, SETTINGS, SAFETY);
#[cfg(feature = "host")]
palpate_bench::arm!(OneSlot<RamStore> = &SCENE, own, SETTINGS, SAFETY);

/// Bodies from a host.
#[cfg(feature = "host")]
static STORE: RamStore = RamStore::with_effort(EFFORT);
/// With code for every kind of patch, as a host's body may have any. One patch alone is no body: choose a model of one.
#[cfg(feature = "host")]
#[allow(long_running_const_eval)]
static BUILT_IN: Body = tables::BODY.with_effort(EFFORT).fitted(TickLimit::BENCH);
#[cfg(feature = "host")]
static SLOT: Slot<RamStore> = Slot::exchangeable(&BUILT_IN, &STORE);
#[cfg(feature = "host")]
static SCENE: OneSlot<RamStore> = one_slot(&SLOT, &own::DEVICE, &SETTINGS);

/// Memory for a host, once.
#[cfg(not(feature = "accept"))]
pub fn offers() -> impl Offers {
    #[cfg(feature = "host")]
    return STORE.main();
}
