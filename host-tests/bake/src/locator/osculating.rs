//! A part of a face as its middle sees it: the surface to second order, for distances that need not be exact.

use super::stored::StoredSurface;
use glam::DVec3;
use palpate::math::Vec3;

/// Allowance for the surface's third order in the distance, relative to its value at the corners.
const SAFETY: f64 = 1.5;
/// More than `f32` rounds, relative to lengths.
const ROUNDED: f32 = 2e-6;

/// The surface about the middle of a rectangle of its parameters; lengths in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Osculating {
    pub middle: Vec3,
    first: [Vec3; 2],
    /// `f_uu`, `f_uv`, `f_vv`.
    second: [Vec3; 3],
    /// From the middle to the rectangle's sides.
    half: [f32; 2],
    /// About as far as any point of it is from the middle, rather more.
    pub radius: f32,
    /// How far the part may be off.
    off: f32,
    /// How far it is from its tangent plane, at most about.
    sag: f32,
}

impl Osculating {
    /// About the middle of a rectangle, which may be a line or a point.
    pub(super) fn new(surface: &StoredSurface, [low, high]: [[f64; 2]; 2]) -> Self {
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let half = [0, 1].map(|axis| 0.5 * (high[axis] - low[axis]));
        let here = surface.evaluate(middle);
        let (mut radius, mut off): (f64, f64) = (0.0, 0.0);
        for u in [-1.0, 1.0] {
            for v in [-1.0, 1.0] {
                let [du, dv] = [u * half[0], v * half[1]];
                let there = surface.evaluate([middle[0] + du, middle[1] + dv]).point;
                let bend =
                    here.second[0] * (0.5 * du * du) + here.second[1] * (du * dv) + here.second[2] * (0.5 * dv * dv);
                let guess = here.point + here.first[0] * du + here.first[1] * dv + bend;
                radius = radius.max(there.distance_squared(here.point));
                off = off.max(there.distance_squared(guess));
            }
        }
        let (radius, off) = (radius.sqrt(), off.sqrt());
        let [uu, uv, vv] = here.second.map(|second| second.length_squared().sqrt());
        let sag = 0.5 * uu * half[0] * half[0] + uv * half[0] * half[1] + 0.5 * vv * half[1] * half[1];
        let single = |vector: DVec3| vector.as_vec3();
        Self {
            middle: single(here.point),
            first: here.first.map(single),
            second: here.second.map(single),
            half: half.map(|half| half as f32),
            radius: (radius + SAFETY * off) as f32,
            off: (SAFETY * off) as f32,
            sag: (SAFETY * off + sag) as f32,
        }
    }

    /// Axes along and across it.
    pub(super) fn frame(&self) -> [Vec3; 3] {
        let [along, across] = self.first;
        match (along.try_normalize(), along.cross(across).try_normalize()) {
            (Some(along), Some(normal)) => [along, normal.cross(along), normal],
            _ => Vec3::AXES,
        }
    }

    /// Its minimum and maximum along the axes of a frame: [`Self::distance`] is at least that of a box so large.
    pub(super) fn bounds(&self, frame: &[Vec3; 3]) -> [Vec3; 2] {
        let along = |vector: Vec3| Vec3::from_array(frame.map(|axis| axis.dot(vector)));
        let [half_u, half_v] = self.half;
        let [uu, uv, vv] = self.second.map(along);
        let [uu, vv] = [uu * (0.5 * half_u * half_u), vv * (0.5 * half_v * half_v)];
        let slope = along(self.first[0]).abs() * half_u + along(self.first[1]).abs() * half_v;
        let both = slope + uv.abs() * (half_u * half_v) + self.off + ROUNDED * (self.middle.length() + self.radius);
        let middle = along(self.middle);
        [
            middle + uu.min(Vec3::ZERO) + vv.min(Vec3::ZERO) - both,
            middle + uu.max(Vec3::ZERO) + vv.max(Vec3::ZERO) + both,
        ]
    }

    /// Whether [`Self::distance`] may be below a distance; quickly.
    pub(super) fn is_within(&self, distance: f32, probe: Vec3) -> bool {
        let from = self.middle - probe;
        let square = from.length_squared();
        let reach = distance + self.radius;
        if reach <= 0.0 || square >= reach * reach {
            return false;
        }
        // On the tangent plane the square is at least what it is along its slope, which is steepest at the middle.
        let falls = from.dot(self.first[0]).abs() * self.half[0] + from.dot(self.first[1]).abs() * self.half[1];
        let reach = distance + self.sag;
        square - 2.0 * falls < reach * reach
    }

    /// About the distance of a probe, rather too little than too much: that of the place where half its square, to
    /// second order, has its minimum.
    #[inline]
    pub(super) fn distance(&self, probe: Vec3) -> f32 {
        let from = self.middle - probe;
        let [f_u, f_v] = self.first;
        let [p, q] = self.first.map(|tangent| from.dot(tangent));
        let [a, b, c] = [
            f_u.dot(f_u) + from.dot(self.second[0]),
            f_u.dot(f_v) + from.dot(self.second[1]),
            f_v.dot(f_v) + from.dot(self.second[2]),
        ];
        let [half_u, half_v] = self.half;
        let determinant = a * c - b * b;
        let free = [(b * q - c * p) / determinant, (b * p - a * q) / determinant];
        if a > 0.0 && determinant > 0.0 && free[0].abs() <= half_u && free[1].abs() <= half_v {
            return self.square_at(from, free).sqrt() - self.off;
        }
        let on_line = |slope: f32, bend: f32, half: f32| {
            if bend > 0.0 { (-slope / bend).clamp(-half, half) } else { -half * slope.signum() }
        };
        let sides = [-1.0, 1.0].map(|side| {
            let (u, v) = (side * half_u, side * half_v);
            [[u, on_line(q + b * u, c, half_v)], [on_line(p + b * v, a, half_u), v]]
        });
        let squares = sides.iter().flatten().map(|at| self.square_at(from, *at));
        squares.fold(f32::INFINITY, f32::min).sqrt() - self.off
    }

    /// The square of the distance of the place at a change of parameters, with `from` from the probe to the middle.
    fn square_at(&self, from: Vec3, [u, v]: [f32; 2]) -> f32 {
        let bend = self.second[0] * (0.5 * u * u) + self.second[1] * (u * v) + self.second[2] * (0.5 * v * v);
        (from + self.first[0] * u + self.first[1] * v + bend).length_squared()
    }
}
