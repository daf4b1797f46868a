//! Servos that together have everything a servo can have.

use palpate::body::{Body, Soft};
use palpate::device::presets::{NOVINT_FALCON, POLHEM_V2, WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{
    Delta, Device, Endurance, LinkageArm, Motor, Protection, SerialArm, SupplyRange, VelocityMethod,
};
use palpate::math::{Vec3, vec3};
use palpate::patch::SplinePatch;
use palpate::render::{Coupling, Friction, Passivity, Texture, TextureShape, grating};
use palpate::servo::{
    Config, ContactLimits, Guarded, Rendering, SafeOutput, Safety, Servo, Settings, SoftBody, StuckLimits, Unguarded,
};

/// A polynomial patch of several spans.
mod table1c {
    include!("../../bodies/table1c.rs");
}
/// A rational one.
mod ellipsoid {
    include!("../../bodies/ellipsoid.rs");
}

/// A body with flat and curved faces, edges and corners.
mod capped_box {
    include!("../../bodies/capped_box.rs");
}

/// Its modes of a foam.
mod capped_box_modes {
    include!("../../bodies/capped_box_modes.rs");
}

/// A servo of a mechanism with three joints.
pub type ServoOf<K, S = SplinePatch<'static>, G = Unguarded> = Servo<'static, S, K, 3, G>;

const fn settings(body_origin: Vec3) -> Settings {
    Settings {
        rate_hz: 4_000.0,
        stiffness_n_per_m: 600.0,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.2,
        body_origin_m: body_origin,
    }
}

/// The middle of the workspace in the middle of the body.
const TABLE_1C_AT: Settings = settings(vec3(-0.05, -0.05, -0.06));
const CAPPED_BOX_AT: Settings = settings(vec3(-0.03, -0.02, -0.015));
const ELLIPSOID_AT: Settings = settings(vec3(0.0, 0.0, -0.02));

const FRICTION: Friction =
    Friction { stiffness_n_per_m: 800.0, damping_n_s_per_m: 1.0, static_coefficient: 0.6, dynamic_coefficient: 0.4 };
const PASSIVITY: Passivity = Passivity {
    device_damping_n_s_per_m: 0.1,
    device_friction_n: 0.01,
    max_damping_n_s_per_m: 8.0,
    resolution_m: 1e-4,
};

/// Spring and damper alone; contact that no motion explains is a fault at once.
pub static PLAIN: ServoOf<SerialArm> = Servo::new(
    &WOODEN_HAPTICS_2016,
    &table1c::PATCHES[0],
    Config {
        settings: TABLE_1C_AT,
        safety: Safety {
            link_timeout_s: 0.05,
            contact: Some(ContactLimits { max_in_a_row: 0, ..ContactLimits::DEFAULT }),
            ..Safety::DEFAULT
        },
        ..Config::DEFAULT
    },
);

/// Friction, texture, passivity; homing, the table's check, damping after a fault.
pub static RICH: ServoOf<SerialArm> = Servo::new(
    &WOODEN_HAPTICS_2016,
    &table1c::PATCHES[0],
    Config {
        settings: TABLE_1C_AT,
        rendering: Rendering {
            friction: Some(FRICTION),
            texture: Some(Texture {
                shape: TextureShape::Custom(|touch| grating(touch, 100.0, 0.3)),
                max_fraction: 0.2,
            }),
            passivity: Some(PASSIVITY),
            max_slew_n_per_s: 200.0,
            ..Rendering::PLAIN
        },
        safety: Safety { output: SafeOutput::Damping(4.0), settle_ticks: 20, wait_for_homing: true, ..Safety::DEFAULT },
        ..Config::DEFAULT
    },
);

/// A virtual tool on a rational patch, felt with a delta.
pub static COUPLED: ServoOf<Delta> = Servo::new(
    &NOVINT_FALCON,
    &ellipsoid::PATCHES[0],
    Config {
        settings: ELLIPSOID_AT,
        rendering: Rendering {
            velocity: VelocityMethod::BetweenCounts,
            coupling: Some(Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 3.0, mass_kg: 0.02 }),
            friction: Some(FRICTION),
            ..Rendering::PLAIN
        },
        ..Config::DEFAULT
    },
);

/// A five-bar on a turntable whose force is smooth, that watches for stuck sensors within the length of a stroke,
/// and bears some overruns. As on the body, nothing ends deep contact.
pub static WATCHFUL: ServoOf<LinkageArm> = Servo::new(
    &POLHEM_V2,
    &table1c::PATCHES[0],
    Config {
        settings: TABLE_1C_AT,
        rendering: Rendering::SMOOTH,
        safety: Safety {
            max_overruns: 1,
            stuck: Some(StuckLimits { load: 1.0, travel_m: 0.003 }),
            contact: None,
            ..Safety::DEFAULT
        },
        ..Config::DEFAULT
    },
);

const WEAK: Device<SerialArm, 3> = Device {
    // Next to nothing: the duty for any torque is infinite.
    motors: [Motor { torque_at_full_n_m: 1e-44 }; 3],
    dry_friction_n_m: [0.0; 3],
    ..WOODEN_HAPTICS_2016
};

/// Motors that are asked for NaN.
pub static BROKEN: ServoOf<SerialArm> =
    Servo::new(&WEAK, &ellipsoid::PATCHES[0], Config { settings: ELLIPSOID_AT, ..Config::DEFAULT });

const SHORT_SHINNED: Device<Delta, 3> =
    Device { kinematics: Delta { shin_m: 0.055, ..NOVINT_FALCON.kinematics }, ..NOVINT_FALCON };

/// Shins so short that the legs cannot meet everywhere.
pub static SHORT: ServoOf<Delta> =
    Servo::new(&SHORT_SHINNED, &ellipsoid::PATCHES[0], Config { settings: ELLIPSOID_AT, ..Config::DEFAULT });

/// A table that is not the one that was baked.
pub static CORRUPT: ServoOf<SerialArm> =
    Servo::new(&WOODEN_HAPTICS_2016, &SPOILT, Config { settings: ELLIPSOID_AT, ..Config::DEFAULT });

static SPOILT: SplinePatch = ellipsoid::PATCHES[0].with_crc(!ellipsoid::TABLE_CRC);

/// The capped box. The strokes lead right through it, deeper than any hand presses: nothing watches for lost contact,
/// so that contact lasts all the way.
pub static BODY: ServoOf<SerialArm, Body> = Servo::new(&WOODEN_HAPTICS_2016, &capped_box::BODY, BODY_CONFIG);

const BODY_CONFIG: Config<3> = Config {
    settings: CAPPED_BOX_AT,
    rendering: Rendering { friction: Some(FRICTION), ..Rendering::PLAIN },
    safety: Safety { contact: None, ..Safety::DEFAULT },
    ..Config::DEFAULT
};

static FOAM: SoftBody = match Soft::new(capped_box::BODY, &capped_box_modes::MODES) {
    Ok(soft) => match SoftBody::new(soft, &capped_box_modes::MOTION, CAPPED_BOX_AT.rate_hz) {
        Ok(surface) => surface,
        Err(_) => panic!("motion"),
    },
    Err(_) => panic!("modes"),
};

/// The capped box of foam, with eight modes.
pub static SOFT: ServoOf<SerialArm, SoftBody> = Servo::new(&WOODEN_HAPTICS_2016, &FOAM, BODY_CONFIG);

/// All protection on, with motors that are soon warm, and a supply that nobody measures for long.
pub static GUARDED: ServoOf<SerialArm, SplinePatch, Guarded<3>> = Servo::protected(
    &WOODEN_HAPTICS_2016,
    &table1c::PATCHES[0],
    Protection {
        motors: [Endurance { continuous: 0.1, time_constant_s: 0.1 }; 3],
        max_joint_rates_rad_per_s: [6.0; 3],
        supply: Some(SupplyRange { min_mv: 20_000, max_mv: 28_000 }),
        ..WOODEN_HAPTICS_2016_PROTECTION
    },
    Config { settings: TABLE_1C_AT, ..Config::DEFAULT },
);

/// Joint angles, radians, that bring each device's probe to, around and into the bodies.
pub const WOODEN_HAPTICS_REACH: [[f32; 2]; 3] = [[-0.32, 0.32], [0.0, 0.65], [0.65, 1.2]];
/// Of the Falcon's three legs.
pub const FALCON_REACH: [[f32; 2]; 3] = [[-0.2, 1.2]; 3];
/// Of the Polhem's turntable and links.
pub const POLHEM_REACH: [[f32; 2]; 3] = [[-0.32, 0.32], [0.6, 1.25], [1.7, 2.9]];
