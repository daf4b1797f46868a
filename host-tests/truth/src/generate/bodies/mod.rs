//! Ten bodies that nobody tuned anything to: rounded, grooved, lobed, thin, pointed and hollow ones, polynomial and
//! rational, of degree 1 to 5, with knots and with poles. Lengths in millimetres; from the origin every surface point
//! is seen.

use super::models::{ellipsoid, rounded_box};
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write as _;

/// A body as a model file.
#[derive(Clone, Debug)]
pub struct DrawnBody {
    /// Its name.
    pub name: &'static str,
    /// The model file.
    pub text: String,
}

/// All ten.
pub fn ten() -> Vec<DrawnBody> {
    vec![rounded(), slab(), pebble(), pocket(), groove(), knob(), spindle(), egg(), spool(), wave()]
}

fn drawn(name: &'static str, nets: &[Net]) -> DrawnBody {
    DrawnBody { name, text: text(name, nets) }
}

/// A box with rounded edges whose corners are octants with a pole.
pub fn rounded() -> DrawnBody {
    DrawnBody { name: "brick", text: rounded_box([64.0, 38.0, 27.0], 5.5) }
}

/// The same, thin.
pub fn slab() -> DrawnBody {
    DrawnBody { name: "slab", text: rounded_box([70.0, 44.0, 3.0], 1.2) }
}

/// An ellipsoid without poles, of degree 4.
fn pebble() -> DrawnBody {
    DrawnBody { name: "pebble", text: ellipsoid("pebble", [31.0, 24.0, 17.0]) }
}

/// A block with a pocket in the middle of its top.
fn pocket() -> DrawnBody {
    let lines: [&[f64]; 3] = [&[-27.0, -12.0, 11.0, 25.0], &[-21.0, -9.0, 10.0, 22.0], &[-15.0, 3.0, 14.0]];
    drawn("pocket", &cells_nets(lines, |cell| cell != [1, 1, 1]))
}

/// A bar with a round groove.
pub fn groove() -> DrawnBody {
    drawn("groove", &grooved_nets())
}

/// A knob with four lobes.
fn knob() -> DrawnBody {
    drawn("knob", &knob_nets())
}

/// Two cones with a piece of a third between them, sharp at both ends.
fn spindle() -> DrawnBody {
    let corners = [[0.0, -25.0], [14.0, -4.0], [9.0, 10.0], [0.0, 22.0]];
    drawn("spindle", &nets(&corners.windows(2).map(<[_]>::to_vec).collect::<Vec<_>>()))
}

/// Round all over, with a pole at either end.
fn egg() -> DrawnBody {
    drawn("egg", &nets(&[vec![[0.0, -20.0], [22.0, -20.0], [16.0, 18.0], [0.0, 18.0]]]))
}

/// Two flanges with a waist between them.
fn spool() -> DrawnBody {
    let waist = vec![[16.0, -18.0], [4.0, -8.0], [4.0, 8.0], [16.0, 18.0]];
    let (lower, upper) = (vec![[0.0, -18.0], [16.0, -18.0]], vec![[16.0, 18.0], [0.0, 18.0]]);
    drawn("spool", &nets(&[lower, waist, upper]))
}

/// A block with hills and hollows, of degree 5 and 4.
fn wave() -> DrawnBody {
    drawn("wave", &wavy_nets())
}

/// A tetrahedron from four triangles, each a square with a side that is one point. The corners turn to the right, seen
/// from the first.
pub fn tetrahedron() -> DrawnBody {
    let [a, b, c, d] = [[21.0, -3.0, -12.0], [-13.0, 19.0, -11.0], [-9.0, -20.0, -14.0], [2.0, 1.0, 24.0]];
    let triangle = |apex, from, to| Net::bilinear([[apex, apex], [from, to]]);
    drawn("tetrahedron", &[triangle(a, c, b), triangle(a, b, d), triangle(a, d, c), triangle(b, c, d)])
}

// A patch as control points and knots, and the text of a model file.

/// A patch: `points[i][j] = [x, y, z, w]`, not multiplied by the weight; its normal `f_u × f_v` points outward unless
/// it is flipped.
#[derive(Clone, Debug)]
struct Net {
    pub degree: [usize; 2],
    /// From 0 to 1; without inner ones it is a Bézier patch.
    pub inner_knots: [Vec<f64>; 2],
    pub points: Vec<Vec<[f64; 4]>>,
    pub flip: bool,
}

impl Net {
    /// A Bézier patch of as high a degree as its points make it.
    pub fn bezier(points: Vec<Vec<[f64; 4]>>) -> Self {
        let degree = [points.len() - 1, points.first().map_or(0, Vec::len) - 1];
        Self { degree, inner_knots: [vec![], vec![]], points, flip: false }
    }

    /// Four corners.
    pub fn bilinear(corners: [[[f64; 3]; 2]; 2]) -> Self {
        Self::bezier(corners.map(|row| row.map(plain).to_vec()).to_vec())
    }

    pub fn flipped(self, flip: bool) -> Self {
        Self { flip, ..self }
    }
}

/// A control point of weight 1.
fn plain([x, y, z]: [f64; 3]) -> [f64; 4] {
    [x, y, z, 1.0]
}

/// The file. Every number is the shortest decimal that reads back as the same `f64`.
fn text(name: &str, nets: &[Net]) -> String {
    let mut text = format!("name = \"{name}\"\nunit = \"mm\"\n");
    for net in nets {
        let Net { degree, inner_knots, points, flip } = net;
        let clamped = |axis: usize| {
            [vec![0.0; degree[axis] + 1], inner_knots[axis].clone(), vec![1.0; degree[axis] + 1]].concat()
        };
        // A zero has no sign in a file.
        let rows: Vec<Vec<_>> =
            points.iter().map(|row| row.iter().map(|point| point.map(|x| x + 0.0)).collect()).collect();
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n[[patch]]\ndegree = {degree:?}\nflip = {flip}\nknots_u = {:?}\nknots_v = {:?}\npoints = {rows:?}\n",
            clamped(0),
            clamped(1)
        );
    }
    text
}

// What a profile sweeps about z, in four sectors; a profile that touches the axis has a pole there.

/// Of Bézier curves of `[radius, height]`, upwards on the outside.
fn nets(profile: &[Vec<[f64; 2]>]) -> Vec<Net> {
    let sector = |piece: &Vec<[f64; 2]>, turns: usize| {
        let [x, y] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][turns];
        let arc = [[x, y, 1.0], [x - y, y + x, FRAC_1_SQRT_2], [-y, x, 1.0]];
        let along = |[x, y, w]: [f64; 3]| piece.iter().map(|[radius, z]| [x * radius, y * radius, *z, w]).collect();
        Net::bezier(arc.map(along).to_vec())
    };
    profile.iter().flat_map(|piece| (0..4).map(move |turns| sector(piece, turns))).collect()
}

// A block whose top is a wave of degree (5, 4): hills, hollows and saddles.

const HALF: [f64; 2] = [27.0, 20.0];
const BOTTOM: f64 = -15.0;
/// The top's control points over an even grid.
const HEIGHTS: [[f64; 5]; 6] = [
    [10.0, 13.0, 8.0, 12.0, 9.0],
    [12.0, 24.0, -2.0, 20.0, 11.0],
    [7.0, -4.0, 25.0, 1.0, 14.0],
    [12.0, 21.0, -6.0, 26.0, 6.0],
    [9.0, 2.0, 22.0, -1.0, 12.0],
    [11.0, 14.0, 6.0, 13.0, 10.0],
];

fn wavy_nets() -> Vec<Net> {
    let point = |i: usize, j: usize| {
        let x = HALF[0] * (2.0 * i as f64 / 5.0 - 1.0);
        let y = HALF[1] * (2.0 * j as f64 / 4.0 - 1.0);
        [x, y, HEIGHTS[i][j]]
    };
    let below = |[x, y, _]: [f64; 3]| [x, y, BOTTOM];
    let top = (0..6).map(|i| (0..5).map(|j| plain(point(i, j))).collect()).collect();
    // Along a border of the top, then up.
    let wall =
        |border: Vec<[f64; 3]>| Net::bezier(border.into_iter().map(|at| vec![plain(below(at)), plain(at)]).collect());
    let corner = |i, j| below(point(i, j));
    vec![
        Net::bezier(top),
        wall((0..6).map(|i| point(i, 0)).collect()),
        wall((0..6).map(|i| point(i, 4)).collect()).flipped(true),
        wall((0..5).map(|j| point(0, j)).collect()).flipped(true),
        wall((0..5).map(|j| point(5, j)).collect()),
        Net::bilinear([[corner(0, 0), corner(0, 4)], [corner(5, 0), corner(5, 4)]]).flipped(true),
    ]
}

// A knob with four lobes: a wall of splines with inner knots, hollow between the lobes, and flat ends.

/// A quarter of the outline in a plane across the axis, C¹ over the two inner knots; at its ends it meets the next
/// quarter smoothly.
const OUTLINE: [[f64; 2]; 5] = [[20.0, 0.0], [20.0, 9.0], [11.0, 11.0], [9.0, 20.0], [0.0, 20.0]];
const INNER: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];
/// Where a control point of a straight spline with these knots lies along the line.
const EVEN: [f64; 5] = [0.0, 1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0];
/// Heights along the axis, and how wide the knob is there.
const WALL: [[f64; 2]; 3] = [[-13.0, 1.0], [0.0, 1.2], [13.0, 1.0]];
/// The corners of a square in the middle of each end lie this far out.
const MIDDLE: f64 = 8.0;

fn turned([x, y]: [f64; 2], turns: usize) -> [f64; 2] {
    (0..turns).fold([x, y], |[x, y], _| [-y, x])
}

/// Four quarters, each with two ends, and the two squares.
fn knob_nets() -> Vec<Net> {
    let mut nets = Vec::new();
    for turns in 0..4 {
        let wall = |at: [f64; 2]| {
            let [x, y] = turned(at, turns);
            WALL.map(|[z, scale]| plain([scale * x, scale * y, z])).to_vec()
        };
        let spline = |degree, points| Net { degree, inner_knots: [INNER.to_vec(), vec![]], points, flip: false };
        nets.push(spline([2, 2], OUTLINE.map(wall).to_vec()));
        for [z, _] in [WALL[0], WALL[2]] {
            let end = |index: usize| {
                let [x, y] = turned(OUTLINE[index], turns);
                let [a, b] = turned([MIDDLE * (1.0 - EVEN[index]), MIDDLE * EVEN[index]], turns);
                vec![plain([a, b, z]), plain([x, y, z])]
            };
            // Around and outward: down.
            nets.push(spline([2, 1], (0..5).map(end).collect()).flipped(z > 0.0));
        }
    }
    for [z, _] in [WALL[0], WALL[2]] {
        let corner = |turns| {
            let [x, y] = turned([MIDDLE, 0.0], turns);
            [x, y, z]
        };
        nets.push(Net::bilinear([[corner(3), corner(0)], [corner(2), corner(1)]]).flipped(z > 0.0));
    }
    nets
}

// A bar along y with a round groove along its top: an arc that bends inward, exact as a rational patch.

/// Half the bar's width, its length, and how deep it reaches.
const GROOVED_HALF: [f64; 2] = [26.0, 19.0];
const GROOVED_BOTTOM: f64 = -14.0;
const TOP: f64 = 11.0;
/// Of the groove, a quarter of a circle whose middle lies over the top.
const RADIUS: f64 = 9.0;

/// Three columns, the middle one under the groove.
fn grooved_nets() -> Vec<Net> {
    let [half, length] = GROOVED_HALF;
    let rim = RADIUS * FRAC_1_SQRT_2;
    // [x, z, weight] from left to right; the tangents at both ends of the arc meet a whole rim below the top.
    let columns: [Vec<[f64; 3]>; 3] = [
        vec![[-half, TOP, 1.0], [-rim, TOP, 1.0]],
        vec![[-rim, TOP, 1.0], [0.0, TOP - rim, FRAC_1_SQRT_2], [rim, TOP, 1.0]],
        vec![[rim, TOP, 1.0], [half, TOP, 1.0]],
    ];
    let mut nets = Vec::new();
    for column in columns {
        let [left, right] = [column[0][0], column[column.len() - 1][0]];
        let upper = |y: f64| column.iter().map(|[x, z, w]| [*x, y, *z, *w]).collect::<Vec<_>>();
        // Evenly, and with weights of 1: the line as the bottom has it.
        let lower = |y: f64| {
            let at = |index: usize| left + (right - left) * index as f64 / (column.len() - 1) as f64;
            (0..column.len()).map(|index| plain([at(index), y, GROOVED_BOTTOM])).collect::<Vec<_>>()
        };
        nets.push(Net::bezier(vec![upper(-length), upper(length)]).flipped(true));
        nets.push(Net::bilinear([
            [[left, -length, GROOVED_BOTTOM], [right, -length, GROOVED_BOTTOM]],
            [[left, length, GROOVED_BOTTOM], [right, length, GROOVED_BOTTOM]],
        ]));
        nets.push(Net::bezier(vec![lower(-length), upper(-length)]).flipped(true));
        nets.push(Net::bezier(vec![lower(length), upper(length)]));
    }
    for x in [-half, half] {
        let corner = |y: f64, z: f64| [x, y, z];
        let wall = Net::bilinear([
            [corner(-length, GROOVED_BOTTOM), corner(-length, TOP)],
            [corner(length, GROOVED_BOTTOM), corner(length, TOP)],
        ]);
        nets.push(wall.flipped(x < 0.0));
    }
    nets
}

// A body of cuboid cells: planes of degree 1, edges that bend either way or not at all.

/// The faces between the cells that are filled and those that are not; the cells lie between these lines along x, y
/// and z.
fn cells_nets(lines: [&[f64]; 3], is_filled: impl Fn([usize; 3]) -> bool) -> Vec<Net> {
    let counts = lines.map(|lines| lines.len() - 1);
    let is_filled = |cell: [Option<usize>; 3]| {
        let [Some(x), Some(y), Some(z)] = cell else { return false };
        x < counts[0] && y < counts[1] && z < counts[2] && is_filled([x, y, z])
    };
    let mut nets = Vec::new();
    for (x, y, z) in
        (0..counts[0]).flat_map(|x| (0..counts[1]).flat_map(move |y| (0..counts[2]).map(move |z| (x, y, z))))
    {
        let cell = [x, y, z];
        if !is_filled(cell.map(Some)) {
            continue;
        }
        for (axis, is_upper) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let mut beside = cell.map(Some);
            beside[axis] = if is_upper { Some(cell[axis] + 1) } else { cell[axis].checked_sub(1) };
            if !is_filled(beside) {
                nets.push(face(lines, cell, axis, is_upper));
            }
        }
    }
    nets
}

/// One side of a cell: `u` and `v` run along the two axes that follow, so that `f_u × f_v` points up.
fn face(lines: [&[f64]; 3], cell: [usize; 3], axis: usize, is_upper: bool) -> Net {
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |along_u: usize, along_v: usize| {
        let mut at = [0.0; 3];
        at[axis] = lines[axis][cell[axis] + usize::from(is_upper)];
        at[first] = lines[first][cell[first] + along_u];
        at[second] = lines[second][cell[second] + along_v];
        at
    };
    Net::bilinear([[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]]).flipped(!is_upper)
}
