//! Proved bounds of a baked patch's curvature and stretch.
//!
//! # Why it is a proof
//! - It is of the surface the target has: the stored `f32` coefficients over each span as the target's subtraction sees
//!   it.
//! - `super::cell` turns the span into polynomials, and bounds what curvature and stretch can be on a cell by Taylor
//!   forms (`super::form`) that enclose, rounding included. Halving a cell keeps that.
//! - The bound of a patch is the worst of its cells. Cells are halved until their bound is within [`SLACK`] of a value
//!   that is taken, or [`HALVINGS`] times, or until the span's share of [`CELLS`] is used up: the bound is then looser,
//!   never wrong.
//! - Where the tangents are not proved to span a plane there is no curvature to bound: near a pole the bound is
//!   infinite.
//!
//! Across an inner knot the curvature may jump, and both sides are bounded. A crease (the patch is only C⁰) has none.

use super::bounds::local_range;
use super::cell::{Extremes, FormCell};
use crate::spline::BakedCoefficients;
use palpate::patch::{Curvature, Orientation, SecondDerivativeBounds, ShapeBounds};
use std::collections::VecDeque;

/// How far a bound may lie beyond the values taken, relative to the largest of them in absolute value.
pub const SLACK: f64 = 0.02;
/// How often a cell is halved at most: 9 times along each parameter. A pole's cells, which stay without a bound, are
/// then a 500th of a span wide.
pub const HALVINGS: usize = 18;
/// Cells of a patch, shared by its spans (each has 1024 at least): a few seconds of work for a rational patch of degree
/// 5, hundredths for degree 2.
pub const CELLS: usize = 16_384;
/// A direction that bends inward by less than this, relative to the largest curvature, is straight but for the rounding
/// of the coefficients to `f32` (6e-8 of coordinates that are some ten times what the bending moves them). It is not
/// pursued further, and not called convex.
pub const FLAT: f64 = 1e-6;

/// Bounds of a table's shape, or `None` if a weight is not proved positive.
pub fn prove(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
    orientation: Orientation,
    second_derivatives: SecondDerivativeBounds,
) -> Option<ShapeBounds> {
    let spans_v = breaks[1].len() - 1;
    let spans = (breaks[0].len() - 1) * spans_v;
    let whole = |span: usize| {
        let reach = |axis: usize, index: usize| local_range(breaks[axis][index], breaks[axis][index + 1]);
        let ranges = [reach(0, span / spans_v), reach(1, span % spans_v)];
        FormCell::of_span(degree, &coefficients.homogeneous_span(degree, span), ranges)
    };
    let mut search = Search::new(orientation, second_derivatives);
    for span in 0..spans {
        search.sample(whole(span)?);
    }
    for span in 0..spans {
        search.span(whole(span)?, (CELLS / spans).max(1024));
    }
    Some(search.bounds())
}

/// Bounds proved so far, with respect to the outward normal.
struct Search {
    turn: f64,
    second_derivatives: SecondDerivativeBounds,
    /// Values taken somewhere. They only say when to stop: any would do.
    reached: Extremes,
    /// Bounds of the cells that are done.
    proved: Extremes,
    /// Whether every cell has a curvature.
    bounded: bool,
}

impl Search {
    const NOTHING: Extremes = Extremes {
        curvature: [f64::INFINITY, f64::NEG_INFINITY],
        stretch: [f64::INFINITY, f64::NEG_INFINITY],
        bend: f64::NEG_INFINITY,
    };

    fn new(orientation: Orientation, second_derivatives: SecondDerivativeBounds) -> Self {
        let turn = match orientation {
            Orientation::Outward => 1.0,
            Orientation::Inward => -1.0,
        };
        Self { turn, second_derivatives, reached: Self::NOTHING, proved: Self::NOTHING, bounded: true }
    }

    /// With respect to the outward normal.
    fn outward(&self, extremes: Extremes) -> Extremes {
        let [least, greatest] = extremes.curvature;
        let curvature = if self.turn < 0.0 { [-greatest, -least] } else { [least, greatest] };
        Extremes { curvature, ..extremes }
    }

    /// Values on a grid of 4 × 4 intervals.
    fn sample(&mut self, whole: FormCell) {
        let mut cells = vec![whole];
        for _ in 0..4 {
            cells = cells.iter().flat_map(FormCell::halves).collect();
        }
        cells.iter().for_each(|cell| self.see(cell));
    }

    fn see(&mut self, cell: &FormCell) {
        for sample in cell.samples(&self.second_derivatives) {
            // Comparisons with NaN are false, infinite values of a pole are not wanted either.
            let sample = self.outward(sample);
            let finite = sample.curvature.iter().all(|value| value.is_finite());
            join(&mut self.reached.stretch, sample.stretch);
            if finite && sample.bend.is_finite() {
                join(&mut self.reached.curvature, sample.curvature);
                self.reached.bend = self.reached.bend.max(sample.bend);
            }
        }
    }

    /// Cells in order of size, so that where the budget ends the bounds are about as good everywhere.
    fn span(&mut self, whole: FormCell, budget: usize) {
        let mut open = VecDeque::from([whole]);
        let mut count = 0;
        while let Some(cell) = open.pop_front() {
            count += 1;
            self.see(&cell);
            let (bounds, regular) = cell.bounds(&self.second_derivatives);
            let bounds = self.outward(bounds);
            let last = cell.halvings == HALVINGS || count + open.len() >= budget;
            if last || self.is_good(&bounds, regular) {
                join(&mut self.proved.stretch, bounds.stretch);
                join(&mut self.proved.curvature, bounds.curvature);
                self.proved.bend = self.proved.bend.max(bounds.bend);
                self.bounded &= regular;
            } else {
                open.extend(cell.halves());
            }
        }
    }

    /// Whether halving the cell would not be worth it.
    fn is_good(&self, bounds: &Extremes, regular: bool) -> bool {
        let good_stretch = bounds.stretch[1] <= self.proved.stretch[1].max((1.0 + SLACK) * self.reached.stretch[1])
            && bounds.stretch[0] >= self.proved.stretch[0].min((1.0 - SLACK) * self.reached.stretch[0]);
        if !self.bounded {
            return good_stretch;
        }
        let [least, greatest] = self.reached.curvature;
        let scale = least.abs().max(greatest.abs());
        // Where no value is negative the bound is to say so as well as it can.
        let below =
            if least >= -FLAT * scale { (-FLAT * scale).max(least - SLACK * scale) } else { least - SLACK * scale };
        let good_curvature = bounds.curvature[1] <= self.proved.curvature[1].max(greatest + SLACK * scale)
            && bounds.curvature[0] >= self.proved.curvature[0].min(below);
        let good_bend = bounds.bend <= self.proved.bend.max((1.0 + SLACK) * self.reached.bend);
        regular && good_stretch && good_curvature && good_bend
    }

    fn bounds(&self) -> ShapeBounds {
        let curvature = if self.bounded {
            Curvature { min: down(self.proved.curvature[0]), max: up(self.proved.curvature[1]) }
        } else {
            Curvature::UNBOUNDED
        };
        ShapeBounds {
            curvature,
            // From below 0 is a bound as well.
            min_stretch: down(self.proved.stretch[0]).max(0.0),
            max_stretch: up(self.proved.stretch[1]),
            max_bend: if self.bounded { up(self.proved.bend).max(0.0) } else { f32::INFINITY },
            ..ShapeBounds::unknown(self.second_derivatives)
        }
    }
}

fn join(extremes: &mut [f64; 2], [least, greatest]: [f64; 2]) {
    *extremes = [extremes[0].min(least), extremes[1].max(greatest)];
}

/// The smallest `f32` that is not below `value`.
fn up(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value { nearest.next_up() } else { nearest }
}

/// The largest `f32` that is not above `value`.
fn down(value: f64) -> f32 {
    -up(-value)
}
