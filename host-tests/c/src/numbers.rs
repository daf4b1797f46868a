//! A device and a loop's settings as numbers.

use crate::pointers::{Plain, finite, flag, get, put};
use crate::status::{Status, code};
use crate::texture::texture;
use palpate_core::device::drive::{Feed, VoltageFeed};
use palpate_core::device::{Device, Encoder, Motor, VelocityMethod};
use palpate_core::math::Vec3;
use palpate_core::render::{Coupling, Ease, Friction, Passivity};
use palpate_core::servo::recommended::{self, Recommended};
use palpate_core::servo::{Rendering, SafeOutput, Safety, Settings};

/// How a bridge feeds a motor; `supply` 0 for an amplifier that controls the current.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct VoltageNumbers {
    pub supply: f32,
    pub resistance: f32,
    pub torque_constant: f32,
    pub current_at_full: f32,
    pub ratio: f32,
    pub back_emf_share: f32,
}

/// A joint.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct JointNumbers {
    pub radians_per_count: f32,
    pub angle_at_line: f32,
    pub torque_at_full: f32,
    pub dry_friction: f32,
    pub least_angle: f32,
    pub greatest_angle: f32,
    pub feed: VoltageNumbers,
}

/// A device, all but its mechanism.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DeviceNumbers {
    pub joints: [JointNumbers; 3],
    pub min_margin: f32,
    pub max_joint_rate: f32,
    pub max_force: f32,
    pub max_stiffness: f32,
    pub max_damping: f32,
}

// SAFETY: floats alone.
unsafe impl Plain for DeviceNumbers {}

/// A loop's settings.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SettingsNumbers {
    pub rate: f32,
    pub stiffness: f32,
    pub damping: f32,
    pub max_force: f32,
    pub velocity_corner: f32,
    pub soft_start: f32,
    pub body_origin: [f32; 3],
    pub friction_stiffness: f32,
    pub friction_damping: f32,
    pub friction_static: f32,
    pub friction_dynamic: f32,
    pub texture_share: f32,
    pub coupling_stiffness: f32,
    pub coupling_damping: f32,
    pub coupling_mass: f32,
    pub passivity_damping: f32,
    pub passivity_resolution: f32,
    pub device_damping: f32,
    pub device_friction: f32,
    pub ease_onset: f32,
    pub ease_change: f32,
    pub max_slew: f32,
    pub safe_damping: f32,
    pub link_timeout: f32,
    pub max_overruns: u32,
    pub settle_ticks: u32,
    pub wait_for_homing: u32,
    pub leave_weight: u32,
    pub between_counts: u32,
}

// SAFETY: numbers alone.
unsafe impl Plain for SettingsNumbers {}

impl VoltageNumbers {
    fn feed(&self) -> Result<Feed, Status> {
        let Self { supply, resistance, torque_constant, current_at_full, ratio, back_emf_share } = *self;
        finite(&[supply, resistance, torque_constant, current_at_full, ratio, back_emf_share])?;
        if supply == 0.0 {
            return Ok(Feed::Current);
        }
        if !(supply > 0.0 && resistance > 0.0 && (0.0..=1.0).contains(&back_emf_share)) {
            return Err(Status::DeviceMotor);
        }
        let feed = VoltageFeed {
            supply_v: supply,
            full_fraction: 1.0,
            resistance_ohm: resistance,
            torque_constant_n_m_per_a: torque_constant,
            current_at_full_a: current_at_full,
            ratio,
            back_emf_fraction: back_emf_share,
        };
        Ok(Feed::Voltage(feed))
    }
}

/// A feature unless it is off, where its other numbers are looked at too: one that is not finite is a mistake.
fn unless<T>(off: bool, numbers: &[f32], status: Status, feature: T) -> Result<Option<T>, Status> {
    if !off {
        return Ok(Some(feature));
    }
    finite(numbers).map_err(|_| status)?;
    Ok(None)
}

impl DeviceNumbers {
    /// The device with this mechanism.
    pub fn device<K, const JOINTS: usize>(&self, kinematics: K) -> Result<Device<K, JOINTS>, Status> {
        const { assert!(JOINTS <= 3) };
        let mut device = Device {
            kinematics,
            encoders: [Encoder { radians_per_count: 1.0, angle_at_zero_rad: 0.0 }; JOINTS],
            motors: [Motor { torque_at_full_n_m: 1.0 }; JOINTS],
            feeds: [Feed::Current; JOINTS],
            dry_friction_n_m: [0.0; JOINTS],
            joint_range_rad: [[0.0; 2]; JOINTS],
            min_margin_m_per_rad: self.min_margin,
            max_joint_rate_rad_per_s: self.max_joint_rate,
            max_force_n: self.max_force,
            max_stiffness_n_per_m: self.max_stiffness,
            max_damping_n_s_per_m: self.max_damping,
        };
        for (index, joint) in self.joints.iter().take(JOINTS).enumerate() {
            device.encoders[index] = Encoder::new(joint.radians_per_count, joint.angle_at_line);
            device.motors[index] = Motor { torque_at_full_n_m: joint.torque_at_full };
            device.feeds[index] = joint.feed.feed()?;
            device.dry_friction_n_m[index] = joint.dry_friction;
            device.joint_range_rad[index] = [joint.least_angle, joint.greatest_angle];
        }
        device.check()?;
        Ok(device)
    }
}

impl SettingsNumbers {
    const DEFAULT: Self = Self {
        rate: Settings::DEFAULT.rate_hz,
        stiffness: Settings::DEFAULT.stiffness_n_per_m,
        damping: Settings::DEFAULT.damping_n_s_per_m,
        max_force: Settings::DEFAULT.max_force_n,
        velocity_corner: Settings::DEFAULT.velocity_corner_hz,
        soft_start: Settings::DEFAULT.soft_start_s,
        body_origin: [0.0; 3],
        friction_stiffness: 0.0,
        friction_damping: 0.0,
        friction_static: 0.0,
        friction_dynamic: 0.0,
        texture_share: 0.0,
        coupling_stiffness: 0.0,
        coupling_damping: 0.0,
        coupling_mass: 0.0,
        passivity_damping: 0.0,
        passivity_resolution: 0.0,
        device_damping: 0.0,
        device_friction: 0.0,
        ease_onset: 0.0,
        ease_change: 0.0,
        max_slew: f32::INFINITY,
        safe_damping: 0.0,
        link_timeout: Safety::DEFAULT.link_timeout_s,
        max_overruns: Safety::DEFAULT.max_overruns,
        settle_ticks: Safety::DEFAULT.settle_ticks,
        wait_for_homing: 0,
        leave_weight: 0,
        between_counts: 0,
    };

    /// The same with the settings recommended for a device.
    const fn recommended(recommended: &Recommended) -> Self {
        let Recommended { settings, rendering } = recommended;
        let (ease_onset, ease_change) = match rendering.ease {
            Some(ease) => (ease.onset_n, ease.change_n_per_s),
            None => (0.0, 0.0),
        };
        Self {
            rate: settings.rate_hz,
            stiffness: settings.stiffness_n_per_m,
            damping: settings.damping_n_s_per_m,
            max_force: settings.max_force_n,
            velocity_corner: settings.velocity_corner_hz,
            soft_start: settings.soft_start_s,
            ease_onset,
            ease_change,
            between_counts: matches!(rendering.velocity, VelocityMethod::BetweenCounts) as u32,
            ..Self::DEFAULT
        }
    }

    /// Rate, stiffness and the like.
    pub fn settings(&self) -> Settings {
        Settings {
            rate_hz: self.rate,
            stiffness_n_per_m: self.stiffness,
            damping_n_s_per_m: self.damping,
            max_force_n: self.max_force,
            velocity_corner_hz: self.velocity_corner,
            soft_start_s: self.soft_start,
            body_origin_m: Vec3::from_array(self.body_origin),
        }
    }

    /// How the surface feels.
    pub fn rendering(&self) -> Result<Rendering, Status> {
        let friction = Friction {
            stiffness_n_per_m: self.friction_stiffness,
            damping_n_s_per_m: self.friction_damping,
            static_coefficient: self.friction_static,
            dynamic_coefficient: self.friction_dynamic,
        };
        let coupling = Coupling {
            stiffness_n_per_m: self.coupling_stiffness,
            damping_n_s_per_m: self.coupling_damping,
            mass_kg: self.coupling_mass,
        };
        let passivity = Passivity {
            device_damping_n_s_per_m: self.device_damping,
            device_friction_n: self.device_friction,
            max_damping_n_s_per_m: self.passivity_damping,
            resolution_m: self.passivity_resolution,
        };
        let ease = Ease { onset_n: self.ease_onset, change_n_per_s: self.ease_change };
        Ok(Rendering {
            velocity: if flag(self.between_counts)? { VelocityMethod::BetweenCounts } else { VelocityMethod::LowPass },
            ease: unless(self.ease_change == 0.0, &[self.ease_onset], Status::SettingsEase, ease)?,
            friction: unless(
                self.friction_static == 0.0 && self.friction_dynamic == 0.0,
                &[self.friction_stiffness, self.friction_damping],
                Status::SettingsFriction,
                friction,
            )?,
            texture: texture(self.texture_share)?,
            coupling: unless(
                self.coupling_mass == 0.0,
                &[self.coupling_stiffness, self.coupling_damping],
                Status::SettingsCoupling,
                coupling,
            )?,
            passivity: unless(
                self.passivity_damping == 0.0,
                &[self.passivity_resolution, self.device_damping, self.device_friction],
                Status::SettingsPassivity,
                passivity,
            )?,
            max_slew_n_per_s: self.max_slew,
            compensates_gravity: !flag(self.leave_weight)?,
        })
    }

    /// Limits and reactions.
    pub fn safety(&self) -> Result<Safety, Status> {
        let output = if self.safe_damping == 0.0 { SafeOutput::Zero } else { SafeOutput::Damping(self.safe_damping) };
        Ok(Safety {
            output,
            max_overruns: self.max_overruns,
            link_timeout_s: self.link_timeout,
            settle_ticks: self.settle_ticks,
            wait_for_homing: flag(self.wait_for_homing)?,
            ..Safety::DEFAULT
        })
    }
}

/// Fills in the defaults.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_settings_default(settings: *mut SettingsNumbers) -> Status {
    // SAFETY: the caller's place for them.
    code(unsafe { put(settings, SettingsNumbers::DEFAULT) })
}

/// Fills in the recommended ones of a device.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_settings_recommended(
    settings: *mut SettingsNumbers,
    device: *const DeviceNumbers,
) -> Status {
    let recommend = || {
        // SAFETY: the caller's numbers. Every device has a first joint, and the limits are those of the whole.
        let device: Device<(), 1> = unsafe { get(device) }?.device(())?;
        // SAFETY: the caller's place for them.
        unsafe { put(settings, SettingsNumbers::recommended(&recommended::of(&device))) }
    };
    code(recommend())
}
