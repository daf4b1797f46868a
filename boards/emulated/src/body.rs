//! Tables and settings in flash, chosen when the image is built (see `build.rs`).

use palpate::body::{Body, Edge, Effort, Face, Spoke, Vertex};
#[cfg(feature = "protected")]
use palpate::device::{Endurance, PolarityCheck, Protection, SupplyRange};
use palpate::servo::{self, Config, Guard, Input, Rendering, Servo, ServoState};

use crate::planted;

/// The baked body.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// The settings of the loop, and its device.
#[allow(unused_imports)]
mod settings {
    include!(env!("PALPATE_SETTINGS_FILE"));
}

pub use settings::{DEVICE, Mechanism, SETTINGS, WIRING};
#[cfg(feature = "around")]
pub use tables::AROUND;
pub use tables::Surface as Felt;

/// The loop of this image, guarded by `G`.
pub type Loop<G> = Servo<'static, tables::Surface, settings::Mechanism, 3, G>;
/// Its state between two ticks.
pub type StateOf<G> = ServoState<3, <tables::Surface as servo::Surface>::Witness, <G as Guard<3>>::State>;

/// The guard of the programs' loop.
#[cfg(not(feature = "protected"))]
pub type Chosen = palpate::servo::Unguarded;
/// The guard of the programs' loop.
#[cfg(feature = "protected")]
pub type Chosen = palpate::servo::Guarded<3>;

/// The state of the programs' loop between two ticks.
pub type State = StateOf<Chosen>;

// What the host counts of each record when it reports a table's bytes.
const _: () = assert!(size_of::<Face>() == 228 && size_of::<Edge>() == 52 && size_of::<Vertex>() == 32);
const _: () = assert!(size_of::<Spoke>() == 16 && size_of::<Body>() == 92);

/// That of a fast loop: as the budgets count it.
pub const EFFORT: Effort = Effort::ONE;
// The compiler bounds the tick of the body, which takes it a while if that is large.
#[allow(long_running_const_eval)]
static SURFACE: tables::Surface = tables::with_effort(EFFORT);

/// How the surface feels.
const RENDERING: Rendering = if cfg!(feature = "smooth") { Rendering::SMOOTH } else { settings::RENDERING };

/// Everything the servo knows, in flash.
#[cfg(not(feature = "protected"))]
pub static SERVO: Loop<Chosen> = Servo::new(
    &DEVICE,
    &SURFACE,
    Config { settings: SETTINGS, rendering: RENDERING, safety: settings::SAFETY, ..Config::DEFAULT },
);
/// Everything the servo knows, in flash.
#[cfg(feature = "protected")]
pub static SERVO: Loop<Chosen> = Servo::protected(
    &DEVICE,
    &SURFACE,
    protection(),
    Config { settings: SETTINGS, rendering: RENDERING, safety: settings::SAFETY, ..Config::DEFAULT },
);

/// A motor that is always too warm.
#[cfg(feature = "protected")]
const WARM: Endurance = Endurance { continuous: 0.001, time_constant_s: 600.0 };

/// The protection. Where it is counted, joints stay on trial: for an inertia that no polarity pulse moves, a path says
/// nothing of polarity. On trial no force is folded back, so where that is counted the joints give way to the pulses
/// until all were seen.
#[cfg(feature = "protected")]
const fn protection() -> Protection<3> {
    if cfg!(feature = "counted") {
        Protection {
            supply: Some(SupplyRange { min_mv: 20_000, max_mv: 28_000 }),
            polarity: if cfg!(feature = "folded") {
                settings::PROTECTION.polarity
            } else {
                Some(PolarityCheck { inertia_kg_m2: [1e3; 3] })
            },
            motors: if cfg!(feature = "folded") { [WARM; 3] } else { settings::PROTECTION.motors },
            ..settings::PROTECTION
        }
    } else {
        settings::PROTECTION
    }
}

/// The handle's orientation before a tick, where its counts came.
#[cfg(feature = "wrist")]
pub fn orient(state: &mut State, wrist: &mut ([i32; 3], palpate::device::WristState), input: Input<3>) {
    if let Input::Sensors { counts, .. } = input {
        // Without an orientation there is no force.
        let _ = SERVO.orient(state, &settings::WRIST, &mut wrist.1, counts, wrist.0.map(palpate::device::Counts));
    }
}

/// One tick of the servo: a function of its own, so that proofs and counts cover the tick and nothing
/// else.
#[inline(never)]
pub fn tick(state: &mut State, input: Input<3>) {
    planted::fault(state.ticks(), state.fade(), state.frames_lost());
    let _ = SERVO.tick(state, input);
}
