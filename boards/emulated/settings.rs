// The settings of the demo. Copy this file, change it, and name yours in PALPATE_SETTINGS.

// The device: its mechanism's type, its constant, and what protects it where the image is built with `protected`.
pub use palpate::device::presets::WOODEN_HAPTICS_2016_PROTECTION as PROTECTION;
/// Which of the board's encoder inputs and motor outputs each joint is on.
pub const WIRING: palpate::commission::Wiring<3> = palpate::commission::Wiring::STRAIGHT;
pub use palpate::device::{SerialArm as Mechanism, presets::WOODEN_HAPTICS_2016 as DEVICE};

/// 4 kHz, 600 N/m: well inside what the device takes; see `palpate::servo::Settings` for what each entry is.
pub const SETTINGS: palpate::servo::Settings = palpate::servo::Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.2,
    body_origin_m: palpate::math::vec3(-0.03, -0.02, -0.015),
};

/// A host that is silent for 100 ms is gone.
pub const SAFETY: palpate::servo::Safety =
    palpate::servo::Safety { link_timeout_s: 0.1, ..palpate::servo::Safety::DEFAULT };

/// Spring and damper alone, as the budgets count them; `demo` has the recommended smoothing.
pub const RENDERING: palpate::servo::Rendering = palpate::servo::Rendering::PLAIN;
