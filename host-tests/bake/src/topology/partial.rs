//! Borders that are nearly one edge: what a modeller meant to join, and did not.

use super::fault::SeamFault;
use super::matching::{Candidate, Sense};
use glam::DVec3;

/// Points along a border that are tried against another. Three of them in a row on it are no crossing and no touch:
/// curves that touch part by more than the tolerance a 64th further on, unless they agree to second order.
const SAMPLES: usize = 64;
const IN_A_ROW: usize = 3;
/// Unmatched borders that nowhere are farther apart than this, in sizes, are a crack and no gap that is meant.
const CRACK: f64 = 1e-3;
/// Nor are those that share both ends and part by less than this share of their length between them.
const SLIT: f64 = 0.05;

/// Looks for what is wrong between an unmatched border and another one that is not the same edge.
pub fn check(
    open: &Candidate<'_>,
    other: &Candidate<'_>,
    other_is_open: bool,
    tolerance: f64,
    name: &dyn Fn(&Candidate<'_>) -> String,
) -> Result<(), SeamFault> {
    let size = tolerance / super::border::TOLERANCE;
    if !boxes_meet(open, other, CRACK * size) {
        return Ok(());
    }
    let common = common_part(open, other, tolerance);
    let common_other = common_part(other, open, tolerance);
    let whole = |range: &Option<[f64; 2]>| *range == Some([0.0, 1.0]);
    let deviation = || [Sense::Same, Sense::Reversed].map(|sense| open.deviation(other, sense)).into_iter();
    if whole(&common) && whole(&common_other) {
        let deviation = deviation().fold(f64::INFINITY, f64::min);
        return Err(SeamFault::Parametrisation { first: name(open), second: name(other), deviation });
    }
    for (first, second, range) in [(open, other, common), (other, open, common_other)] {
        if let Some([from, to]) = range {
            return Err(SeamFault::Partial { first: name(first), second: name(second), from, to });
        }
    }
    if other_is_open && open.border < other.border {
        for sense in [Sense::Same, Sense::Reversed] {
            let deviation = open.deviation(other, sense);
            let ends = [0, 1].map(|end| {
                let across = if sense == Sense::Same { end } else { 1 - end };
                open.ends[end].distance(other.ends[across]) <= tolerance
            });
            let slit = ends == [true; 2] && deviation <= SLIT * open.length().max(other.length());
            if slit || deviation <= CRACK * size {
                return Err(SeamFault::Gap { first: name(open), second: name(other), deviation, tolerance });
            }
        }
    }
    Ok(())
}

/// The first stretch of a border, of its parameter, that lies on another: at least [`IN_A_ROW`] samples of it.
fn common_part(of: &Candidate<'_>, on: &Candidate<'_>, tolerance: f64) -> Option<[f64; 2]> {
    let lies_on = |k: usize| distance(on, of.border.point(of.patch, k as f64 / SAMPLES as f64), tolerance) <= tolerance;
    let mut start = None;
    for k in 0..=SAMPLES + 1 {
        let on = k <= SAMPLES && lies_on(k);
        match start {
            None if on => start = Some(k),
            Some(first) if !on => {
                if k - first >= IN_A_ROW {
                    return Some([first as f64 / SAMPLES as f64, (k - 1) as f64 / SAMPLES as f64]);
                }
                start = None;
            }
            _ => {}
        }
    }
    None
}

/// The distance of a point from a border: Newton's method from the nearest sample, or the nearest sample's where that
/// is far.
fn distance(on: &Candidate<'_>, point: DVec3, tolerance: f64) -> f64 {
    let intervals = on.points.len() - 1;
    let far = on.points.iter().enumerate().map(|(k, sample)| (sample.distance(point), k));
    let (mut least, nearest) = far.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
    let mut t = nearest as f64 / intervals as f64;
    for _ in 0..20 {
        if least <= tolerance {
            break;
        }
        let at = on.border.at(on.patch, t);
        let off = at.point - point;
        // Gauss and Newton: near a point that lies on the curve it is Newton's step.
        let step = off.dot(at.tangent) / at.tangent.length_squared();
        if !step.is_finite() || step.abs() < 1e-15 {
            break;
        }
        t = (t - step).clamp(0.0, 1.0);
        least = least.min(on.border.point(on.patch, t).distance(point));
    }
    least
}

fn boxes_meet(a: &Candidate<'_>, b: &Candidate<'_>, margin: f64) -> bool {
    let extent = |candidate: &Candidate<'_>| {
        let points = candidate.points.iter();
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(*point), high.max(*point)))
    };
    let ((low_a, high_a), (low_b, high_b)) = (extent(a), extent(b));
    // Between samples a curve may bulge out of their box; a part in common has samples of either on it.
    low_a.cmple(high_b + margin).all() && low_b.cmple(high_a + margin).all()
}
