//! A walk over the triangles of a mesh, from the last tick's.

use crate::Answer;
use palpate::math::{Vec3, inverse_sqrt};

/// Beyond an open side.
pub const NONE: u16 = u16::MAX;
/// Triangles that a tick may move on by.
const MOVES: usize = 64;
/// Triangles around a corner.
const FAN: usize = 32;

/// Triangles with their neighbours.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Corners, metres.
    points: &'a [[f32; 3]],
    /// Unit normals there, for force shading; empty without.
    normals: &'a [[f32; 3]],
    /// Three corners, anticlockwise seen from outside, then the neighbours over the sides that start there.
    triangles: &'a [[u16; 6]],
}

/// Where the closest point of a triangle lies.
#[derive(Clone, Copy)]
enum On {
    Inside,
    /// On the side that starts at a corner.
    Side(usize),
    Corner(usize),
}

/// The closest point of a triangle.
#[derive(Clone, Copy)]
struct Foot {
    triangle: u16,
    on: On,
    /// Towards the second and third corner.
    weights: [f32; 2],
    point: Vec3,
    squared: f32,
    /// Not of unit length.
    normal: Vec3,
}

impl<'a> Mesh<'a> {
    /// The table: numbers of corners, of normals and of triangles, then these. `None` if it is cut short.
    pub fn of(words: &'a [u32]) -> Option<Self> {
        let ([points, normals, triangles], rest) = words.split_first_chunk::<3>()?;
        let (points, rest) = rest.split_at_checked(3 * *points as usize)?;
        let (normals, rest) = rest.split_at_checked(3 * *normals as usize)?;
        (rest.len() == 3 * *triangles as usize).then(|| Self {
            points: bytemuck::cast_slice::<u32, f32>(points).as_chunks().0,
            normals: bytemuck::cast_slice::<u32, f32>(normals).as_chunks().0,
            triangles: bytemuck::cast_slice::<u32, u16>(rest).as_chunks().0,
        })
    }

    /// The walk that starts at the nearest of all triangles.
    pub fn start(&self, probe: Vec3) -> Walk<'a> {
        let mut best = self.foot(0, probe);
        for triangle in 1..self.triangles.len() {
            let foot = self.foot(triangle as u16, probe);
            if foot.squared < best.squared {
                best = foot;
            }
        }
        Walk { mesh: *self, triangle: best.triangle }
    }

    #[inline(always)]
    fn corner(&self, index: u16) -> Vec3 {
        Vec3::from_array(*self.points.get(usize::from(index)).unwrap_or(&[0.0; 3]))
    }

    #[inline(always)]
    fn triangle(&self, index: u16) -> &'a [u16; 6] {
        self.triangles.get(usize::from(index)).unwrap_or(&[0, 0, 0, NONE, NONE, NONE])
    }

    /// In the plane if it is inside there, else on one of the sides that the probe is beyond.
    #[inline(always)]
    fn foot(&self, index: u16, probe: Vec3) -> Foot {
        let [a, b, c] = {
            let [a, b, c, ..] = *self.triangle(index);
            [a, b, c].map(|corner| self.corner(corner))
        };
        let ([ab, ac], away) = ([b - a, c - a], probe - a);
        let (bb, bc, cc) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
        let (on_b, on_c) = (ab.dot(away), ac.dot(away));
        let area = bb * cc - bc * bc;
        let (s, t) = (cc * on_b - bc * on_c, bb * on_c - bc * on_b);
        let normal = ab.cross(ac);
        let foot = |on, weights: [f32; 2]| {
            let from = away - ab * weights[0] - ac * weights[1];
            Foot { triangle: index, on, weights, point: probe - from, squared: from.length_squared(), normal }
        };
        if s >= 0.0 && t >= 0.0 && s + t <= area {
            let whole = 1.0 / area;
            return foot(On::Inside, [s * whole, t * whole]);
        }
        let mut best: Option<Foot> = None;
        let mut side = |number: usize, share: f32, weights: fn(f32) -> [f32; 2]| {
            let on = if share <= 0.0 {
                On::Corner(number)
            } else if share >= 1.0 {
                On::Corner(after(number))
            } else {
                On::Side(number)
            };
            let found = foot(on, weights(share.clamp(0.0, 1.0)));
            if best.is_none_or(|best| found.squared < best.squared) {
                best = Some(found);
            }
        };
        if t < 0.0 {
            side(0, on_b / bb, |share| [share, 0.0]);
        }
        if s + t > area {
            side(1, (bb - bc + on_c - on_b) / (bb - 2.0 * bc + cc), |share| [1.0 - share, share]);
        }
        if s < 0.0 {
            side(2, 1.0 - on_c / cc, |share| [0.0, 1.0 - share]);
        }
        best.unwrap_or_else(|| foot(On::Inside, [0.0; 2]))
    }
}

#[inline(always)]
const fn after(corner: usize) -> usize {
    if corner == 2 { 0 } else { corner + 1 }
}

#[inline(always)]
const fn before(corner: usize) -> usize {
    if corner == 0 { 2 } else { corner - 1 }
}

/// The triangle of the last tick.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'a> {
    mesh: Mesh<'a>,
    triangle: u16,
}

impl Walk<'_> {
    /// The closest point of the triangles; normal of the triangle, or from an edge or corner to the probe.
    pub fn facets(&mut self, probe: Vec3) -> Answer {
        let foot = self.step(probe);
        let away = probe - foot.point;
        let height = away.dot(foot.normal);
        if matches!(foot.on, On::Inside) || foot.squared <= f32::MIN_POSITIVE {
            let inverse = inverse_sqrt(foot.normal.length_squared());
            return Answer { gap_m: height * inverse, normal: foot.normal * inverse, point: foot.point };
        }
        let inverse = inverse_sqrt(foot.squared) * if height < 0.0 { -1.0 } else { 1.0 };
        Answer { gap_m: foot.squared * inverse, normal: away * inverse, point: foot.point }
    }

    /// Force shading: the same distance, along the normals of the corners, interpolated.
    pub fn shaded(&mut self, probe: Vec3) -> Answer {
        let foot = self.step(probe);
        let away = probe - foot.point;
        let normal = |corner: u16| Vec3::from_array(*self.mesh.normals.get(usize::from(corner)).unwrap_or(&[0.0; 3]));
        let [a, b, c, ..] = *self.mesh.triangle(foot.triangle);
        let [s, t] = foot.weights;
        let blend = normal(a) * (1.0 - s - t) + normal(b) * s + normal(c) * t;
        let normal = blend * inverse_sqrt(blend.length_squared());
        let length = if foot.squared > f32::MIN_POSITIVE { foot.squared * inverse_sqrt(foot.squared) } else { 0.0 };
        let gap_m = if away.dot(foot.normal) < 0.0 { -length } else { length };
        Answer { gap_m, normal, point: foot.point }
    }

    /// Moves on as long as a neighbour is nearer.
    #[inline(always)]
    fn step(&mut self, probe: Vec3) -> Foot {
        let mut foot = self.mesh.foot(self.triangle, probe);
        for _ in 0..MOVES {
            let next = match foot.on {
                On::Inside => None,
                On::Side(side) => self.beyond(foot.triangle, side, probe, foot.squared),
                On::Corner(corner) => self
                    .around(foot.triangle, corner, probe, foot.squared, true)
                    .or_else(|| self.around(foot.triangle, corner, probe, foot.squared, false)),
            };
            let Some(next) = next else { break };
            foot = next;
        }
        self.triangle = foot.triangle;
        foot
    }

    /// The neighbour over a side, if it is nearer.
    fn beyond(&self, triangle: u16, side: usize, probe: Vec3, than: f32) -> Option<Foot> {
        let next = *self.mesh.triangle(triangle).get(3 + side)?;
        if next == NONE {
            return None;
        }
        Some(self.mesh.foot(next, probe)).filter(|foot| foot.squared < than)
    }

    /// The first triangle around a corner that is nearer, one way round.
    #[inline(never)]
    fn around(&self, triangle: u16, corner: usize, probe: Vec3, than: f32, left: bool) -> Option<Foot> {
        let (mut at, mut corner) = (triangle, corner);
        for _ in 0..FAN {
            let side = if left { before(corner) } else { corner };
            let next = *self.mesh.triangle(at).get(3 + side)?;
            if next == NONE || next == triangle {
                return None;
            }
            let foot = self.mesh.foot(next, probe);
            if foot.squared < than {
                return Some(foot);
            }
            // Its side back to this triangle runs the other way.
            let [.., a, b, c] = *self.mesh.triangle(next);
            let back = [a, b, c].iter().position(|beyond| *beyond == at)?;
            (at, corner) = (next, if left { back } else { after(back) });
        }
        None
    }
}
