//! The servo of a board with three joints: an arm with all protection of its device, which runs by itself. A host that
//! commands the scene must not fall silent: set `Safety::link_timeout_s`.

use palpate::device::drive::Feed;
use palpate::device::{Device, Homing, Kinematics, Protection, Reference, SupplyRange};
use palpate::scene::{BodyStore, Limits, Material, Motion, Part, Scene, Slot};
use palpate::servo::{Config, Guarded, Rendering, Safety, Servo, Settings, Surface};
use palpate::track::Placement;

/// The servo of an arm on a surface.
pub type ArmServo<S, K> = Servo<'static, S, K, 3, Guarded<3>>;

/// A scene of one body, in whose place others may come from a body store.
pub type OneSlot<S> = Scene<'static, Slot<'static, S>, 1>;

/// While the button is down. Of a pose: where the arm is held still for a tenth of a second; ten seconds of a shaking
/// hand are refused.
const fn homing<K>(device: &Device<K, 3>, reference: Reference<3>, rate: f32) -> Homing<3> {
    Homing::new(device.encoders, reference, (0.1 * rate) as u32, 4, (10.0 * rate) as u32).when_asked()
}

/// The servo of a device with its protection, homed by this reference; `None` for counts that are known after each
/// reset. The table is checked at boot and continuously. The force is smooth:
/// free of counts, ticks and edges.
pub const fn arm_servo<S: Surface, K: Kinematics<3>>(
    device: &'static Device<K, 3>,
    surface: &'static S,
    settings: Settings,
    protection: Protection<3>,
    reference: Option<Reference<3>>,
    safety: Safety,
) -> ArmServo<S, K> {
    let homing = match reference {
        Some(reference) => Some(homing(device, reference, settings.rate_hz)),
        None => None,
    };
    let rendering = Rendering::SMOOTH;
    Servo::protected(device, surface, protection, Config { settings, rendering, homing, safety, ..Config::DEFAULT })
}

/// That each motor of a device is fed as a board drives it: by a bridge's voltage, or by an amplifier that controls the
/// current. A current's duty on a bridge would be a voltage without any limit of the current.
///
/// # Panics
/// At compile time, if not.
pub const fn check_feeds<K>(device: &Device<K, 3>, has_bridges: bool) {
    let mut joint = 0;
    while joint < 3 {
        match (&device.feeds[joint], has_bridges) {
            (Feed::Current, true) => panic!("this board drives bridges: the device's feeds must be Feed::Voltage"),
            (Feed::Voltage(_), false) => {
                panic!(
                    "this board drives amplifiers, whose duties turn a motor on a bridge: the device has Feed::Voltage"
                )
            }
            _ => joint += 1,
        }
    }
}

/// That the bridges' supply of a device is one at which its board drives them.
///
/// # Panics
/// At compile time, if not.
pub const fn check_supply<K>(device: &Device<K, 3>, within: Option<SupplyRange>) {
    let Some(within) = within else { return };
    let mut joint = 0;
    while joint < 3 {
        if let Feed::Voltage(feed) = &device.feeds[joint]
            && !(feed.supply_v * 1e3 >= within.min_mv as f32 && feed.supply_v * 1e3 <= within.max_mv as f32)
        {
            panic!(
                "the device's bridges have a supply outside of BENCH.supply: correct its file, or BENCH in src/set_up.rs"
            )
        }
        joint += 1;
    }
}

/// The scene of a slot: its body rests, with the loop's own stiffness and damping.
pub const fn one_slot<S: BodyStore, K>(
    slot: &'static Slot<'static, S>,
    device: &Device<K, 3>,
    settings: &Settings,
) -> OneSlot<S> {
    let material = Material::new(settings.stiffness_n_per_m, settings.damping_n_s_per_m);
    let part = Part::in_slot(slot, Motion::Resting(Placement::IDENTITY), material);
    Scene::new(Limits::of(device, settings.rate_hz), [part])
}

/// Declares `This`, which a board's loop runs: an arm in a `static`, so that the compiler knows every number of it.
///
/// `arm!(tables::Surface = &SURFACE, device, SETTINGS, SAFETY);`, where `device` is a module with the constants that
/// `palpate device` writes: `Mechanism`, `DEVICE`, `PROTECTION`, `REFERENCE`, `WIRING`. Without one of them it does not
/// compile.
#[macro_export]
macro_rules! arm {
    ($Surface:ty = $surface:expr, $device:ident, $settings:expr, $safety:expr) => {
        static SERVO: $crate::ArmServo<$Surface, $device::Mechanism> =
            $crate::arm_servo(&$device::DEVICE, $surface, $settings, $device::PROTECTION, $device::REFERENCE, $safety);

        /// The servo that the loop runs.
        pub struct This;

        impl $crate::Felt<3> for This {
            type Surface = $Surface;
            type Mechanism = $device::Mechanism;
            type Guard = palpate::servo::Guarded<3>;

            #[inline(always)]
            fn servo(&self) -> &$crate::ArmServo<$Surface, $device::Mechanism> {
                &SERVO
            }

            #[inline(always)]
            fn wiring(&self) -> palpate::commission::Wiring<3> {
                $device::WIRING
            }
        }
    };
}
