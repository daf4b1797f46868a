//! A loop whose tool has a shape: its start, the orientation of its handle, and whether its contacts are known.

use crate::body::{Loaded, Standing};
use crate::felt::Felt;
use crate::ground::{Ground, Rendered, SERVO_WORDS};
use crate::handle::Handle;
use crate::held::{Kept, Oriented};
use crate::mechanisms::{DeltaNumbers, LinkageArmNumbers, MechanismNumbers, SerialArmNumbers};
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::{Plain, checked_mut, finite, get, put};
use crate::protection::{Guarding, ProtectionNumbers, Unprotected};
use crate::running::Loop;
use crate::servo::{Parts, Started, begin, ground, running};
use crate::status::{Status, code};
use core::ptr::{addr_of, addr_of_mut};
use palpate_core::body::Body;
use palpate_core::device::{Counts, Encoder, Mount, Wrist, WristState};
use palpate_core::math::Vec3;
use palpate_core::pair::{Core, HeldTool, ProxyError, Tool, ToolSurface};
use palpate_core::scene::BodyPose;
use palpate_core::servo::{Event, Guard};

/// Words that a loop with a tool takes beyond a servo's.
pub const TOOL_WORDS: usize = if size_of::<usize>() == 4 { 2460 } else { 1240 };

/// A tool, and the dry friction at its contacts.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ToolNumbers {
    pub half: [f32; 3],
    pub radius: f32,
    pub friction: f32,
}

/// A gimbal.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct WristNumbers {
    pub axes: [[f32; 3]; 3],
    pub radians_per_count: [f32; 3],
    pub angle_at_line: [f32; 3],
    pub range: [[f32; 2]; 3],
    pub max_rate: f32,
}

/// Contacts of a tool after a tick.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct HeldNumbers {
    pub located: u32,
    pub given_up: u32,
    pub orientation: [f32; 4],
}

// SAFETY: floats alone.
unsafe impl Plain for ToolNumbers {}
// SAFETY: floats alone.
unsafe impl Plain for WristNumbers {}

impl ToolNumbers {
    fn surface(&self, body: &'static Body<'static>, of: &SettingsNumbers) -> Result<ToolSurface<'static>, Status> {
        // Each of a point: the loop refuses them as one.
        if of.friction_static != 0.0 || of.friction_dynamic != 0.0 {
            return Err(Status::ToolPointFriction);
        }
        if of.texture_share != 0.0 {
            return Err(Status::ToolTexture);
        }
        if of.coupling_mass != 0.0 {
            return Err(Status::ToolCoupling);
        }
        let core = match self.half {
            [0.0, 0.0, 0.0] => Core::Point,
            [0.0, 0.0, half] => Core::Segment { half },
            half => Core::Box { half },
        };
        let surface = ToolSurface::new(body, Tool::new(core, self.radius)?, &of.settings())?;
        Ok(surface.with_friction(self.friction)?)
    }
}

impl WristNumbers {
    fn wrist(&self) -> Result<Wrist, Status> {
        let Self { axes, radians_per_count: of_counts, angle_at_line: lines, range, max_rate } = *self;
        let wrist = Wrist {
            axes: axes.map(Vec3::from_array),
            encoders: core::array::from_fn(|axis| Encoder::new(of_counts[axis], lines[axis])),
            range_rad: range,
            max_rate_rad_per_s: max_rate,
        };
        if wrist.is_valid() { Ok(wrist) } else { Err(Status::WristNumbers) }
    }
}

/// A wrist that turns nothing at counts of 0: of a handle that is rigid on the last link.
const RIGID: Wrist = Wrist {
    axes: [Vec3::Z, Vec3::Y, Vec3::X],
    encoders: [Encoder { radians_per_count: 1.0, angle_at_zero_rad: 0.0 }; 3],
    range_rad: [[-1.0, 1.0]; 3],
    max_rate_rad_per_s: 1.0,
};

impl<K: Mount<3> + Copy, G: Guard<3> + Copy> Oriented for Loop<K, 3, G, ToolSurface<'static>> {
    fn held(&self) -> &HeldTool {
        self.state.witness()
    }

    fn orient(&mut self, wrist: &Wrist, memory: &mut WristState, counts: [[i32; 3]; 2]) -> Result<(), Status> {
        let [arm, counts] = counts.map(|counts| counts.map(Counts));
        Ok(self.servo.orient(&mut self.state, wrist, memory, arm, counts)?)
    }
}

/// A body and the tool on it.
struct Shaped {
    body: *const Handle<Loaded>,
    tool: *const ToolNumbers,
    settings: *const SettingsNumbers,
}

impl Rendered for Shaped {
    type Surface = ToolSurface<'static>;
    type Kept = Kept;
    const WORDS: usize = SERVO_WORDS + TOOL_WORDS;

    unsafe fn stand(self, kept: *mut Kept) -> Result<(Ground, &'static Felt<Self::Surface>), Status> {
        // SAFETY: the caller's numbers, and body, which stays.
        let (tool, settings, (standing, body)) =
            unsafe { (get(self.tool)?, get(self.settings)?, Standing::on(self.body)?) };
        let felt = Felt(tool.surface(&body.0, &settings)?);
        // SAFETY: by the caller's promise. The surface is not written again.
        let felt = unsafe {
            kept.write(Kept { felt, standing, wrist: WristState::default(), oriented: None });
            &*addr_of!((*kept).felt)
        };
        Ok((Ground::Tool(kept), felt))
    }
}

unsafe fn start<M: MechanismNumbers, P: Guarding<3>>(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const M,
    parts: Parts<P, Shaped>,
) -> Result<(), Status>
where
    M::Mechanism: Mount<3> + Copy + 'static,
{
    // SAFETY: the caller's memory for the loop: none until there is one.
    unsafe { Handle::vacate(servo, servo_bytes) }?;
    if servo_bytes < Shaped::WORDS * size_of::<usize>() {
        return Err(Status::ToolMemory);
    }
    // SAFETY: the caller's memory, numbers and body.
    unsafe {
        let oriented = begin(servo, servo_bytes, mechanism, parts)?;
        addr_of_mut!((*kept(servo)?).oriented).write(Some(oriented));
    }
    Ok(())
}

/// The memory of the tool in a loop that has one.
///
/// # Safety
/// As [`Handle::get_mut`].
unsafe fn kept(servo: *mut Handle<Started>) -> Result<*mut Kept, Status> {
    // SAFETY: by the caller's promise.
    match unsafe { ground(servo) }? {
        Ground::Tool(kept) => Ok(kept),
        _ => Err(Status::ToolNone),
    }
}

/// Exports the two functions of a mechanism.
macro_rules! starts {
    ($unprotected:ident, $protected:ident, $numbers:ty) => {
        /// Starts a loop with a tool, without protection.
        ///
        /// # Safety
        /// As the header says of all functions.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $unprotected(
            servo: *mut Handle<Started>,
            servo_bytes: usize,
            mechanism: *const $numbers,
            device: *const DeviceNumbers,
            body: *const Handle<Loaded>,
            tool: *const ToolNumbers,
            settings: *const SettingsNumbers,
            reset: u32,
        ) -> Status {
            let ground = Shaped { body, tool, settings };
            let parts = Parts { device, ground, settings, guarding: Unprotected, reset };
            // SAFETY: the caller's memory, numbers and body.
            code(unsafe { start(servo, servo_bytes, mechanism, parts) })
        }

        /// Starts a loop with a tool and protection.
        ///
        /// # Safety
        /// As the header says of all functions.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $protected(
            servo: *mut Handle<Started>,
            servo_bytes: usize,
            mechanism: *const $numbers,
            device: *const DeviceNumbers,
            body: *const Handle<Loaded>,
            tool: *const ToolNumbers,
            settings: *const SettingsNumbers,
            protection: *const ProtectionNumbers,
            reset: u32,
        ) -> Status {
            let protected = || {
                // SAFETY: the caller's numbers.
                let guarding = unsafe { get(protection) }?;
                let ground = Shaped { body, tool, settings };
                let parts = Parts { device, ground, settings, guarding, reset };
                // SAFETY: the caller's memory, numbers and body.
                unsafe { start(servo, servo_bytes, mechanism, parts) }
            };
            code(protected())
        }
    };
}

starts!(palpate_servo_start_serial_arm_tool, palpate_servo_start_serial_arm_tool_protected, SerialArmNumbers);
starts!(palpate_servo_start_delta_tool, palpate_servo_start_delta_tool_protected, DeltaNumbers);
starts!(palpate_servo_start_linkage_arm_tool, palpate_servo_start_linkage_arm_tool_protected, LinkageArmNumbers);

/// Notes the orientation of the handle.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_orient(servo: *mut Handle<Started>, quaternion: *const f32) -> Status {
    let orient = || {
        // SAFETY: four numbers of the caller's, and handle, nobody else's.
        let (quaternion, running) = unsafe {
            let quaternion: [f32; 4] = get(quaternion.cast())?;
            kept(servo)?;
            (quaternion, running(servo)?)
        };
        finite(&quaternion)?;
        let pose = BodyPose { position: [0.0; 3], orientation: quaternion };
        pose.placement().ok_or(Status::ToolRotation)?;
        running.note(Event::Oriented { quaternion });
        Ok(())
    };
    code(orient())
}

/// Notes the orientation of the handle on a wrist, or rigid on the last link.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_orient_wrist(
    servo: *mut Handle<Started>,
    wrist: *const WristNumbers,
    arm: *const i32,
    counts: *const i32,
) -> Status {
    let orient = || {
        // SAFETY: the caller's handle, nobody else's. The tool's memory is apart from the loop.
        let (memory, oriented) = unsafe {
            let kept = kept(servo)?;
            let oriented = addr_of!((*kept).oriented).read().ok_or(Status::NotReady)?;
            (&mut *addr_of_mut!((*kept).wrist), &mut *oriented.as_ptr())
        };
        // SAFETY: three numbers of the caller's.
        let arm: [i32; 3] = unsafe { get(arm.cast()) }?;
        if wrist.is_null() {
            return oriented.orient(&RIGID, &mut WristState::default(), [arm, [0; 3]]);
        }
        // SAFETY: the caller's numbers.
        let wrist = unsafe { get(wrist) }?.wrist()?;
        if counts.is_null() {
            *memory = WristState::default();
            return Ok(());
        }
        // SAFETY: three numbers of the caller's.
        oriented.orient(&wrist, memory, [arm, unsafe { get(counts.cast()) }?])
    };
    code(orient())
}

/// Whether the contacts of the tool are known after the last tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_held(servo: *mut Handle<Started>, held: *mut HeldNumbers) -> Status {
    let read = || {
        checked_mut(held)?;
        // SAFETY: the caller's handle, nobody else's.
        let oriented = unsafe {
            let oriented = addr_of!((*kept(servo)?).oriented).read().ok_or(Status::NotReady)?;
            &*oriented.as_ptr()
        };
        let tool = oriented.held();
        let numbers = HeldNumbers {
            located: u32::from(tool.is_located()),
            given_up: match tool.given_up() {
                None => 0,
                Some(ProxyError::Intersects) => 1,
                // A pose that is none is lost from the next tick on.
                Some(_) => 2,
            },
            orientation: tool.orientation(),
        };
        // SAFETY: the caller's place for it.
        unsafe { put(held, numbers) }
    };
    code(read())
}
