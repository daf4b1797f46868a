//! The servo of a board with three joints: an arm with all protection of its device, which runs by itself. No host
//! watches it; if a host commands the scene, set `Safety::link_timeout_s`.

use palpate::device::{Device, Homing, Protection, Reference, SerialArm};
use palpate::scene::{BodyStore, Limits, Material, Motion, Part, Scene, Slot};
use palpate::servo::{Config, Guarded, Servo, Settings, Surface};
use palpate::track::Placement;

/// The servo of an arm on a surface.
pub type ArmServo<S> = Servo<'static, S, SerialArm, 3, Guarded<3>>;

/// A scene of one body, in whose place others may come from a body store.
pub type OneSlot<S> = Scene<'static, Slot<'static, S>, 1>;

/// The counts are zero where the arm is held still for a tenth of a second while the button is down, in its calibration
/// pose (first link upright, second level); ten seconds of a shaking hand are refused.
const fn homing(device: &Device<SerialArm, 3>, rate: f32) -> Homing<3> {
    Homing::new(device.encoders, Reference::Pose(device.angles_at_zero()), (0.1 * rate) as u32, 4, (10.0 * rate) as u32)
        .when_asked()
}

/// The servo of a device with its protection. The table is checked at boot and continuously.
pub const fn arm_servo<S: Surface>(
    device: &'static Device<SerialArm, 3>,
    surface: &'static S,
    settings: Settings,
    protection: Protection<3>,
) -> ArmServo<S> {
    Servo::protected(
        device,
        surface,
        protection,
        Config { settings, homing: Some(homing(device, settings.rate_hz)), ..Config::DEFAULT },
    )
}

/// The scene of a slot: its body rests, with the loop's own stiffness and damping.
pub const fn one_slot<S: BodyStore>(
    slot: &'static Slot<'static, S>,
    device: &Device<SerialArm, 3>,
    settings: &Settings,
) -> OneSlot<S> {
    let material = Material::new(settings.stiffness_n_per_m, settings.damping_n_s_per_m);
    let part = Part::in_slot(slot, Motion::Resting(Placement::IDENTITY), material);
    Scene::new(Limits::of(device, settings.rate_hz), [part])
}

/// Declares `This`, which a board's loop runs: an arm in a `static`, so that the compiler knows every number of it.
///
/// `arm!(tables::Surface = tables::SURFACE, DEVICE, SETTINGS, PROTECTION);`
#[macro_export]
macro_rules! arm {
    ($Surface:ty = $surface:expr, $device:expr, $settings:expr, $protection:expr) => {
        static SERVO: $crate::ArmServo<$Surface> = $crate::arm_servo(&$device, $surface, $settings, $protection);

        /// The servo that the loop runs.
        pub struct This;

        impl $crate::Felt<3> for This {
            type Surface = $Surface;
            type Mechanism = palpate::device::SerialArm;
            type Guard = palpate::servo::Guarded<3>;

            #[inline(always)]
            fn servo(&self) -> &$crate::ArmServo<$Surface> {
                &SERVO
            }
        }
    };
}
