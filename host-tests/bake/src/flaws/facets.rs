//! Patches as triangles: watertight where the patches are, for neighbours have the same spans along the edge they
//! share.

use crate::Axis;
use crate::jet::Jet;
use crate::parallel;
use crate::patch::NurbsPatch;
use glam::DVec3;

/// A cell of a patch, two triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Its corners: `u` low and high, `v` low first.
    pub corners: [DVec3; 4],
    /// Its middle.
    pub parameters: [f64; 2],
    pub low: DVec3,
    pub high: DVec3,
}

/// The cells of all patches.
pub(super) struct Facets {
    pub patches: Vec<Vec<Cell>>,
    pub boxes: Vec<[DVec3; 2]>,
}

/// Cells a span along each parameter, of a body with few spans; and how many cells a body has at most, some seconds'
/// work.
const FINEST: usize = 8;
const MOST_CELLS: usize = 1 << 18;

impl Facets {
    pub(super) fn of(patches: &[NurbsPatch]) -> Self {
        let spans = |patch: &NurbsPatch, axis| patch.borders(axis).len() - 1;
        let all: usize = patches.iter().map(|patch| spans(patch, Axis::U) * spans(patch, Axis::V)).sum();
        let steps = (1..=FINEST).rev().find(|steps| all * steps * steps <= MOST_CELLS).unwrap_or(1);
        let patches = parallel::map(patches, |_, patch| cells(patch, steps));
        let bound = |cells: &Vec<Cell>| {
            let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            cells.iter().fold(empty, |[low, high], cell| [low.min(cell.low), high.max(cell.high)])
        };
        let boxes = patches.iter().map(bound).collect();
        Self { patches, boxes }
    }
}

impl Cell {
    /// Its triangles, in the sense of `f_u × f_v`.
    pub(super) const fn triangles(&self) -> [[DVec3; 3]; 2] {
        let [a, b, c, d] = self.corners;
        [[a, c, d], [a, d, b]]
    }
}

fn cells(patch: &NurbsPatch, steps: usize) -> Vec<Cell> {
    let along = |axis| -> Vec<f64> {
        let borders = patch.borders(axis);
        let inside = |pair: &[f64]| {
            let (start, width) = (pair[0], pair[1] - pair[0]);
            (0..steps).map(move |k| start + width * k as f64 / steps as f64)
        };
        borders.windows(2).flat_map(inside).chain([1.0]).collect()
    };
    let (along_u, along_v) = (along(Axis::U), along(Axis::V));
    let rows: Vec<Vec<DVec3>> =
        along_u.iter().map(|u| along_v.iter().map(|v| Jet::of(patch, *u, *v).point).collect()).collect();
    let mut cells = Vec::with_capacity((along_u.len() - 1) * (along_v.len() - 1));
    for (i, pair_u) in along_u.windows(2).enumerate() {
        for (j, pair_v) in along_v.windows(2).enumerate() {
            let corners = [rows[i][j], rows[i][j + 1], rows[i + 1][j], rows[i + 1][j + 1]];
            let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
            let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
            let parameters = [0.5 * (pair_u[0] + pair_u[1]), 0.5 * (pair_v[0] + pair_v[1])];
            cells.push(Cell { corners, parameters, low, high });
        }
    }
    cells
}
