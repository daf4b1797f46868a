//! The knob of the boards: its device, how its rotor is aligned, and the table of what it feels like. The file to
//! change first.

use crate::{ChopperSettings, CurrentLimits, JogSettings};
use palpate::device::drive::{Feed, Modulation, VoltageFeed};
use palpate::device::presets::{GIMBAL_KNOB, GIMBAL_KNOB_PROTECTION};
use palpate::device::{
    CoggingMap, Commutation, Device, Dial, Endurance, FieldSearch, Homing, Motor, Protection, Reference, SupplyRange,
};
use palpate::math::Vec3;
use palpate::render::{Detents, Ends, Feel, Spring, Wave};
use palpate::servo::{Config, GuardState, Guarded, Knob, KnobWitness, Output, Servo, ServoState, Settings};
use palpate::wire::Report;

/// The loop of a knob.
pub type KnobServo = Servo<'static, Knob, Dial, 1, Guarded<1>>;
/// Its state between two ticks.
pub type KnobState = ServoState<1, KnobWitness, GuardState<1>>;

/// Current at full duty, A: the limit of stage and motor, in the scale that keeps the power: a phase's amplitude is
/// this times √(2/3), 0.61 A here.
const CURRENT_AT_FULL: f32 = 0.75;
/// Continuous current of whichever phase has the most, A, and the time constant of its winding, s: both assumed.
const CONTINUOUS_A: f32 = 0.4;
const HEATING_S: f32 = 20.0;
/// Supply, V.
pub const SUPPLY_V: f32 = 12.0;
/// Resistance of a phase, Ω: half of that between two wires.
pub const PHASE_OHM: f32 = 7.5;
/// KV: speed for each volt, rpm/V.
pub const RPM_PER_V: f32 = 80.0;
const _: () = {
    assert!(SUPPLY_V > 0.0 && SUPPLY_V < f32::INFINITY, "SUPPLY_V must be positive, in volts");
    assert!(PHASE_OHM > 0.0 && PHASE_OHM < f32::INFINITY, "PHASE_OHM must be positive, in ohms");
    assert!(RPM_PER_V > 0.0 && RPM_PER_V < f32::INFINITY, "RPM_PER_V, the motor's KV, must be positive");
    assert!(CURRENT_AT_FULL > 0.0 && CURRENT_AT_FULL < f32::INFINITY, "CURRENT_AT_FULL must be positive, in amperes");
    assert!(CONTINUOUS_A > 0.0 && CONTINUOUS_A < f32::INFINITY, "CONTINUOUS_A must be positive, in amperes");
    assert!(HEATING_S > 0.0 && HEATING_S < f32::INFINITY, "HEATING_S must be positive, in seconds");
};
const FEED: VoltageFeed = VoltageFeed::three_phase(SUPPLY_V, PHASE_OHM, RPM_PER_V, CURRENT_AT_FULL);
/// The motor. Dial, sensor and the other limits are those of the preset.
pub const MOTOR: Device<Dial, 1> = Device {
    motors: [Motor::current_driven(FEED.torque_constant_n_m_per_a, CURRENT_AT_FULL, 1.0)],
    feeds: [Feed::Voltage(FEED)],
    // The knob's limit, 56 mN·m at 20 mm, whatever more the motor has: raise it only as far as the hand bears.
    max_force_n: 2.8,
    ..GIMBAL_KNOB
};
/// Half the number of magnets, and the sensor's counts.
pub const COMMUTATION: Commutation = Commutation { counts_per_turn: 16_384, pole_pairs: 11 };
/// The limits of its motor; a board that measures its supply adds that.
pub const PROTECTION: Protection<1> =
    Protection { motors: [Endurance::three_phase(CONTINUOUS_A, CURRENT_AT_FULL, HEATING_S)], ..GIMBAL_KNOB_PROTECTION };
/// 12 V, on a supply that neither breaks down nor is pumped up by the motor.
pub const SUPPLY: SupplyRange = SupplyRange { min_mv: 10_000, max_mv: 14_000 };

/// 10 Ω for 5 W across the supply, which a braking hand pumps up.
pub const CHOPPER: ChopperSettings =
    ChopperSettings { on_v: 13.4, off_v: 13.0, resistance_ohm: 10.0, continuous_w: 5.0, energy_j: 20.0 };
const _: () = {
    assert!(
        FEED.current_at_full_a * FEED.resistance_ohm <= FEED.full_v(),
        "CURRENT_AT_FULL through PHASE_OHM needs more than SUPPLY_V over √2"
    );
    let supply_mv = FEED.supply_v * 1e3;
    assert!(
        supply_mv >= SUPPLY.min_mv as f32 && supply_mv <= SUPPLY.max_mv as f32,
        "SUPPLY_V is outside of SUPPLY: adapt SUPPLY"
    );
    assert!(
        FEED.supply_v < CHOPPER.off_v && CHOPPER.on_v * 1e3 < SUPPLY.max_mv as f32,
        "CHOPPER must rest at SUPPLY_V, and burn below the maximum of SUPPLY: adapt CHOPPER"
    );
};
/// `max_a`: twice a phase's amplitude at full duty. `open_a`: 4.5 times the current of a tenth of a volt that dead time
/// leaves, over the phase resistance: a connected phase with a third of it, less that error, has more than the tenth that
/// counts as none. The alignment has at least twice that in each phase.
pub const CURRENTS: CurrentLimits = CurrentLimits { max_a: 1.6 * CURRENT_AT_FULL, open_a: 0.45 / PHASE_OHM };

/// 4 kHz; stiffness and damping are the feels' own.
pub const SETTINGS: Settings = Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 1_000.0,
    damping_n_s_per_m: 0.0,
    max_force_n: MOTOR.max_force_n,
    velocity_corner_hz: 150.0,
    soft_start_s: 0.2,
    body_origin_m: Vec3::ZERO,
};

/// The device, with the cogging of its motor if that has been recorded.
pub const fn device(cogging: Option<CoggingMap>) -> Device<Dial, 1> {
    Device { kinematics: Dial { cogging, ..MOTOR.kinematics }, ..MOTOR }
}

/// Maximum torque of the field that aligns the rotor, N·m: 2 N on a thumb at a dial of 20 mm. The field that records the
/// cogging has as much.
const MAX_ALIGNMENT_N_M: f32 = 0.04;
/// Enough for friction and cogging, N·m.
const USUAL_ALIGNMENT_N_M: f32 = 0.03;
/// A phase's amplitude over the current in the scale that keeps the power: √(2/3).
const AMPLITUDE: f32 = 0.816_496_6;

/// The torque of the field that aligns a motor with this continuous torque, where a phase below `open_a` counts as open,
/// N·m: the usual one, or more where that would not detect it, rounded up to a mN·m. It never exceeds the continuous torque
/// or [`MAX_ALIGNMENT_N_M`].
pub const fn alignment_n_m(feed: &VoltageFeed, continuous_n_m: f32, open_a: f32) -> f32 {
    let needed = ((1e3 * detecting_n_m(feed, open_a)) as u32 + 1) as f32 * 1e-3;
    let wanted = if needed > USUAL_ALIGNMENT_N_M { needed } else { USUAL_ALIGNMENT_N_M };
    let most = if continuous_n_m < MAX_ALIGNMENT_N_M { continuous_n_m } else { MAX_ALIGNMENT_N_M };
    if wanted < most { wanted } else { most }
}

/// The torque of a field with twice this current in each phase, N·m.
const fn detecting_n_m(feed: &VoltageFeed, open_a: f32) -> f32 {
    2.0 * open_a / AMPLITUDE * feed.torque_constant_n_m_per_a
}

/// Torque that the motor gives continuously, N·m.
const CONTINUOUS_N_M: f32 = {
    let share = PROTECTION.motors[0].continuous;
    (if share < 1.0 { share } else { 1.0 }) * MOTOR.motors[0].torque_at_full_n_m
};

/// The field comes up within a fifth of a second and is led round three electrical turns, half a second each. Its torque
/// follows from the motor's numbers.
pub const SEARCH: FieldSearch = FieldSearch {
    commutation: COMMUTATION,
    torque_n_m: alignment_n_m(&FEED, CONTINUOUS_N_M, CURRENTS.open_a),
    ramp_ticks: 800,
    turn_ticks: 2_000,
    turns: 1,
};

// Invalid numbers are compile errors of the host's programs too.
const _: Homing<1> = homing(SEARCH);

/// This text with a number of thousandths in the place of its `#`.
const fn with_thousandths<const N: usize>(text: &str, number: f32) -> [u8; N] {
    let mut bytes = [0; N];
    let (mut at, mut left) = (N, (1e3 * number + 0.999) as u32);
    while at > 0 {
        at -= 1;
        bytes[at] = text.as_bytes()[at];
        if bytes[at] == b'#' {
            bytes[at] = b'0' + (left % 10) as u8;
            left /= 10;
        }
    }
    bytes
}

/// Refuses a number that is below another at compile time, with that one in the place of the text's `#`.
macro_rules! at_least {
    ($number:expr, $least:expr, $text:literal) => {
        if $number < $least {
            const TEXT: [u8; $text.len()] = with_thousandths($text, $least);
            match core::str::from_utf8(&TEXT) {
                Ok(text) => panic!("{}", text),
                Err(_) => panic!($text),
            }
        }
    };
}

// In the alignment a connected phase must have twice the current of an open one.
const _: () = {
    let most = MOTOR.max_force_n * MOTOR.kinematics.radius_m;
    assert!(
        SEARCH.torque_n_m <= USUAL_ALIGNMENT_N_M || SEARCH.torque_n_m <= most,
        "this motor's alignment, which turns the dial by itself, takes more than the knob's max_force_n times its radius: \
         raise that if the hand bears it, or take a motor of more ohms"
    );
    at_least!(
        CURRENT_AT_FULL,
        2.0 * CURRENTS.open_a / AMPLITUDE,
        "CURRENT_AT_FULL must be at least #.### A, or an open phase would not be detected: 1.1 V over PHASE_OHM"
    );
    at_least!(
        CONTINUOUS_A,
        2.0 * CURRENTS.open_a,
        "CONTINUOUS_A must be at least #.### A, or an open phase would not be detected: 0.9 V over PHASE_OHM"
    );
    at_least!(
        MAX_ALIGNMENT_N_M,
        detecting_n_m(&FEED, CURRENTS.open_a),
        "MAX_ALIGNMENT_N_M must be at least #.### N·m, or an open phase would not be detected: the torque of 1.1 V \
         at this PHASE_OHM and RPM_PER_V; raise it only if the hand at the dial bears that, or take a motor of more ohms"
    );
    assert!(
        2.0 * CURRENTS.open_a
            <= AMPLITUDE * SEARCH.torque_n_m / FEED.torque_constant_n_m_per_a * (1.0 + 4.0 * f32::EPSILON),
        "the alignment must have twice the current of an open phase, but for roundings"
    );
};

/// How the rotor is led round while button and key are held, to record its cogging: 6 s for an electrical turn, with 40
/// mN·m or the motor's continuous torque, whichever is less. Faster, its inertia would count as cogging. It snaps to the
/// field at first, so it may be faster for a moment.
pub const JOG: JogSettings =
    JogSettings { share: LED_SHARE, rate: 20.0, travel: 9.0, patience: 0.1, turn_ticks: Some(24_000) };

/// No heat is counted meanwhile: the limit is the motor's continuous torque. Rounded down to a hundredth.
const LED_SHARE: f32 = {
    let continuous = CONTINUOUS_N_M;
    let torque = if continuous * 0.975 < 0.0402 { continuous * 0.975 } else { 0.0402 };
    let hundredths = (100.0 * torque / led_torque(1.0)) as u32;
    assert!(
        hundredths > 0,
        "a hundredth of the full voltage gives more than 40 mN·m or CONTINUOUS_A: no share of it records the cogging"
    );
    if hundredths > 100 { 1.0 } else { hundredths as f32 / 100.0 }
};

/// The torque of a field that is led with this duty of voltage on a rotor a quarter turn behind it, N·m.
pub const fn led_torque(share: f32) -> f32 {
    match MOTOR.feeds[0] {
        Feed::Voltage(feed) => feed.torque_constant_n_m_per_a * share * feed.full_v() / feed.resistance_ohm,
        Feed::Current => 0.0,
    }
}
// A share that is put in the place of that one by hand.
const _: () = assert!(
    led_torque(JOG.share) <= PROTECTION.motors[0].continuous * MOTOR.motors[0].torque_at_full_n_m,
    "the field that records the cogging has more than the motor's continuous torque: lower JOG.share"
);

/// Torque that is let go of in a second when another feel is chosen, N·m: all of it in a twentieth.
pub const LET_GO: f32 = 1.2;

/// 15°.
const PITCH: f32 = core::f32::consts::TAU / 24.0;

/// The feels, in the order of [`NAMES`].
pub static FEELS: [Feel; 6] = [
    Feel {
        detents: Some(Wave { pitch_rad: PITCH, torque_n_m: 0.03, centre_rad: 0.0 }),
        damping_n_m_s_per_rad: 6e-4,
        ..Feel::FREE
    },
    Feel {
        clicks: Some(Detents {
            pitch: PITCH,
            stiffness: 0.2,
            damping: 6e-4,
            snap: 0.55,
            first: -5,
            last: 5,
            wall_stiffness: 0.8,
            max_force: 0.05,
        }),
        ..Feel::FREE
    },
    Feel {
        texture: Some(Wave { pitch_rad: PITCH / 6.0, torque_n_m: 0.01, centre_rad: 0.0 }),
        damping_n_m_s_per_rad: 1.1e-3,
        ..Feel::FREE
    },
    Feel {
        spring: Some(Spring { stiffness_n_m_per_rad: 0.06, rest_rad: 0.0, max_torque_n_m: 0.04 }),
        damping_n_m_s_per_rad: 4e-4,
        ..Feel::FREE
    },
    Feel {
        ends: Some(Ends { between_rad: [-1.0, 1.0], stiffness_n_m_per_rad: 1.2, damping_n_m_s_per_rad: 1.5e-3 }),
        ..Feel::FREE
    },
    Feel::FREE,
];

/// The names of the feels, for a host.
pub const NAMES: [&str; FEELS.len()] = ["detents", "clicks", "texture", "spring", "end stops", "free"];

/// How the rotor is aligned: while the button is held, and restarted when it is released, for the time of eight
/// searches.
pub const fn homing(search: FieldSearch) -> Homing<1> {
    Homing::new(GIMBAL_KNOB.encoders, Reference::Fields([search]), 1, 0, 8 * search.ticks())
}

/// The loop of a device with this protection, aligned by a search.
pub const fn servo(device: &'static Device<Dial, 1>, search: FieldSearch, protection: Protection<1>) -> KnobServo {
    // It lives as long as the loop: a constant of its own.
    static KNOB: Knob = Knob::new(&MOTOR, &FEELS, LET_GO);
    Servo::protected(
        device,
        &KNOB,
        protection,
        Config { settings: SETTINGS, homing: Some(homing(search)), ..Config::DEFAULT },
    )
}

/// The protection of a loop that knows its supply ([`SUPPLY`]).
pub const TOLD_OF_SUPPLY: Protection<1> = Protection { supply: Some(SUPPLY), ..PROTECTION };

/// The pulse widths that a state asks for; `None` disables the stage.
#[inline]
pub fn widths(servo: &KnobServo, state: &KnobState, modulation: &Modulation) -> Option<[f32; 3]> {
    let Output::Drive([duty]) = state.output() else { return None };
    let [field] = servo.fields(state)?;
    Some(modulation.widths(field, duty))
}

/// Of a SimpleFOCShield at 25 kHz: half a microsecond of dead time, and the ripple of 7.5 Ω and 2 mH (assumed).
pub const MODULATION: Modulation = Modulation { dead_fraction: 0.0125, ripple_fraction: 0.019 };

/// The widths in the place of a report's duties: −32,767 to 32,767 for none to all of a period, and −32,768 for a stage
/// that is disabled.
pub fn duties(widths: Option<[f32; 3]>) -> [i16; 3] {
    match widths {
        Some(widths) => widths.map(|width| ((width - 0.5) * 65_534.0) as i16),
        None => [i16::MIN; 3],
    }
}

/// The report of a tick over a link, with the widths in the place of duties.
pub fn report(state: &KnobState, widths: Option<[f32; 3]>, instructions: u32) -> Report {
    Report { duties: duties(widths), ..Report::new(state, instructions) }
}
