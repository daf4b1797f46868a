//! The schema of a `device.toml`: see `docs/reference/device-format.md`. SI units throughout.

use alloc::borrow::ToOwned as _;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// A device file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceFile {
    /// Its name.
    pub name: String,
    /// By what its board finds where the joints are.
    #[serde(default)]
    pub homing: HomingEntry,
    /// The mechanism.
    pub mechanism: MechanismEntry,
    /// The limits of the whole device.
    pub limits: LimitsEntry,
    /// Its three joints, in the mechanism's order.
    pub joint: Vec<JointEntry>,
}

impl DeviceFile {
    /// The message, which may start with "joint 1:", with that joint's name, if no other has the same.
    pub fn by_name(&self, message: &str) -> String {
        let joint = message.strip_prefix("joint ").and_then(|rest| rest.split_once(':')).and_then(|(number, rest)| {
            let JointEntry { name, .. } = self.joint.get(number.parse::<usize>().ok()?)?;
            let is_own = !name.is_empty() && self.joint.iter().filter(|joint| joint.name == *name).count() == 1;
            is_own.then(|| format!("joint {name}:{rest}"))
        });
        joint.unwrap_or_else(|| message.to_owned())
    }
}

/// By what a board finds where the joints are: what the encoders' zeroes are the angles of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum HomingEntry {
    /// The counters start anywhere, and the hand holds the device in a pose: `zero` is the angle there.
    #[default]
    Pose,
    /// The same, and the hand moves each joint past its index mark: `zero` is the angle there.
    Index,
    /// By nothing: the counters know it, and `zero` is the angle where they are zero.
    None,
}

/// The mechanism and its lengths, metres.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MechanismEntry {
    /// [`palpate::device::SerialArm`].
    SerialArm {
        /// Of the first link's axis.
        base_height: f64,
        /// Length.
        first_link: f64,
        /// Length.
        second_link: f64,
        /// From the foot of the turntable.
        workspace_centre: [f64; 3],
        /// Mass that each link lifts, referred to its end, kg.
        #[serde(default)]
        end_masses: [f64; 2],
    },
    /// [`palpate::device::LinkageArm`].
    LinkageArm(LinkageEntry),
    /// [`palpate::device::Delta`].
    Delta {
        /// Length.
        thigh: f64,
        /// Length.
        shin: f64,
        /// Both together.
        stub: f64,
        /// Of a hip less that of a shin's end on the plate.
        reach: f64,
        /// The same to the left.
        side: f64,
        /// Directions of the legs about z, rad.
        legs: [f64; 3],
        /// Of the workspace's centre before the base.
        workspace_depth: f64,
        /// Hangs on the probe, half the shins included, kg.
        #[serde(default)]
        carried_mass: f64,
        /// Of a thigh, kg·m.
        #[serde(default)]
        thigh_moment: f64,
    },
}

impl MechanismEntry {
    /// The entry that places the centre of the workspace.
    pub const fn centre(&self) -> &'static str {
        match self {
            Self::SerialArm { .. } | Self::LinkageArm(_) => "mechanism.workspace_centre",
            Self::Delta { .. } => "mechanism.workspace_depth",
        }
    }
}

/// A linkage on a turntable, lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LinkageEntry {
    /// On the x axis.
    pub second_pivot: f64,
    /// Lengths.
    pub cranks: [f64; 2],
    /// Lengths.
    pub rods: [f64; 2],
    /// 1 or −1.
    pub side: f64,
    /// From the first elbow towards the hinge.
    pub tool: f64,
    /// From the turntable's axis.
    pub pivot_reach: f64,
    /// From the foot of the first crank's pivot on the axis.
    pub workspace_centre: [f64; 3],
    /// First crank, second crank, first rod, second rod.
    #[serde(default)]
    pub masses: Option<[MassEntry; 4]>,
}

/// A link's mass, kg, and where its centre lies, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MassEntry {
    /// kg.
    pub mass: f64,
    /// Along the link.
    pub along: f64,
    /// To the left of it.
    pub across: f64,
}

/// The limits of the whole device.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LimitsEntry {
    /// m/rad.
    pub min_margin: f64,
    /// rad/s: a faster motion is a sensor fault.
    pub max_joint_rate: f64,
    /// N.
    pub max_force: f64,
    /// N/m.
    pub max_stiffness: f64,
    /// N·s/m.
    pub max_damping: f64,
    /// m/s, while force is given.
    #[serde(default = "default_speed")]
    pub max_probe_speed: f64,
}

fn default_speed() -> f64 {
    1.5
}

/// A joint.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct JointEntry {
    /// Its name.
    pub name: String,
    /// Minimum and maximum angle, rad.
    pub range: [f64; 2],
    /// Dry friction, N·m.
    #[serde(default)]
    pub friction: f64,
    /// Moment of inertia that turns with it, kg·m²; without it there is no polarity check.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f64>,
    /// Its encoder.
    pub encoder: EncoderEntry,
    /// Its motor.
    pub motor: MotorEntry,
}

/// A joint's encoder.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct EncoderEntry {
    /// Which of the board's encoder inputs it is on, from 0.
    pub channel: usize,
    /// Counts a turn of its shaft, after quadrature.
    pub counts: f64,
    /// Turns of its shaft for one of the joint; negative where it counts the other way.
    pub ratio: f64,
    /// Joint angle at which the count steps from −1 to 0, rad.
    #[serde(default)]
    pub zero: f64,
}

/// A joint's motor.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MotorEntry {
    /// Which of the board's motor outputs it is on, from 0.
    pub channel: usize,
    /// N·m/A.
    pub torque_constant: f64,
    /// A.
    pub current_at_full: f64,
    /// Turns of the motor for one of the joint; negative where it turns it the other way.
    pub ratio: f64,
    /// Continuous current, A.
    pub continuous_current: f64,
    /// Of its winding, s.
    pub time_constant: f64,
    /// Maximum speed of its joint under force, rad/s.
    pub max_rate: f64,
    /// The supply of a bridge without a current loop, V.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bridge: Option<BridgeEntry>,
}

/// A bridge that gives a voltage.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct BridgeEntry {
    /// V.
    pub supply: f64,
    /// Of winding, brushes and bridge, ohms.
    pub resistance: f64,
    /// Of the winding, H; only the simulated plant has it. By default 1 mH.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inductance: Option<f64>,
    /// How much of the back-EMF is made up for, 0 to 1.
    pub back_emf_share: f64,
}
