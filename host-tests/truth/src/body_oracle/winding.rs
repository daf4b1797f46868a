//! Distance and side of closed polyhedra, by other means than patches.

use glam::DVec3;
use std::f64::consts::TAU;

/// The distance from a probe to a triangle: in its plane where the foot lies inside, else to the nearest of its sides.
pub fn triangle_distance(probe: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let is_within =
        [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (*to - *from).cross(probe - *from).dot(normal) >= 0.0);
    if is_within {
        return (probe - a).dot(normal).abs() / normal.length();
    }
    [(a, b), (b, c), (c, a)].iter().map(|(from, to)| segment_distance(probe, *from, *to)).fold(f64::INFINITY, f64::min)
}

/// The distance from a probe to a segment.
pub fn segment_distance(probe: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let t = ((probe - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    probe.distance(from + along * t)
}

/// How often closed triangles, anticlockwise seen from outside, wind around a probe: 1 inside, 0 outside, up to
/// rounding.
///
/// The solid angle `Ω` of a triangle has `tan Ω/2 = a·(b×c) / (|a||b||c| + (a·b)|c| + (b·c)|a| + (c·a)|b|)` (A. van
/// Oosterom and J. Strackee, *The solid angle of a plane triangle*, 1983).
pub fn winding_number(probe: DVec3, triangles: &[[DVec3; 3]]) -> f64 {
    let half_angle = |triangle: &[DVec3; 3]| {
        let [a, b, c] = triangle.map(|corner| corner - probe);
        let [x, y, z] = [a, b, c].map(DVec3::length);
        a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    triangles.iter().map(half_angle).sum::<f64>() / TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_winds_once_around_what_is_inside() {
        let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
        assert!((winding_number(DVec3::splat(0.1), &faces) - 1.0).abs() < 1e-12);
        assert!(winding_number(DVec3::splat(0.4), &faces).abs() < 1e-12);
        assert!(winding_number(DVec3::new(-0.1, 0.2, 0.2), &faces).abs() < 1e-12);
        assert!((triangle_distance(DVec3::splat(1.0), faces[3]) - 2.0 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert!((triangle_distance(DVec3::new(3.0, -1.0, 0.0), faces[3]) - 5.0_f64.sqrt()).abs() < 1e-12);
    }
}
