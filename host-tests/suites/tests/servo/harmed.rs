//! A device and a surface that can be harmed while the loop runs.

use crate::surfaces::WALL;
use crate::traces::RATE;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Device, Kinematics, ProbePose, SerialArm};
use palpate::patch::{Patch, SecondDerivativeBounds, SplinePatch, SurfacePoint};
use palpate::servo::{ContactLimits, OnePatch, SafeOutput, Safety, Servo, StuckLimits};
use std::cell::Cell;

/// Ticks without a sign from the link after which it is lost.
pub const LINK_TICKS: u32 = 100;

/// The arm, with a switch that makes its pose NaN, and one that opens its joints.
#[derive(Debug)]
pub struct Poisoned {
    arm: SerialArm,
    /// What the pose becomes.
    pub with: Cell<Option<f32>>,
    /// Whether the joints are open.
    pub open: Cell<bool>,
}

impl Kinematics<3> for Poisoned {
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        if self.open.get() {
            return None;
        }
        let mut pose = self.arm.pose(angles)?;
        if let Some(bad) = self.with.get() {
            pose.jacobian[1].y = bad;
            pose.position.x = bad;
        }
        Some(pose)
    }
}

/// The wall, with a switch that turns a bit of its table.
#[derive(Debug)]
pub struct Decayed {
    wall: &'static SplinePatch<'static>,
    /// The CRC that it carries.
    pub baked: Option<u32>,
    /// Which one.
    pub bit: Cell<Option<u32>>,
}

impl Patch for Decayed {
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
        self.wall.evaluate(u, v)
    }
    fn bounds(&self) -> SecondDerivativeBounds {
        self.wall.bounds()
    }
    fn orientation(&self) -> f32 {
        self.wall.orientation()
    }
    fn size(&self) -> f32 {
        self.wall.size()
    }
    fn table_word(&self, index: usize) -> Option<u32> {
        let word = self.wall.table_word(index)?;
        // 27 words: 11 of the record, two borders of two, four coefficients of three.
        let turned = self.bit.get().is_some_and(|bit| bit / 32 == index as u32);
        Some(if turned { word ^ (1 << (self.bit.get().unwrap_or(0) % 32)) } else { word })
    }
    fn baked_crc(&self) -> Option<u32> {
        self.baked
    }
}

/// A loop in which either can be harmed.
pub type TestServo<'a> = Servo<'a, OnePatch<Decayed>, Poisoned, 3>;

/// WoodenHaptics, on such an arm.
pub fn device() -> Device<Poisoned, 3> {
    let preset = WOODEN_HAPTICS_2016;
    Device {
        kinematics: Poisoned { arm: preset.kinematics, with: Cell::new(None), open: Cell::new(false) },
        encoders: preset.encoders,
        motors: preset.motors,
        feeds: preset.feeds,
        dry_friction_n_m: preset.dry_friction_n_m,
        min_margin_m_per_rad: preset.min_margin_m_per_rad,
        joint_range_rad: preset.joint_range_rad,
        max_joint_rate_rad_per_s: preset.max_joint_rate_rad_per_s,
        max_force_n: preset.max_force_n,
        max_stiffness_n_per_m: preset.max_stiffness_n_per_m,
        max_damping_n_s_per_m: preset.max_damping_n_s_per_m,
    }
}

/// The wall, sound so far.
pub fn decayed() -> OnePatch<Decayed> {
    OnePatch(Decayed { wall: &WALL, baked: Some(WALL.table_crc()), bit: Cell::new(None) })
}

/// Everything watched.
pub fn safety(output: SafeOutput) -> Safety {
    Safety {
        output,
        max_overruns: 0,
        link_timeout_s: LINK_TICKS as f32 / RATE as f32,
        settle_ticks: 200,
        wait_for_homing: true,
        checks_tables: true,
        stuck: Some(StuckLimits::DEFAULT),
        contact: Some(ContactLimits::DEFAULT),
    }
}
