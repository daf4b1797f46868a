//! The locator that needs no proof: every face is a candidate everywhere.

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
    /// One node whose cells all list the whole of every face: complete for any probe, and nothing is said of convexity. The cube
    /// holds the body with half its size to spare on every side.
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

    /// The locator as the firmware has it; its numbers stay allocated for good.
    pub fn to_locator(&self) -> Locator {
        Locator {
            corner: self.corner,
            side: self.side,
            nodes: self.nodes.clone().leak(),
            entries: self.entries.clone().leak(),
        }
    }
}
