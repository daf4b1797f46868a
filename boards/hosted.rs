//! The servo of a board that a host may order about (feature `host`): a scene of the one body that the build chose, in
//! whose place others may come over the line.

use palpate::body::Body;
use palpate::device::{Homing, Reference, SerialArm};
use palpate::scene::{Limits, Material, Motion, Part, Scene, Slot};
use palpate::servo::{Guarded, Servo};
use palpate::track::{Controller, Placement};
use palpate_bench::Felt;

use crate::body::{DEVICE, PROTECTION, SETTINGS};
use crate::host::{SHELF, Shelf};

/// The body: `cargo palpate firmware --board BOARD --body MODEL build --release --features host` puts another one here.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// One patch alone is no body: choose a model of one.
const BODY: &Body<'static> = tables::SURFACE;

/// What is touched.
pub type Surface = Scene<'static, Slot<'static, Shelf>, 1>;

/// As without a host (`alone.rs`).
const HOMING: Homing<3> = Homing::new(
    DEVICE.encoders,
    Reference::Pose(DEVICE.angles_at_zero()),
    (0.1 * SETTINGS.rate_hz) as u32,
    4,
    (10.0 * SETTINGS.rate_hz) as u32,
)
.when_asked();

static SLOT: Slot<'static, Shelf> = Slot::exchangeable(BODY, &SHELF);

static SCENE: Surface = Scene::new(
    Limits::of(&DEVICE, SETTINGS.rate_hz),
    [Part::in_slot(
        &SLOT,
        Motion::Resting(Placement::IDENTITY),
        Material::new(SETTINGS.stiffness_n_per_m, SETTINGS.damping_n_s_per_m),
    )],
);

/// It feels by itself, with a host or without: no host watches. One that orders is better watched
/// (`Safety::link_timeout`).
pub const fn built() -> Servo<'static, Surface, SerialArm, 3, Guarded<3>> {
    Servo::new(&DEVICE, &SCENE, Controller::SECOND_ORDER, SETTINGS).protect(PROTECTION).homing(HOMING)
}

/// What is refused does not compile.
static SERVO: Servo<'static, Surface, SerialArm, 3, Guarded<3>> = built();

/// What the loop feels.
pub struct This;

impl Felt<3> for This {
    type Surface = Surface;
    type Mechanism = SerialArm;
    type Guard = Guarded<3>;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Surface, SerialArm, 3, Guarded<3>> {
        &SERVO
    }
}
