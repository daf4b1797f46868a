//! Which parts of a body can hold the point nearest to a core: a walk over the cells of all faces.
//!
//! A cell is a square of a face's parameters. From one evaluation in its middle and the bounds of the second
//! derivatives follow a ball that holds it, and with `π` the projection on the convex core, `ΔR = f − π(f)`, bounds of
//! the derivatives `ΔR · f_u`, since `ΔR` moves by no more than `f`. A cell is left out if the ball is farther than the
//! bound, or if a derivative cannot vanish in it and no border of the face is in the way; otherwise it is split, and at
//! last the descent starts from its middle.

use super::step::{Foot, Pair, patch_of};
use super::tool::Region;
use crate::body::Body;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::patch::{Patch as _, SecondDerivativeBounds};
use crate::track::Placement;

/// How often a face is halved: cells of a sixteenth.
const MAX_LEVEL: u8 = 4;

/// The next cell: a face, and a path in its quad-tree, two bits a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells {
    face: u16,
    level: u8,
    path: u16,
}

/// Result of a visit.
pub(super) enum Visit {
    /// Nothing here; other cells follow.
    Nothing,
    /// A minimum nearer than the bound may be here.
    Start(Pair),
    /// The last cell has been visited.
    End,
}

impl Cells {
    /// All of the first face.
    pub const START: Self = Self { face: 0, level: 0, path: 0 };

    /// Looks at the next cell, with one evaluation of the body and one projection on the core.
    pub fn visit(&mut self, body: &Body, region: &Region, placement: &Placement, bound: f32) -> Visit {
        if usize::from(self.face) >= body.faces().len() {
            *self = Self::START;
            return Visit::End;
        }
        let [middle, half] = self.square();
        let pair = Pair::facing(Foot::on(body, self.face, middle), region, placement);
        let (surface, difference) = (&pair.a.curved.surface, pair.difference(placement));
        let SecondDerivativeBounds { uu, uv, vv } = patch_of(body, self.face).bounds();
        let [f_u, f_v] = [surface.tangent_u, surface.tangent_v];
        let length = |tangent: Vec3| sqrt_from_above(tangent.length_squared());
        let half = half[0];
        let turn = [(uu + uv) * half, (uv + vv) * half];
        let reach = half * (length(f_u) + length(f_v) + 0.5 * (turn[0] + turn[1]));
        let distance = sqrt(difference.length_squared());
        if distance - reach > bound {
            self.skip();
            return Visit::Nothing;
        }
        // Nearest points inside a core that is a body jump: only its outside counts.
        let is_outside = match region {
            Region::Solid { .. } => true,
            Region::Surface(core) => pair.b.normal(core).dot(placement.direction_to_b(difference)) > 0.0,
        };
        let excludes = |axis: usize, tangent: Vec3| {
            let slope = difference.dot(tangent);
            let change = reach * (length(tangent) + turn[axis]) + distance * turn[axis];
            let (low, high) = (middle[axis] - half, middle[axis] + half);
            (slope > change && low > 0.0) || (slope < -change && high < 1.0)
        };
        if is_outside && (excludes(0, f_u) || excludes(1, f_v)) {
            self.skip();
            return Visit::Nothing;
        }
        if self.level < MAX_LEVEL {
            (self.level, self.path) = (self.level + 1, self.path << 2);
            return Visit::Nothing;
        }
        self.skip();
        Visit::Start(pair)
    }

    /// Whether a point is in the cell that the last visit started from.
    pub fn holds(start: &Foot, foot: &Foot) -> bool {
        let half = Self::half(MAX_LEVEL);
        let is_near = |axis: usize| (start.parameters[axis] - foot.parameters[axis]).abs() <= half;
        start.face == foot.face && is_near(0) && is_near(1)
    }

    fn half(level: u8) -> f32 {
        0.5 / f32::from(1_u16 << level)
    }

    /// The middle, and half the sides.
    fn square(&self) -> [[f32; 2]; 2] {
        let half = Self::half(self.level);
        let mut corner = [0_u16; 2];
        for level in 0..self.level {
            for (axis, at) in corner.iter_mut().enumerate() {
                *at |= (self.path >> (2 * level + axis as u8) & 1) << level;
            }
        }
        [corner.map(|at| f32::from(2 * at + 1) * half), [half; 2]]
    }

    /// To the next cell that is not inside this one.
    fn skip(&mut self) {
        self.path += 1;
        while self.level > 0 && self.path & 3 == 0 {
            (self.level, self.path) = (self.level - 1, self.path >> 2);
        }
        if self.level == 0 {
            *self = Self { face: self.face + 1, ..Self::START };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cells_of_a_level_cover_a_face_once() {
        let mut cells = Cells { level: MAX_LEVEL, ..Cells::START };
        let mut seen = [[0_u8; 16]; 16];
        while cells.face == 0 {
            if cells.level < MAX_LEVEL {
                (cells.level, cells.path) = (cells.level + 1, cells.path << 2);
                continue;
            }
            let [[u, v], _] = cells.square();
            seen[(u * 16.0) as usize][(v * 16.0) as usize] += 1;
            cells.skip();
        }
        assert!(seen.as_flattened().iter().all(|times| *times == 1), "{seen:?}");
    }
}
