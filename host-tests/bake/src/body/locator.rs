//! The locator that needs no proof: every face is a candidate everywhere.

use super::BakedFace;
use crate::locator::{self, BakedLocator, LocatorError, LocatorOptions, LocatorReport, Seams, StoredSurface};
use crate::{Axis, BakedPatch};
use glam::DVec3;
use palpate::body::{Candidate, GRID, LEAF, Locator};
use palpate::math::Vec3;

/// [`palpate::body::Locator`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub struct LocatorTable {
    /// The lower corner of the root cube, metres.
    pub corner: Vec3,
    /// The root cube's side, metres.
    pub side: f32,
    /// Inner nodes.
    pub nodes: Vec<[u16; 8]>,
    /// Packed candidates.
    pub entries: Vec<u32>,
}

impl LocatorTable {
    /// One node whose cells all list the whole of every face: complete for any probe, and nothing is said of convexity.
    /// The cube holds the body with half its size to spare on every side.
    pub fn of_everything(faces: usize, low: [f64; 3], high: [f64; 3]) -> Self {
        let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let corner = Vec3::from_array([0, 1, 2].map(|axis| (0.5 * (low[axis] + high[axis]) - size) as f32));
        let all = [GRID as u8; 2];
        let entry = |face: usize| Candidate {
            face: face as u16,
            lower: [0; 2],
            upper: all,
            convex: false,
            more: face + 1 < faces,
        };
        let entries = (0..faces).map(|face| entry(face).pack()).collect();
        Self { corner, side: (2.0 * size) as f32, nodes: vec![[LEAF; 8]], entries }
    }

    /// The locator of these faces, proved cell by cell as far as it goes; see [`locator`].
    pub(super) fn of_faces(
        faces: &[BakedFace],
        size: f64,
        options: &LocatorOptions,
        wanted: Option<&[DVec3]>,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(Self, LocatorReport), LocatorError> {
        let patches: Vec<BakedPatch> = faces.iter().map(|face| face.patch.clone()).collect();
        let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
        let seams = Seams::find(&surfaces, options.seam * size);
        let creases: Vec<_> =
            faces.iter().map(|face| [Axis::U, Axis::V].map(|axis| face.surface.creases(axis))).collect();
        let baked = locator::bake(&patches, seams, &creases, options, wanted, progress)?;
        let BakedLocator { corner, side, nodes, entries, report } = baked;
        Ok((Self { corner, side, nodes, entries }, report))
    }

    /// The locator as the firmware has it; its numbers stay allocated for good.
    pub fn to_locator(&self) -> Locator<'static> {
        Locator {
            corner: self.corner,
            side: self.side,
            nodes: self.nodes.clone().leak(),
            entries: self.entries.clone().leak(),
        }
    }
}
