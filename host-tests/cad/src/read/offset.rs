//! Offset surfaces of free form, which no NURBS is: bicubic pieces through the offset points and their derivatives.

use crate::nurbs::Surface;
use glam::{DVec2, DVec3};

/// The most pieces along a parameter.
const MOST: usize = 192;
/// Where the derivatives of a piece's corner are taken, as a part of the piece: beside a knot where they jump, and
/// beside a pole, where fewer digits of them are left the nearer it is.
const BESIDE: f64 = 1e-5;
/// The step of differences, likewise.
const STEP: f64 = 1e-4;

/// The surface at a distance along the normals of another; as near as `near`, millimetres.
pub(super) fn offset(basis: &Surface, distance: f64, near: f64) -> Option<Surface> {
    let mut pieces = [1, 1];
    loop {
        let breaks = [0, 1].map(|axis| breaks(basis, axis, pieces[axis]));
        if breaks.iter().any(|breaks| breaks.len() > MOST + 1) {
            return None;
        }
        let surface = through(basis, distance, &breaks);
        let off = [0, 1].map(|axis| off(basis, distance, &surface, &breaks, axis));
        if off[0] + off[1] <= near {
            return Some(surface);
        }
        // Each parameter by itself: one of them may be straight.
        (0..2).filter(|axis| off[*axis] > 0.3 * near).for_each(|axis| pieces[axis] *= 2);
    }
}

/// The knots of a parameter, each span in as many pieces.
fn breaks(basis: &Surface, axis: usize, pieces: usize) -> Vec<f64> {
    let mut knots = basis.knots[axis][basis.degree[axis]..=basis.counts[axis]].to_vec();
    knots.dedup();
    let inner = knots.windows(2).flat_map(|pair| {
        let [low, high] = [pair[0], pair[1]];
        (0..pieces).map(move |k| low + (high - low) * k as f64 / pieces as f64)
    });
    inner.chain(knots.last().copied()).collect()
}

/// Position and first derivatives; beside a pole, not at it.
fn jet(basis: &Surface, distance: f64, uv: DVec2) -> [DVec3; 3] {
    let jet = basis.at(uv);
    let ([su, sv], [suu, suv, svv]) = (jet.first, jet.second);
    let cross = jet.cross();
    let (length, normal) = (cross.length().max(f64::MIN_POSITIVE), cross.normalize_or_zero());
    let slope = |by: DVec3| by.reject_from_normalized(normal) / length;
    [
        jet.point + normal * distance,
        su + slope(suu.cross(sv) + su.cross(suv)) * distance,
        sv + slope(suv.cross(sv) + su.cross(svv)) * distance,
    ]
}

fn through(basis: &Surface, distance: f64, breaks: &[Vec<f64>; 2]) -> Surface {
    let cells = breaks.each_ref().map(|breaks| breaks.len() - 1);
    let counts = cells.map(|cells| 3 * cells + 1);
    let mut points = vec![DVec3::ZERO; counts[0] * counts[1]];
    for (i, j) in (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| (i, j))) {
        let low = DVec2::new(breaks[0][i], breaks[1][j]);
        let size = DVec2::new(breaks[0][i + 1], breaks[1][j + 1]) - low;
        for (k, l) in [(0_u8, 0_u8), (0, 1), (1, 0), (1, 1)] {
            let inward = |k: u8, by: f64| if k == 0 { by } else { 1.0 - by };
            let at = |x: f64, y: f64| jet(basis, distance, low + size * DVec2::new(inward(k, x), inward(l, y)));
            let [point, pu, pv] = at(BESIDE, BESIDE);
            // Inward from the corner; the mixed derivative from one side, to the second order.
            let inner = size * DVec2::new(1.0 - 2.0 * f64::from(k), 1.0 - 2.0 * f64::from(l));
            let [first, second] = [STEP, 2.0 * STEP].map(|by| at(BESIDE, BESIDE + by)[1]);
            let twist = (first * 4.0 - pu * 3.0 - second) * (inner.x / (2.0 * STEP));
            let (along, up) = (pu * inner.x, pv * inner.y);
            let point = point - (along + up) * BESIDE;
            let index = |cell: usize, corner: u8, inner: usize| 3 * cell + if corner == 0 { inner } else { 3 - inner };
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let [x, y] = [a, b].map(|k| k as f64 / 3.0);
                points[index(i, k, a) * counts[1] + index(j, l, b)] = point + along * x + up * y + twist * (x * y);
            }
        }
    }
    let knots = breaks.each_ref().map(|breaks| {
        let (first, last) = (breaks[0], breaks[breaks.len() - 1]);
        let all = breaks.iter().flat_map(|knot| std::iter::repeat_n(*knot, 3));
        [first].into_iter().chain(all).chain([last]).collect()
    });
    let points = points.into_iter().map(|point| point.extend(1.0)).collect();
    let [closed, touching] = [[false; 2]; 2];
    Surface { degree: [3; 2], knots, counts, points, closed, touching, poles: [[false; 2]; 2] }
}

/// How far the middles of the pieces along a parameter are off, beside their corners along the other.
fn off(basis: &Surface, distance: f64, surface: &Surface, breaks: &[Vec<f64>; 2], axis: usize) -> f64 {
    let middles: Vec<f64> = breaks[axis].windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let others = breaks[1 - axis].windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) * BESIDE);
    let at = |other: f64, along: f64| if axis == 0 { DVec2::new(along, other) } else { DVec2::new(other, along) };
    let far = |uv: DVec2| surface.at(uv).point.distance(jet(basis, distance, uv)[0]);
    others.flat_map(|other| middles.iter().map(move |along| at(other, *along))).map(far).fold(0.0, f64::max)
}
