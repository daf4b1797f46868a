//! A loop that renders a dial: its start, and its feel, which a program changes between two ticks.

use crate::handle::Handle;
use crate::mechanisms::MechanismNumbers;
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::{Plain, checked_mut, finite, get, put};
use crate::protection::{Guarding, ProtectionNumbers, Unprotected};
use crate::servo::{Parts, Started, begin, running};
use crate::status::{Status, code};
use palpate_core::device::Dial;
use palpate_core::render::{Detents, DialFriction, Ends, Feel, FeelPart, Notch, Spring, Wave};
use palpate_core::servo::{Knob, KnobError, MAX_RETURN_RAD};

/// A dial's radius, and how fast the torque of an old feel decays.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DialNumbers {
    pub radius: f32,
    pub release_rate: f32,
}

/// Detents, or a texture.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct WaveNumbers {
    pub pitch: f32,
    pub torque: f32,
    pub centre: f32,
}

/// Detents that snap.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ClicksNumbers {
    pub pitch: f32,
    pub stiffness: f32,
    pub damping: f32,
    pub snap: f32,
    pub first: i32,
    pub last: i32,
    pub wall_stiffness: f32,
    pub max_torque: f32,
}

/// A spring.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SpringNumbers {
    pub stiffness: f32,
    pub rest: f32,
    pub max_torque: f32,
}

/// End stops.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct EndsNumbers {
    pub between: [f32; 2],
    pub stiffness: f32,
    pub damping: f32,
}

/// Dry friction.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DialFrictionNumbers {
    pub torque: f32,
    pub whole_at: f32,
}

/// A click at one position.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct NotchNumbers {
    pub at: f32,
    pub width: f32,
    pub torque: f32,
}

/// A feel; parts whose numbers are all 0 are none.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FeelNumbers {
    pub detents: WaveNumbers,
    pub clicks: ClicksNumbers,
    pub texture: WaveNumbers,
    pub spring: SpringNumbers,
    pub ends: EndsNumbers,
    pub damping: f32,
    pub friction: DialFrictionNumbers,
    pub notch: NotchNumbers,
}

/// The dial for a program.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TurnedNumbers {
    pub turns: i32,
    pub angle: f32,
    pub torque: f32,
    pub detent: i32,
    pub end: i32,
}

/// A number of a feel that was refused, beside its limit.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct BeyondNumbers {
    pub asked: f32,
    pub limit: f32,
}

impl BeyondNumbers {
    /// Zeros for a refusal without a limit of the device.
    fn of(error: &KnobError) -> Self {
        let (asked, limit) = match *error {
            KnobError::Stiffness { asked_n_m_per_rad, limit_n_m_per_rad } => (asked_n_m_per_rad, limit_n_m_per_rad),
            KnobError::Damping { asked_n_m_s_per_rad, limit_n_m_s_per_rad } => {
                (asked_n_m_s_per_rad, limit_n_m_s_per_rad)
            }
            KnobError::Torque { asked_n_m, limit_n_m } | KnobError::Motor { asked_n_m, limit_n_m } => {
                (asked_n_m, limit_n_m)
            }
            KnobError::Far { asked_rad } => (asked_rad, MAX_RETURN_RAD),
            KnobError::Undamped { asked_n_m_s_per_rad, needed_n_m_s_per_rad } => {
                (asked_n_m_s_per_rad, needed_n_m_s_per_rad)
            }
            _ => (0.0, 0.0),
        };
        Self { asked, limit }
    }
}

// SAFETY: floats alone.
unsafe impl Plain for DialNumbers {}
// SAFETY: numbers alone.
unsafe impl Plain for FeelNumbers {}

impl MechanismNumbers for DialNumbers {
    type Mechanism = Dial;

    fn mechanism(&self) -> Result<Dial, Status> {
        finite(&[self.radius])?;
        let dial = Dial { radius_m: self.radius, cogging: None };
        dial.check()?;
        Ok(dial)
    }
}

/// A part, unless all of its numbers are 0.
fn some<T>(numbers: &[f32], part: T) -> Option<T> {
    numbers.iter().any(|number| *number != 0.0).then_some(part)
}

impl WaveNumbers {
    const NONE: Self = Self { pitch: 0.0, torque: 0.0, centre: 0.0 };

    fn of(wave: Wave) -> Self {
        Self { pitch: wave.pitch_rad, torque: wave.torque_n_m, centre: wave.centre_rad }
    }

    fn wave(self) -> Option<Wave> {
        let Self { pitch, torque, centre } = self;
        some(&[pitch, torque, centre], Wave { pitch_rad: pitch, torque_n_m: torque, centre_rad: centre })
    }
}

impl FeelNumbers {
    fn of(feel: &Feel) -> Self {
        const NO_CLICKS: Detents = Detents {
            pitch: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            snap: 0.0,
            first: 0,
            last: 0,
            wall_stiffness: 0.0,
            max_force: 0.0,
        };
        let Detents { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force } =
            feel.clicks.unwrap_or(NO_CLICKS);
        Self {
            detents: feel.detents.map_or(WaveNumbers::NONE, WaveNumbers::of),
            clicks: ClicksNumbers {
                pitch,
                stiffness,
                damping,
                snap,
                first,
                last,
                wall_stiffness,
                max_torque: max_force,
            },
            texture: feel.texture.map_or(WaveNumbers::NONE, WaveNumbers::of),
            spring: feel.spring.map_or(SpringNumbers { stiffness: 0.0, rest: 0.0, max_torque: 0.0 }, |spring| {
                let Spring { stiffness_n_m_per_rad: stiffness, rest_rad: rest, max_torque_n_m: max_torque } = spring;
                SpringNumbers { stiffness, rest, max_torque }
            }),
            ends: feel.ends.map_or(EndsNumbers { between: [0.0; 2], stiffness: 0.0, damping: 0.0 }, |ends| {
                let Ends { between_rad: between, stiffness_n_m_per_rad: stiffness, damping_n_m_s_per_rad: damping } =
                    ends;
                EndsNumbers { between, stiffness, damping }
            }),
            damping: feel.damping_n_m_s_per_rad,
            friction: feel.friction.map_or(DialFrictionNumbers { torque: 0.0, whole_at: 0.0 }, |friction| {
                DialFrictionNumbers { torque: friction.torque_n_m, whole_at: friction.whole_at_rad_per_s }
            }),
            notch: feel.notch.map_or(NotchNumbers { at: 0.0, width: 0.0, torque: 0.0 }, |notch| NotchNumbers {
                at: notch.at_rad,
                width: notch.width_rad,
                torque: notch.torque_n_m,
            }),
        }
    }

    fn feel(&self) -> Feel {
        let ClicksNumbers { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_torque } = self.clicks;
        let clicks = Detents { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force: max_torque };
        let SpringNumbers { stiffness: spring, rest, max_torque: most } = self.spring;
        let EndsNumbers { between: [below, above], stiffness: stops, damping: stopped } = self.ends;
        let DialFrictionNumbers { torque: dry, whole_at } = self.friction;
        let NotchNumbers { at, width, torque: notch } = self.notch;
        Feel {
            detents: self.detents.wave(),
            clicks: some(
                &[pitch, stiffness, damping, snap, first as f32, last as f32, wall_stiffness, max_torque],
                clicks,
            ),
            texture: self.texture.wave(),
            spring: some(
                &[spring, rest, most],
                Spring { stiffness_n_m_per_rad: spring, rest_rad: rest, max_torque_n_m: most },
            ),
            ends: some(
                &[below, above, stops, stopped],
                Ends { between_rad: [below, above], stiffness_n_m_per_rad: stops, damping_n_m_s_per_rad: stopped },
            ),
            damping_n_m_s_per_rad: self.damping,
            friction: some(&[dry, whole_at], DialFriction { torque_n_m: dry, whole_at_rad_per_s: whole_at }),
            notch: some(&[at, width, notch], Notch { at_rad: at, width_rad: width, torque_n_m: notch }),
        }
    }

    fn part(&self, part: u32) -> Result<FeelPart, Status> {
        let feel = self.feel();
        Ok(match part {
            0 => FeelPart::Free,
            1 => FeelPart::Detents(feel.detents),
            2 => FeelPart::Clicks(feel.clicks),
            3 => FeelPart::Texture(feel.texture),
            4 => FeelPart::Spring(feel.spring),
            5 => FeelPart::Ends(feel.ends),
            6 => FeelPart::Damping(feel.damping_n_m_s_per_rad),
            7 => FeelPart::Friction(feel.friction),
            8 => FeelPart::Notch(feel.notch),
            _ => return Err(Status::OutOfRange),
        })
    }
}

/// All but its protection that a dial's loop starts from.
struct Given {
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    dial: *const DialNumbers,
    device: *const DeviceNumbers,
    feel: *const FeelNumbers,
    settings: *const SettingsNumbers,
    reset: u32,
}

/// The table of the loop: its own feel is the program's.
static FEELS: [Feel; 1] = [Feel::FREE];

unsafe fn start<P: Guarding<1>>(given: Given, guarding: P) -> Result<(), Status> {
    let Given { servo, servo_bytes, dial, device, feel, settings, reset } = given;
    // SAFETY: the caller's memory for the loop: none until there is one.
    unsafe { Handle::vacate(servo, servo_bytes) }?;
    // SAFETY: the caller's numbers.
    let (numbers, of_device, feel) = unsafe { (get(dial)?, get(device)?, get(feel)?) };
    let ground = Knob::try_new(&of_device.device(numbers.mechanism()?)?, &FEELS, numbers.release_rate)?;
    // Checked before there is a loop.
    ground.restore(&mut palpate_core::servo::Surface::rest(&ground), feel.feel())?;
    let parts = Parts { device, ground, settings, guarding, reset };
    // SAFETY: the caller's memory and numbers.
    let (knob, state) = unsafe {
        begin::<_, 1, _, _>(servo, servo_bytes, dial, parts)?;
        running(servo)?.dial().ok_or(Status::KnobNone)?
    };
    Ok(knob.restore(state, feel.feel())?)
}

/// Starts the loop of a dial without protection.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_dial(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    dial: *const DialNumbers,
    device: *const DeviceNumbers,
    feel: *const FeelNumbers,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    // SAFETY: the caller's memory and numbers.
    code(unsafe { start(Given { servo, servo_bytes, dial, device, feel, settings, reset }, Unprotected) })
}

/// Starts the loop of a dial with protection.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_dial_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    dial: *const DialNumbers,
    device: *const DeviceNumbers,
    feel: *const FeelNumbers,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let protected = || {
        // SAFETY: the caller's numbers.
        let guarding = unsafe { get(protection) }?;
        // SAFETY: the caller's memory and numbers.
        unsafe { start(Given { servo, servo_bytes, dial, device, feel, settings, reset }, guarding) }
    };
    code(protected())
}

/// Sets a part of the feel between two ticks, or changes nothing; `beyond` unless null: the number that was refused.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_set_feel(
    servo: *mut Handle<Started>,
    part: u32,
    feel: *const FeelNumbers,
    beyond: *mut BeyondNumbers,
) -> Status {
    let set = || {
        let wants_numbers = !beyond.is_null();
        if wants_numbers {
            checked_mut(beyond)?;
        }
        // SAFETY: the caller's numbers, and handle, nobody else's.
        let (feel, running) = unsafe { (get(feel)?, running(servo)?) };
        let (knob, state) = running.dial().ok_or(Status::KnobNone)?;
        knob.set(state, feel.part(part)?).map_err(|error| {
            if wants_numbers {
                // SAFETY: the caller's place for it.
                let _ = unsafe { put(beyond, BeyondNumbers::of(&error)) };
            }
            error.into()
        })
    };
    code(set())
}

/// The feel that is set now.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_feel(servo: *mut Handle<Started>, feel: *mut FeelNumbers) -> Status {
    let read = || {
        checked_mut(feel)?;
        // SAFETY: the caller's handle, nobody else's.
        let (_, state) = unsafe { running(servo) }?.dial().ok_or(Status::KnobNone)?;
        // SAFETY: the caller's place for it.
        unsafe { put(feel, FeelNumbers::of(state.own().unwrap_or(&Feel::FREE))) }
    };
    code(read())
}

/// The dial after the last tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_dial(servo: *mut Handle<Started>, dial: *mut TurnedNumbers) -> Status {
    let read = || {
        checked_mut(dial)?;
        // SAFETY: the caller's handle, nobody else's.
        let now = unsafe { running(servo) }?.turned().ok_or(Status::KnobNone)?;
        let turned = TurnedNumbers {
            turns: now.turns,
            angle: now.angle_rad,
            torque: now.torque_n_m,
            detent: now.detent,
            end: i32::from(now.end),
        };
        // SAFETY: the caller's place for it.
        unsafe { put(dial, turned) }
    };
    code(read())
}
