//! A patch on a grid, as its size and its shape are looked at.

use super::axis::Axis;
use super::jet::Jet;
use super::patch::NurbsPatch;
use glam::DVec3;

impl NurbsPatch {
    /// The largest side of the bounding box of a grid of points on the patch, 8 to a span, metres.
    pub fn size(&self) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        self.for_each_sample(8, |_, surface| {
            low = low.min(surface.point);
            high = high.max(surface.point);
            true
        });
        (high - low).max_element()
    }

    /// Evaluates a grid of `steps` intervals a span, borders included, until `visit` says false.
    pub(super) fn for_each_sample(&self, steps: usize, mut visit: impl FnMut([f64; 2], &Jet) -> bool) {
        let parameters = |axis| {
            let borders = self.borders(axis);
            let inside = |pair: &[f64]| {
                let (left, width) = (pair[0], pair[1] - pair[0]);
                (0..steps).map(move |step| left + width * step as f64 / steps as f64)
            };
            borders.windows(2).flat_map(inside).chain([1.0]).collect::<Vec<_>>()
        };
        let along_v = parameters(Axis::V);
        for u in parameters(Axis::U) {
            for &v in &along_v {
                if !visit([u, v], &Jet::of(self, u, v)) {
                    return;
                }
            }
        }
    }
}
