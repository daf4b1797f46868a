//! Closed bodies full of poles and pointed vertices, drawn from a seed, with their truth.

use glam::{DVec2, DVec3};
use palpate_truth::body_oracle::{triangle_distance, winding_number};
use palpate_truth::generate::Random;
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write as _;

/// A body, millimetres.
pub enum Shape {
    /// Triangles, anticlockwise seen from outside.
    Polyhedron(Vec<[DVec3; 3]>),
    /// What a closed polygon of (radius, height) sweeps about z, from a point of the axis to another, upwards on the
    /// outside.
    Revolved(Vec<DVec2>),
}

impl Shape {
    /// Distance, and whether the probe is inside; `None` where rounding decides.
    pub fn truth(&self, probe: DVec3) -> (f64, Option<bool>) {
        match self {
            Self::Polyhedron(faces) => {
                let distance = faces.iter().map(|face| triangle_distance(probe, *face)).fold(f64::INFINITY, f64::min);
                let winding = winding_number(probe, faces);
                let is_sure = (winding - winding.round()).abs() < 1e-6;
                (distance, is_sure.then_some(winding.round() == 1.0))
            }
            Self::Revolved(profile) => {
                let at = DVec2::new(probe.truncate().length(), probe.z);
                let mut distance = f64::INFINITY;
                let mut crossings = 0;
                for pair in profile.windows(2) {
                    let along = pair[1] - pair[0];
                    let t = ((at - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                    distance = distance.min(at.distance(pair[0] + along * t));
                    // A ray away from the axis.
                    if (pair[0].y > at.y) != (pair[1].y > at.y) {
                        let reach = pair[0].x + along.x * (at.y - pair[0].y) / along.y;
                        crossings += usize::from(reach > at.x);
                    }
                }
                (distance, Some(crossings % 2 == 1))
            }
        }
    }

    /// The corners of its bounding box.
    pub fn bounds(&self) -> [DVec3; 2] {
        let points: Vec<DVec3> = match self {
            Self::Polyhedron(faces) => faces.iter().flatten().copied().collect(),
            Self::Revolved(profile) => {
                profile.iter().flat_map(|at| [DVec3::new(at.x, at.x, at.y), DVec3::new(-at.x, -at.x, at.y)]).collect()
            }
        };
        let whole = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        points.into_iter().fold(whole, |[low, high], point| [low.min(point), high.max(point)])
    }

    /// Where edges meet, and poles.
    pub fn vertices(&self) -> Vec<DVec3> {
        match self {
            Self::Polyhedron(faces) => faces.iter().flatten().copied().collect(),
            Self::Revolved(profile) => profile.iter().map(|at| DVec3::new(at.x, 0.0, at.y)).collect(),
        }
    }

    /// As a model file.
    pub fn model(&self, random: &mut Random) -> String {
        let mut text = "name = \"drawn\"\nunit = \"mm\"\n".to_owned();
        match self {
            Self::Polyhedron(faces) => {
                for face in faces {
                    // Any corner may be the pole, and the pole any side.
                    let turn = random.below(3);
                    let [a, b, c] = [0, 1, 2].map(|corner| row(face[(corner + turn) % 3], 1.0));
                    let (points, flip) = match random.below(4) {
                        0 => ([[&a, &b], [&a, &c]], true),
                        1 => ([[&b, &a], [&c, &a]], false),
                        2 => ([[&a, &a], [&b, &c]], false),
                        _ => ([[&b, &c], [&a, &a]], true),
                    };
                    patch(&mut text, [1, 1], &points.map(|row| row.map(|point| point.clone()).to_vec()), flip);
                }
            }
            Self::Revolved(profile) => {
                for pair in profile.windows(2) {
                    for quarter in 0..4 {
                        let [x, y] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][quarter];
                        let arc = [(x, y, 1.0), (x - y, y + x, FRAC_1_SQRT_2), (-y, x, 1.0)];
                        let along = |(x, y, weight): (f64, f64, f64)| {
                            let point = |at: &DVec2| row(DVec3::new(at.x * x, at.x * y, at.y), weight);
                            pair.iter().map(point).collect::<Vec<_>>()
                        };
                        patch(&mut text, [2, 1], &arc.map(along), false);
                    }
                }
            }
        }
        text
    }
}

pub fn row(point: DVec3, weight: f64) -> String {
    // No −0.
    let [x, y, z] = point.to_array().map(|x| x + 0.0);
    format!("[{x:?}, {y:?}, {z:?}, {weight:?}]")
}

pub fn patch(text: &mut String, degree: [usize; 2], points: &[Vec<String>], flip: bool) {
    let rows: Vec<_> = points.iter().map(|row| format!("[{}]", row.join(", "))).collect();
    let _ = writeln!(
        text,
        "[[patch]]\ndegree = [{}, {}]\npoints = [{}]\nflip = {flip}",
        degree[0],
        degree[1],
        rows.join(", ")
    );
}

/// The convex hull of some points in general position.
pub fn hull(points: &[DVec3]) -> Vec<[DVec3; 3]> {
    let mut faces = Vec::new();
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                let [p, q, r] = [a, b, c].map(|index| points[index]);
                let normal = (q - p).cross(r - p);
                let heights =
                    || (0..points.len()).filter(|d| ![a, b, c].contains(d)).map(|d| normal.dot(points[d] - p));
                if heights().all(|height| height < 0.0) {
                    faces.push([p, q, r]);
                } else if heights().all(|height| height > 0.0) {
                    faces.push([p, r, q]);
                }
            }
        }
    }
    faces
}

/// An octahedron whose edges are halved once, every vertex at a distance of its own from the centre: ridges, valleys
/// and saddles.
pub fn star(random: &mut Random) -> Vec<[DVec3; 3]> {
    let mut radii: Vec<(DVec3, f64)> = Vec::new();
    let mut placed = |direction: DVec3| {
        let direction = direction.normalize();
        let known = radii.iter().find(|(known, _)| known.distance(direction) < 1e-9).map(|(_, radius)| *radius);
        let radius = known.unwrap_or_else(|| {
            let radius = random.between(10.0, 30.0);
            radii.push((direction, radius));
            radius
        });
        direction * radius
    };
    let mut faces = Vec::new();
    for octant in 0..8_u8 {
        let sign = |bit: u8| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let [x, y, z] = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
        let turned = sign(0) * sign(1) * sign(2) < 0.0;
        for face in [[x, x + y, z + x], [y, y + z, x + y], [z, z + x, y + z], [x + y, y + z, z + x]] {
            let [a, b, c] = face.map(&mut placed);
            faces.push(if turned { [a, c, b] } else { [a, b, c] });
        }
    }
    faces
}
