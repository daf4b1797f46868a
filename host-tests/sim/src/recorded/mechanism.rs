//! A mechanism that is known only when the program runs.

use crate::recorded::walk::Walk;
use palpate::device::{Delta, FiveBar, Kinematics, LinkMass, LinkageArm, ProbePose, SerialArm};
use palpate::math::{Vec2, Vec3};

/// One of those with three joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mechanism {
    /// See [`SerialArm`].
    Serial(SerialArm),
    /// See [`LinkageArm`].
    Linkage(LinkageArm),
    /// See [`Delta`].
    Delta(Delta),
}

impl From<SerialArm> for Mechanism {
    fn from(arm: SerialArm) -> Self {
        Self::Serial(arm)
    }
}

impl From<LinkageArm> for Mechanism {
    fn from(arm: LinkageArm) -> Self {
        Self::Linkage(arm)
    }
}

impl From<Delta> for Mechanism {
    fn from(delta: Delta) -> Self {
        Self::Delta(delta)
    }
}

impl Kinematics<3> for Mechanism {
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        match self {
            Self::Serial(arm) => arm.pose(angles),
            Self::Linkage(arm) => arm.pose(angles),
            Self::Delta(delta) => delta.pose(angles),
        }
    }

    fn held_pose(&self, angles: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
        match self {
            Self::Serial(arm) => arm.held_pose(angles),
            Self::Linkage(arm) => arm.held_pose(angles),
            Self::Delta(delta) => delta.held_pose(angles),
        }
    }
}

const SERIAL: SerialArm = SerialArm {
    base_height_m: 0.0,
    first_link_m: 0.0,
    second_link_m: 0.0,
    workspace_centre_m: Vec3::ZERO,
    end_masses_kg: [0.0; 2],
};

const LINKAGE: LinkageArm = LinkageArm {
    linkage: FiveBar {
        second_pivot_m: 0.0,
        cranks_m: [0.0; 2],
        rods_m: [0.0; 2],
        side: 0.0,
        tool_m: 0.0,
        workspace_centre_m: Vec2::ZERO,
    },
    pivot_reach_m: 0.0,
    workspace_centre_m: Vec3::ZERO,
    masses: [LinkMass { mass_kg: 0.0, along_m: 0.0, across_m: 0.0 }; 4],
};

const DELTA: Delta = Delta {
    thigh_m: 0.0,
    shin_m: 0.0,
    stub_m: 0.0,
    reach_m: 0.0,
    side_m: 0.0,
    directions: [[0.0; 2]; 3],
    workspace_centre_m: Vec3::ZERO,
    up: Vec3::ZERO,
    carried_mass_kg: 0.0,
    thigh_moment_kg_m: 0.0,
};

impl Mechanism {
    /// One that has no length yet.
    pub const VACANT: Self = Self::Serial(SERIAL);

    pub(crate) fn walk(&mut self, walk: &mut impl Walk) {
        let kind = match self {
            Self::Serial(_) => 0,
            Self::Linkage(_) => 1,
            Self::Delta(_) => 2,
        };
        let wanted = walk.count(kind);
        if wanted != kind {
            *self = match wanted {
                0 => Self::Serial(SERIAL),
                1 => Self::Linkage(LINKAGE),
                _ => Self::Delta(DELTA),
            };
        }
        match self {
            Self::Serial(arm) => serial(walk, arm),
            Self::Linkage(arm) => linkage(walk, arm),
            Self::Delta(of) => delta(walk, of),
        }
    }
}

// Each takes its struct apart whole: a field that is added and forgotten here does not compile.

fn serial(walk: &mut impl Walk, arm: &mut SerialArm) {
    let SerialArm {
        base_height_m: base_height,
        first_link_m: first_link,
        second_link_m: second_link,
        workspace_centre_m: workspace_centre,
        end_masses_kg: end_masses,
    } = arm;
    for length in [base_height, first_link, second_link] {
        walk.number(length);
    }
    walk.vector(workspace_centre);
    walk.numbers(end_masses);
}

fn linkage(walk: &mut impl Walk, arm: &mut LinkageArm) {
    let LinkageArm { linkage, pivot_reach_m: pivot_reach, workspace_centre_m: workspace_centre, masses } = arm;
    let FiveBar {
        second_pivot_m: second_pivot,
        cranks_m: cranks,
        rods_m: rods,
        side,
        tool_m: tool,
        workspace_centre_m: middle,
    } = linkage;
    walk.number(second_pivot);
    walk.numbers(cranks);
    walk.numbers(rods);
    for number in [side, tool] {
        walk.number(number);
    }
    walk.flat(middle);
    walk.number(pivot_reach);
    walk.vector(workspace_centre);
    for LinkMass { mass_kg: mass, along_m: along, across_m: across } in masses {
        for number in [mass, along, across] {
            walk.number(number);
        }
    }
}

fn delta(walk: &mut impl Walk, of: &mut Delta) {
    let Delta {
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
    } = of;
    for length in [thigh, shin, stub, reach, side] {
        walk.number(length);
    }
    for direction in directions {
        walk.numbers(direction);
    }
    walk.vector(workspace_centre);
    walk.vector(up);
    for number in [carried_mass, thigh_moment] {
        walk.number(number);
    }
}
