//! Tables of the triangle walk: patches cut into grids of triangles that meet along their borders.

use glam::DVec3;
use palpate_bake::BakedBody;
use palpate_bake::body::BakedSide;
use palpate_rivals::NONE;
use palpate_truth::oracle::OraclePoint;
use std::collections::HashMap;

/// Places along each parameter at which a patch's bend is looked at.
const PLACES: usize = 9;
/// Part of the size that a mesh is not finer than: the rounding of its corners is a tenth.
const FINE: f64 = 1e-6;
/// Points closer than this part of the size are one.
const SAME: f64 = 1e-6;

/// A mesh, as its table has it.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<[u16; 6]>,
}

impl Triangles {
    /// The finest mesh of a body that these bytes hold: cells where the surface leaves its triangles most.
    pub fn new(body: &BakedBody, flash: usize, shaded: bool) -> Self {
        let mut cells = Cells::new(body);
        let bytes = |cells: &Cells| {
            let of = |[u, v]: [usize; 2]| (u + 1) * (v + 1) * if shaded { 24 } else { 12 } + 2 * u * v * 12;
            12 + (0..body.faces.len()).map(|face| of(cells.of(face))).sum::<usize>()
        };
        // Corners and triangles have 16 bits.
        let count = |cells: &Cells| {
            (0..body.faces.len()).map(|face| 2 * cells.of(face).map(|n| n + 1).iter().product::<usize>()).sum::<usize>()
        };
        loop {
            let mut next = cells.clone();
            if !next.refine() || bytes(&next) > flash || count(&next) >= usize::from(NONE) {
                break;
            }
            cells = next;
        }
        let mut mesh = Self::default();
        for index in 0..body.faces.len() {
            mesh.add(body, index, cells.of(index));
        }
        mesh.join(SAME * f64::from(body.size));
        if !shaded {
            mesh.normals.clear();
        }
        mesh
    }

    /// Sides without a neighbour.
    pub fn open_sides(&self) -> usize {
        self.triangles.iter().flat_map(|triangle| &triangle[3..]).filter(|beyond| **beyond == NONE).count()
    }

    /// The longest side, metres.
    pub fn longest_side(&self) -> f64 {
        let sides = self.triangles.iter().flat_map(|[a, b, c, ..]| [[a, b], [b, c], [c, a]]);
        let length = |[a, b]: [&u16; 2]| self.points[usize::from(*a)].distance(self.points[usize::from(*b)]);
        sides.map(length).fold(0.0, f64::max)
    }

    /// The table.
    pub fn words(&self) -> Vec<u32> {
        let numbers = |points: &[DVec3]| -> Vec<u32> {
            points.iter().flat_map(|point| point.as_vec3().to_array()).map(f32::to_bits).collect()
        };
        let pair = |pair: &[u16]| u32::from(pair[0]) | u32::from(pair[1]) << 16;
        [self.points.len(), self.normals.len(), self.triangles.len()]
            .map(|count| count as u32)
            .into_iter()
            .chain(numbers(&self.points))
            .chain(numbers(&self.normals))
            .chain(self.triangles.iter().flat_map(|triangle| triangle.chunks(2)).map(pair))
            .collect()
    }

    fn add(&mut self, body: &BakedBody, index: usize, [along_u, along_v]: [usize; 2]) {
        let surface = &body.faces[index].surface;
        let first = self.points.len();
        for i in 0..=along_u {
            for j in 0..=along_v {
                let [u, v] = [i as f64 / along_u as f64, j as f64 / along_v as f64];
                self.points.push(OraclePoint::evaluate(surface, u, v).point);
                // A pole has none: a little inside.
                let inside = |parameter: f64| parameter + 1e-6 * (0.5 - parameter);
                self.normals.push(OraclePoint::evaluate(surface, inside(u), inside(v)).normal(surface.flip));
            }
        }
        let at = |i: usize, j: usize| (first + i * (along_v + 1) + j) as u16;
        for (i, j) in (0..along_u).flat_map(|i| (0..along_v).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            // The shorter diagonal.
            let length = |a: u16, b: u16| self.points[usize::from(a)].distance_squared(self.points[usize::from(b)]);
            // The diagonal last: slivers have their angles at the first corner.
            let halves = if length(a, c) <= length(b, d) { [[b, c, a], [d, a, c]] } else { [[a, b, d], [c, d, b]] };
            for [a, b, c] in halves {
                let [a, b, c] = if surface.flip { [a, c, b] } else { [a, b, c] };
                self.triangles.push([a, b, c, NONE, NONE, NONE]);
            }
        }
    }

    /// Leaves out triangles without area, and finds the neighbours of the others: those with the same two corners.
    fn join(&mut self, same: f64) {
        let mut known: HashMap<[i64; 3], Vec<(DVec3, u32)>> = HashMap::new();
        let mut number = 0;
        let of_point: Vec<u32> = self
            .points
            .iter()
            .map(|point| {
                let cell = (*point / (4.0 * same)).floor().to_array().map(|x| x as i64);
                let around = (0..27).map(|n| [cell[0] + n / 9 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n % 3 - 1]);
                let found =
                    around.filter_map(|cell| known.get(&cell)).flatten().find(|(at, _)| at.distance(*point) < same);
                if let Some((_, number)) = found {
                    return *number;
                }
                number += 1;
                known.entry(cell).or_default().push((*point, number));
                number
            })
            .collect();
        let ends = |triangle: &[u16; 6], side: usize| {
            [triangle[side], triangle[(side + 1) % 3]].map(|corner| of_point[usize::from(corner)])
        };
        self.triangles.retain(|triangle| (0..3).all(|side| ends(triangle, side)[0] != ends(triangle, side)[1]));
        let sides: HashMap<[u32; 2], u16> = self
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(index, triangle)| (0..3).map(move |side| (ends(triangle, side), index as u16)))
            .collect();
        for triangle in &mut self.triangles {
            for side in 0..3 {
                let [from, to] = ends(triangle, side);
                triangle[3 + side] = sides.get(&[to, from]).copied().unwrap_or(NONE);
            }
        }
    }
}

/// Cells along the parameters of each face: the same on both sides of an edge, and on opposite sides of a face.
#[derive(Clone, Debug)]
struct Cells {
    /// Of each face along `u` and `v`, the class.
    classes: Vec<[usize; 2]>,
    /// Cells of a class.
    counts: Vec<usize>,
    /// Of each face the second derivatives across it, `uu`, `uv` and `vv`, metres.
    bends: Vec<[f64; 3]>,
    /// Distance of the surface from its triangles at which no more cells help, metres.
    fine: f64,
}

impl Cells {
    fn new(body: &BakedBody) -> Self {
        let mut class: Vec<usize> = (0..2 * body.faces.len()).collect();
        let root = |class: &[usize], mut at: usize| {
            while class[at] != at {
                at = class[at];
            }
            at
        };
        // The first border of an edge that was met.
        let mut met: HashMap<u16, usize> = HashMap::new();
        for (index, face) in body.faces.iter().enumerate() {
            for (number, side) in face.sides.iter().enumerate() {
                if let BakedSide::Edge { edge, .. } = side {
                    // The sides u = 0 and u = 1 run along v.
                    let border = 2 * index + usize::from(number < 2);
                    let first = *met.entry(*edge).or_insert(border);
                    let (one, other) = (root(&class, border), root(&class, first));
                    class[one] = other;
                }
            }
        }
        let classes = (0..body.faces.len()).map(|face| [0, 1].map(|axis| root(&class, 2 * face + axis))).collect();
        let bends = body.faces.iter().map(|face| {
            let places = (0..PLACES * PLACES).map(|index| {
                let [u, v] = [index / PLACES, index % PLACES].map(|place| (place as f64 + 0.5) / PLACES as f64);
                let at = OraclePoint::evaluate(&face.surface, u, v);
                [at.second_uu, at.second_uv, at.second_vv].map(|second| second.dot(at.normal(false)).abs())
            });
            places.fold([0.0; 3], |most: [f64; 3], bend| [0, 1, 2].map(|index| most[index].max(bend[index])))
        });
        Self {
            classes,
            counts: vec![1; 2 * body.faces.len()],
            bends: bends.collect(),
            fine: FINE * f64::from(body.size),
        }
    }

    fn of(&self, face: usize) -> [usize; 2] {
        self.classes[face].map(|class| self.counts[class])
    }

    /// More cells in the class that leaves the surface most; false if none does.
    fn refine(&mut self) -> bool {
        let mut worst = vec![0.0_f64; self.counts.len()];
        for (face, [uu, uv, vv]) in self.bends.iter().enumerate() {
            let [u, v] = self.of(face).map(|count| count as f64);
            for (axis, bend) in [(0, uu / (u * u)), (1, vv / (v * v))] {
                let class = self.classes[face][axis];
                // Of a chord an eighth of the second derivative; of a twisted cell a quarter.
                worst[class] = worst[class].max(bend / 8.0 + uv / (4.0 * u * v));
            }
        }
        let Some((class, most)) = worst.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)) else { return false };
        self.counts[class] += (self.counts[class] / 16).max(1);
        *most > self.fine
    }
}
