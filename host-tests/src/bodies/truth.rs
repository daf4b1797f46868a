//! The closest point of a whole body, in double precision.

use crate::bake::NurbsPatch;
use crate::oracle::{ClosestPoint, Oracle, Surface};
use glam::DVec3;

/// One oracle a patch.
#[derive(Clone, Debug)]
pub struct BodyOracle<'a> {
    patches: &'a [NurbsPatch],
    oracles: Vec<Oracle<'a>>,
}

/// What is true of a probe.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The closest point of each patch.
    pub feet: Vec<ClosestPoint>,
    /// Index of the patch with the nearest.
    pub nearest: usize,
    /// Height of the probe over each patch's foot along the outward normal there, metres. At a pole, where there is no normal, NaN.
    pub heights: Vec<f64>,
}

impl Truth {
    /// The body's distance, metres.
    pub fn distance(&self) -> f64 {
        self.feet[self.nearest].distance
    }

    /// The closest point.
    pub fn point(&self) -> DVec3 {
        self.feet[self.nearest].point
    }

    /// Whether the probe is inside a closed convex body: behind every face.
    pub fn is_inside_convex(&self) -> bool {
        self.heights.iter().all(|height| height.is_nan() || *height < 0.0)
    }
}

impl<'a> BodyOracle<'a> {
    /// Samples every patch.
    pub fn new(patches: &'a [NurbsPatch]) -> Self {
        Self { patches, oracles: patches.iter().map(Oracle::new).collect() }
    }

    /// The truth about a probe, metres.
    pub fn closest(&self, probe: DVec3) -> Truth {
        let feet: Vec<_> = self.oracles.iter().map(|oracle| oracle.closest(probe)).collect();
        let nearest = (0..feet.len())
            .fold(0, |best, index| if feet[index].distance < feet[best].distance { index } else { best });
        let height = |(patch, foot): (&NurbsPatch, &ClosestPoint)| {
            let [u, v] = foot.parameters;
            (probe - foot.point).dot(Surface::evaluate(patch, u, v).normal(patch.flip))
        };
        let heights = self.patches.iter().zip(&feet).map(height).collect();
        Truth { feet, nearest, heights }
    }
}
