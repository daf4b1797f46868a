//! The frame of the tables: near the body, wherever that lies in its file.
//!
//! Single precision knows a coordinate to 6e-8 of itself, so that a body far from its origin would lose digits. Its
//! centre is taken off in double precision before anything is rounded, and is kept: what asks in the file's frame takes
//! it off too.

use super::axis::Axis;
use super::error::{ModelError, PatchFault};
use super::patch::NurbsPatch;
use super::topology::TOLERANCE;
use glam::DVec3;

/// A body with no coordinate beyond this many of its sizes stays in the frame of its file: the step of `f32` there is
/// at most 1.8e-7 of the size.
const NEAR: f64 = 1.5;

/// Beyond this many sizes the nine digits that an answer in the file's frame has leave 5e-6 of the size, and the file's
/// own digits hardly more.
const FARTHEST: f64 = 1e3;

/// The centre is a multiple of at most this share of the size. It then has a dozen bits: it is exact in `f32`, and
/// taking it off rounds nothing.
const GRAIN: f64 = 0.125;

/// A patch smaller than this share of the body is lost between the steps of `f32`, 3e-8 of it, and the tolerance at
/// which borders are one, 1e-6.
const LEAST_SHARE: f64 = 1e-5;

/// Takes the body's centre off its patches, where it lies far from the origin, and says where it was, metres.
pub(super) fn centred(patches: &mut [NurbsPatch], file: impl Fn() -> String) -> Result<DVec3, ModelError> {
    let points = || patches.iter().flat_map(|patch| &patch.points);
    let low = points().fold(DVec3::INFINITY, |low, point| low.min(*point));
    let high = points().fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
    let size = (high - low).max_element();
    for (index, patch) in patches.iter().enumerate() {
        if let Err(fault) = check_beside(patch, size) {
            let patch = patch.name.as_ref().map_or_else(|| index.to_string(), |name| format!("\"{name}\""));
            return Err(ModelError::Patch { file: file(), patch, fault });
        }
    }
    let farthest = low.abs().max(high.abs()).max_element();
    if farthest > FARTHEST * size {
        return Err(ModelError::FarAway { file: file(), distance: farthest, size, limit: FARTHEST });
    }
    if farthest <= NEAR * size {
        return Ok(DVec3::ZERO);
    }
    let grain = (GRAIN * size).log2().floor().exp2();
    // The sum makes 0 of -0.
    let centre = (0.5 * (low + high) / grain).round() * grain + DVec3::ZERO;
    patches.iter_mut().flat_map(|patch| &mut patch.points).for_each(|point| *point -= centre);
    Ok(centre)
}

/// Checks that a patch can be told from nothing beside a body of some size.
fn check_beside(patch: &NurbsPatch, body: f64) -> Result<(), PatchFault> {
    let size = patch.size();
    if size < LEAST_SHARE * body {
        return Err(PatchFault::Tiny { size, body, share: LEAST_SHARE });
    }
    let tolerance = TOLERANCE * body;
    for axis in [Axis::U, Axis::V] {
        let width = longest_polygon(patch, axis);
        if width <= tolerance {
            return Err(PatchFault::Sliver { axis, width, tolerance });
        }
    }
    Ok(())
}

/// No curve of a patch along a parameter is longer than the longest of its control polygons.
fn longest_polygon(patch: &NurbsPatch, axis: Axis) -> f64 {
    let (rows, columns) = (patch.counts[0], patch.counts[1]);
    let (lines, count) = if axis == Axis::U { (columns, rows) } else { (rows, columns) };
    let at =
        |line: usize, k: usize| patch.points[if axis == Axis::U { k * columns + line } else { line * columns + k }];
    let length = |line: usize| (1..count).map(|k| at(line, k).distance(at(line, k - 1))).sum::<f64>();
    (0..lines).map(length).fold(0.0, f64::max)
}
