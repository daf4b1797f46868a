//! The shapes.

use super::{Random, fit};
use crate::oracle::OraclePoint;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate_bake::NurbsPatch;

/// What a patch is cut from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// An ellipsoid of random axes: stereographic, so biquadratic and rational.
    Ellipsoid,
    /// An elliptic paraboloid.
    Paraboloid,
    /// A round cylinder: curved one way only.
    Cylinder,
    /// A plane.
    Plane,
    /// A convex graph of degree 4.
    Quartic,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Ellipsoid, Self::Paraboloid, Self::Cylinder, Self::Plane, Self::Quartic];

    /// The least degree, along both parameters, of a patch whose parametrisation is skewed.
    const fn degree(self) -> usize {
        match self {
            Self::Plane => 1,
            Self::Ellipsoid | Self::Paraboloid => 2,
            Self::Cylinder => 3,
            Self::Quartic => 4,
        }
    }
}

/// A convex patch.
#[derive(Clone, Debug)]
pub struct ConvexPatch {
    /// What it is cut from.
    pub kind: Kind,
    /// The patch, millimetres to decimetres large, near the origin, turned any way; its normals point out of the convex
    /// body.
    pub surface: NurbsPatch,
}

impl ConvexPatch {
    /// Draws a patch of a kind.
    pub fn draw(kind: Kind, random: &mut Random) -> Self {
        let degree = [(); 2].map(|()| kind.degree() + random.below(6 - kind.degree()));
        // The cut: a parallelogram in the shape's own parameters, down to 15° between its sides.
        let extent = random.scale(0.15, 0.9);
        let (turn, opening) = (random.between(0.0, std::f64::consts::TAU), random.between(0.26, 2.88));
        let sides = [(turn, extent), (turn + opening, extent * random.scale(0.3, 1.0))]
            .map(|(a, l)| [l * a.cos(), l * a.sin()]);
        let centre = [(); 2].map(|()| random.between(-0.4, 0.4));
        let at = move |u: f64, v: f64| {
            [0, 1].map(|axis| centre[axis] + (u - 0.5) * sides[0][axis] + (v - 0.5) * sides[1][axis])
        };
        let shape = draw_shape(kind, random);
        // u ↦ u / (u + c (1 − u)) spreads the parameter unevenly; with weights it costs no degree.
        let spread = [(); 2].map(|()| if random.happens(0.3) { random.scale(0.5, 2.0) } else { 1.0 });
        let (axes, scale) = (random.axes(), random.scale(0.02, 0.2));
        let turned = move |point: DVec3| (axes[0] * point.x + axes[1] * point.y + axes[2] * point.z) * scale;
        // The patch lies about as far from the frame's origin as it is large: f32 resolves coordinates, not sizes.
        let [s, t] = at(0.5, 0.5);
        let middle = turned(shape(s, t).xyz() / shape(s, t).w);
        let origin = random.direction() * scale * extent * random.between(0.0, 1.0) - middle;
        let place = |point: DVec4| (turned(point.xyz()) + origin * point.w).extend(point.w);
        let homogeneous = |u: f64, v: f64| {
            let [below_u, below_v] = [u + spread[0] * (1.0 - u), v + spread[1] * (1.0 - v)];
            let [s, t] = at(u / below_u, v / below_v);
            place(shape(s, t)) * below_u.powi(degree[0] as i32) * below_v.powi(degree[1] as i32)
        };
        let mut surface = fit(degree, false, homogeneous);
        // Of a convex body, every outward normal points away from every inner point.
        let middle = OraclePoint::evaluate(&surface, 0.5, 0.5);
        let inner = place(kind.inner_point()).truncate();
        surface.flip = middle.tangent_u.cross(middle.tangent_v).dot(middle.point - inner) < 0.0;
        Self { kind, surface }
    }

    /// The outward unit normal at `(u, v)`, with the point.
    pub fn point_and_normal(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let at = OraclePoint::evaluate(&self.surface, u, v);
        let normal = at.tangent_u.cross(at.tangent_v).normalize();
        (at.point, if self.surface.flip { -normal } else { normal })
    }

    /// The cosine of the widest angle between two normals, from a grid of them.
    pub fn widest_cosine(&self) -> f64 {
        let grid = || (0..=8).map(|index| f64::from(index) / 8.0);
        let normals: Vec<DVec3> = grid().flat_map(|u| grid().map(move |v| self.point_and_normal(u, v).1)).collect();
        normals.iter().flat_map(|a| normals.iter().map(|b| a.dot(*b))).fold(1.0, f64::min)
    }
}

impl Kind {
    /// A point inside the convex body, in its own frame.
    const fn inner_point(self) -> DVec4 {
        match self {
            Self::Ellipsoid | Self::Cylinder => DVec4::new(0.0, 0.0, 0.0, 1.0),
            Self::Paraboloid | Self::Plane | Self::Quartic => DVec4::new(0.0, 0.0, -10.0, 1.0),
        }
    }
}

/// The homogeneous map of a shape, in its own frame and about of size 1.
fn draw_shape(kind: Kind, random: &mut Random) -> Box<dyn Fn(f64, f64) -> DVec4> {
    match kind {
        Kind::Ellipsoid => {
            let [a, b, c] = [(); 3].map(|()| random.scale(0.4, 1.0));
            Box::new(move |s, t| {
                let square = s * s + t * t;
                DVec4::new(2.0 * a * s, 2.0 * b * t, c * (1.0 - square), 1.0 + square)
            })
        }
        Kind::Paraboloid => {
            let [a, b] = [(); 2].map(|()| random.scale(0.1, 1.5));
            Box::new(move |s, t| DVec4::new(s, t, -0.5 * (a * s * s + b * t * t), 1.0))
        }
        Kind::Cylinder => {
            let height = random.scale(0.5, 2.0);
            Box::new(move |s, t| {
                let square = 1.0 + s * s;
                DVec4::new(1.0 - s * s, 2.0 * s, height * t * square, square)
            })
        }
        Kind::Plane => Box::new(|s, t| DVec4::new(s, t, 0.0, 1.0)),
        Kind::Quartic => {
            let [a, b, c, d] = [(); 4].map(|()| random.scale(0.1, 1.0));
            Box::new(move |s, t| {
                let [s2, t2] = [s * s, t * t];
                DVec4::new(s, t, -0.5 * (a * s2 + b * t2) - c * s2 * s2 - d * t2 * t2, 1.0)
            })
        }
    }
}
