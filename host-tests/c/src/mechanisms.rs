//! The mechanisms as numbers.

use crate::pointers::{Plain, finite};
use crate::status::Status;
use palpate_core::device::{Delta, FiveBar, LinkMass, LinkageArm, Paddle, SerialArm};
use palpate_core::math::{Vec3, vec2};

/// A mechanism as numbers.
pub trait MechanismNumbers: Plain {
    /// The kind of mechanism.
    type Mechanism;

    /// The mechanism, or the status of a wrong number.
    fn mechanism(&self) -> Result<Self::Mechanism, Status>;
}

/// A turntable with a parallelogram of two links.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SerialArmNumbers {
    pub base_height: f32,
    pub first_link: f32,
    pub second_link: f32,
    pub workspace_centre: [f32; 3],
    pub end_masses: [f32; 2],
}

/// Three legs with parallelograms.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct DeltaNumbers {
    pub thigh: f32,
    pub shin: f32,
    pub stub: f32,
    pub reach: f32,
    pub side: f32,
    pub directions: [[f32; 2]; 3],
    pub workspace_centre: [f32; 3],
    pub up: [f32; 3],
    pub carried_mass: f32,
    pub thigh_moment: f32,
}

/// Two cranks and two rods in a plane.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct FiveBarNumbers {
    pub second_pivot: f32,
    pub cranks: [f32; 2],
    pub rods: [f32; 2],
    pub side: f32,
    pub tool: f32,
    pub workspace_centre: [f32; 2],
}

/// A turntable that carries an upright five-bar.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct LinkageArmNumbers {
    pub linkage: FiveBarNumbers,
    pub pivot_reach: f32,
    pub workspace_centre: [f32; 3],
    pub masses: [[f32; 3]; 4],
}

/// A lever with one motor.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PaddleNumbers {
    pub handle: f32,
    pub mass_moment: f32,
}

// SAFETY: floats alone.
unsafe impl Plain for SerialArmNumbers {}
// SAFETY: floats alone.
unsafe impl Plain for DeltaNumbers {}
// SAFETY: floats alone.
unsafe impl Plain for FiveBarNumbers {}
// SAFETY: floats alone.
unsafe impl Plain for LinkageArmNumbers {}
// SAFETY: floats alone.
unsafe impl Plain for PaddleNumbers {}

impl MechanismNumbers for SerialArmNumbers {
    type Mechanism = SerialArm;

    fn mechanism(&self) -> Result<SerialArm, Status> {
        let Self { base_height, first_link, second_link, workspace_centre, end_masses } = *self;
        finite(&[base_height, first_link, second_link])?;
        finite(&workspace_centre)?;
        finite(&end_masses)?;
        let workspace_centre = Vec3::from_array(workspace_centre);
        Ok(SerialArm {
            base_height_m: base_height,
            first_link_m: first_link,
            second_link_m: second_link,
            workspace_centre_m: workspace_centre,
            end_masses_kg: end_masses,
        })
    }
}

impl MechanismNumbers for DeltaNumbers {
    type Mechanism = Delta;

    fn mechanism(&self) -> Result<Delta, Status> {
        let Self { thigh, shin, stub, reach, side, directions, workspace_centre, up, carried_mass, thigh_moment } =
            *self;
        finite(&[thigh, shin, stub, reach, side, carried_mass, thigh_moment])?;
        finite(directions.as_flattened())?;
        finite(&workspace_centre)?;
        finite(&up)?;
        let (workspace_centre, up) = (Vec3::from_array(workspace_centre), Vec3::from_array(up));
        Ok(Delta {
            thigh_m: thigh,
            shin_m: shin,
            stub_m: stub,
            reach_m: reach,
            side_m: side,
            directions,
            workspace_centre_m: workspace_centre,
            up,
            carried_mass_kg: carried_mass,
            thigh_moment_kg_m: thigh_moment,
        })
    }
}

impl MechanismNumbers for FiveBarNumbers {
    type Mechanism = FiveBar;

    fn mechanism(&self) -> Result<FiveBar, Status> {
        let Self { second_pivot, cranks, rods, side, tool, workspace_centre: [x, y] } = *self;
        finite(&[second_pivot, side, tool, x, y])?;
        finite(&cranks)?;
        finite(&rods)?;
        Ok(FiveBar {
            second_pivot_m: second_pivot,
            cranks_m: cranks,
            rods_m: rods,
            side,
            tool_m: tool,
            workspace_centre_m: vec2(x, y),
        })
    }
}

impl MechanismNumbers for LinkageArmNumbers {
    type Mechanism = LinkageArm;

    fn mechanism(&self) -> Result<LinkageArm, Status> {
        finite(&[self.pivot_reach])?;
        finite(&self.workspace_centre)?;
        finite(self.masses.as_flattened())?;
        Ok(LinkageArm {
            linkage: self.linkage.mechanism()?,
            pivot_reach_m: self.pivot_reach,
            workspace_centre_m: Vec3::from_array(self.workspace_centre),
            masses: self.masses.map(|[mass, along, across]| LinkMass {
                mass_kg: mass,
                along_m: along,
                across_m: across,
            }),
        })
    }
}

impl MechanismNumbers for PaddleNumbers {
    type Mechanism = Paddle;

    fn mechanism(&self) -> Result<Paddle, Status> {
        let Self { handle, mass_moment } = *self;
        finite(&[handle, mass_moment])?;
        Ok(Paddle { handle_m: handle, mass_moment_kg_m: mass_moment })
    }
}
