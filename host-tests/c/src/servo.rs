//! The servo loop: started with a mechanism of any kind, ticked without a word of which.

use crate::ground::{Ground, Rendered, SERVO_WORDS};
use crate::handle::{Handle, Kind};
use crate::mechanisms::MechanismNumbers;
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::{checked_mut, get, put, row};
use crate::protection::Guarding;
use crate::running::{Loop, Running, Sensed};
use crate::state::{MotorOutput, StateNumbers};
use crate::status::{Status, code};
use core::mem::MaybeUninit;
use core::ptr::{NonNull, addr_of, addr_of_mut};
use palpate_core::device::{Device, Kinematics};
use palpate_core::field::MAX_MODES;
use palpate_core::servo::{Config, Event, Guard, ResetReason};

/// Words of a handle's head.
const HEAD_WORDS: usize = 6;

/// A loop in the caller's memory.
#[repr(C)]
pub struct Started {
    ground: Ground,
    /// The loop, which lies in `memory`: a handle that has moved is none.
    running: NonNull<dyn Running>,
    /// Any mechanism's device, loop and state; of a tool it goes on past the end ([`Rendered::WORDS`]).
    memory: MaybeUninit<[usize; SERVO_WORDS - HEAD_WORDS]>,
}

impl Kind for Started {
    const MARK: usize = 0x5041_4c53;
}

/// A device and a surface, and the loop that refers to them.
#[repr(C)]
struct Whole<K: 'static, const JOINTS: usize, G: Guard<JOINTS>, B: Rendered> {
    device: Device<K, JOINTS>,
    kept: B::Kept,
    running: Loop<K, JOINTS, G, B::Surface>,
}

/// Parts of a loop, apart from its mechanism.
pub struct Parts<P, B> {
    /// The device's numbers.
    pub device: *const DeviceNumbers,
    /// The rendered ground.
    pub ground: B,
    /// The settings.
    pub settings: *const SettingsNumbers,
    /// How it is guarded.
    pub guarding: P,
    /// Why the chip was reset.
    pub reset: u32,
}

/// A loop by its parts.
type LoopOf<M, const JOINTS: usize, P, B> =
    Loop<<M as MechanismNumbers>::Mechanism, JOINTS, <P as Guarding<JOINTS>>::Guard, <B as Rendered>::Surface>;

/// Makes a loop of any mechanism, guarded or not.
///
/// # Safety
/// As the header says of all functions, and there are [`Rendered::WORDS`].
pub unsafe fn begin<M: MechanismNumbers, const JOINTS: usize, P: Guarding<JOINTS>, B: Rendered>(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const M,
    parts: Parts<P, B>,
) -> Result<NonNull<LoopOf<M, JOINTS, P, B>>, Status>
where
    M::Mechanism: Kinematics<JOINTS> + Copy + 'static,
{
    const {
        let words = size_of::<Whole<M::Mechanism, JOINTS, P::Guard, B>>().div_ceil(size_of::<usize>());
        assert!(words + HEAD_WORDS <= B::WORDS);
    }
    const { assert!(align_of::<Whole<M::Mechanism, JOINTS, P::Guard, B>>() <= align_of::<usize>()) };
    let Parts { device, ground, settings, guarding, reset } = parts;
    // SAFETY: the caller's memory for the loop.
    let place = unsafe { Handle::vacate(servo, servo_bytes) }?;
    // SAFETY: the caller's numbers.
    let (mechanism, device, settings) = unsafe { (get(mechanism)?, get(device)?, get(settings)?) };
    // It is written part by part, and no handle before all of it is there.
    // SAFETY: the place that was vacated. No reference to the whole value is made: only to its parts.
    let value = unsafe { Handle::value(place) };
    // SAFETY: within the value; by the assertions above it is large enough and aligned.
    let whole = unsafe { addr_of_mut!((*value).memory) }.cast::<Whole<M::Mechanism, JOINTS, P::Guard, B>>();
    // SAFETY: the caller's body, which stays; memory of the loop.
    let (ground, surface) = unsafe { ground.stand(addr_of_mut!((*whole).kept)) }?;
    let device: Device<M::Mechanism, JOINTS> = device.device(mechanism.mechanism()?)?;
    let reset = ResetReason::ALL.into_iter().find(|known| *known as u32 == reset).ok_or(Status::OutOfRange)?;
    // SAFETY: as above; the device is not written again, and stays for as long as the loop.
    let device: &'static Device<M::Mechanism, JOINTS> = unsafe {
        addr_of_mut!((*whole).device).write(device);
        &*addr_of!((*whole).device)
    };
    let (rendering, safety) = (settings.rendering()?, settings.safety()?);
    let config = Config { settings: settings.settings(), rendering, safety, ..Config::DEFAULT };
    let servo = guarding.servo(device, surface, config)?;
    device.kinematics.check(guarding.holds(device.full_torques_n_m()))?;
    // SAFETY: within the value, all of which is there then.
    unsafe {
        let running = NonNull::new_unchecked(addr_of_mut!((*whole).running));
        running.write(Loop { state: servo.start_after(reset), servo, reset });
        addr_of_mut!((*value).ground).write(ground);
        addr_of_mut!((*value).running).write(running);
        Handle::seal(place);
        Ok(running)
    }
}

/// The loop of a handle, if that and the body it feels are there.
///
/// # Safety
/// As [`Handle::get_mut`].
pub unsafe fn running<'a>(servo: *mut Handle<Started>) -> Result<&'a mut dyn Running, Status> {
    // SAFETY: by the caller's promise. Parts of the value are looked at, never all of it at once.
    let (ground, running) = unsafe {
        let value = Handle::live(servo)?;
        (addr_of!((*value).ground).read(), addr_of!((*value).running).read())
    };
    // SAFETY: the body it was started on, which the caller keeps.
    unsafe { ground.check() }?;
    // SAFETY: a handle that is live holds a loop, where it was made.
    Ok(unsafe { &mut *running.as_ptr() })
}

/// The ground of a loop, if that and the body are there.
///
/// # Safety
/// As [`running`].
pub unsafe fn ground(servo: *mut Handle<Started>) -> Result<Ground, Status> {
    // SAFETY: as there.
    unsafe {
        let ground = addr_of!((*Handle::live(servo)?).ground).read();
        ground.check()?;
        Ok(ground)
    }
}

unsafe fn tick(servo: *mut Handle<Started>, sensed: Sensed<'_>, output: *mut MotorOutput) -> Result<(), Status> {
    // Off until a tick has said otherwise.
    // SAFETY: the caller's place for it.
    unsafe { put(output, MotorOutput::OFF) }?;
    // SAFETY: the caller's handle, nobody else's.
    let running = unsafe { running(servo) }?;
    running.tick(sensed)?;
    // SAFETY: as above.
    unsafe { put(output, running.output()) }
}

/// One tick with sensors.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_tick(
    servo: *mut Handle<Started>,
    counts: *const i32,
    joints: usize,
    enable: u32,
    output: *mut MotorOutput,
) -> Status {
    let ticked = || {
        if joints == 0 || joints > 3 {
            // SAFETY: the caller's place for it.
            unsafe { put(output, MotorOutput::OFF) }?;
            return Err(Status::OutOfRange);
        }
        // SAFETY: so many numbers of the caller's.
        let counts = match unsafe { row(counts, joints) } {
            Ok(counts) => counts,
            Err(status) => {
                // SAFETY: the caller's place for it.
                unsafe { put(output, MotorOutput::OFF) }?;
                return Err(status);
            }
        };
        // SAFETY: the caller's handle and place.
        unsafe { tick(servo, Sensed::Counts { counts, enable: enable != 0 }, output) }
    };
    code(ticked())
}

/// One tick without sensors.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_tick_without(
    servo: *mut Handle<Started>,
    damaged: u32,
    output: *mut MotorOutput,
) -> Status {
    let sensed = if damaged == 0 { Sensed::Lost } else { Sensed::Damaged };
    // SAFETY: the caller's handle and place.
    code(unsafe { tick(servo, sensed, output) })
}

/// Records an event outside a tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_note(
    servo: *mut Handle<Started>,
    event: u32,
    output: *mut MotorOutput,
) -> Status {
    let note = || {
        checked_mut(output)?;
        // SAFETY: the caller's handle, nobody else's.
        let running = unsafe { running(servo) }?;
        running.note(match event {
            1 => Event::LinkAlive,
            2 => Event::Overrun,
            3 => Event::DriveFault,
            4 => Event::Homed,
            5 => Event::HomingRefused,
            6 => Event::Stop,
            7 => Event::Acknowledged,
            _ => return Err(Status::OutOfRange),
        });
        // SAFETY: the caller's place for it.
        unsafe { put(output, running.output()) }
    };
    code(note())
}

/// The motors' supply was measured.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_supply(
    servo: *mut Handle<Started>,
    millivolts: u32,
    output: *mut MotorOutput,
) -> Status {
    let note = || {
        checked_mut(output)?;
        // SAFETY: the caller's handle, nobody else's.
        let running = unsafe { running(servo) }?;
        running.note(Event::Supply { millivolts });
        // SAFETY: the caller's place for it.
        unsafe { put(output, running.output()) }
    };
    code(note())
}

/// The state after the last tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_state(servo: *mut Handle<Started>, state: *mut StateNumbers) -> Status {
    let read = || {
        checked_mut(state)?;
        // SAFETY: the caller's handle, nobody else's.
        let running = unsafe { running(servo) }?;
        // SAFETY: the caller's place for it.
        unsafe { put(state, running.state()) }
    };
    code(read())
}

/// How far each mode is.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_modes(servo: *mut Handle<Started>, q: *mut f32) -> Status {
    let read = || {
        let q: *mut [f32; MAX_MODES] = checked_mut(q)?.cast();
        // SAFETY: the caller's handle, nobody else's.
        let modes = unsafe { running(servo) }?.modes().ok_or(Status::SoftNone)?;
        // SAFETY: the caller's place for them.
        unsafe { put(q, modes) }
    };
    code(read())
}
