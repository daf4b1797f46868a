//! Models of whole bodies, exact, as text of model files: those that ship in `host-tests/models` and are written by
//! `PALPATE_WRITE=1 cargo test -p palpate-suites --test tables models`.

mod cube_sphere;
mod half_ball;
mod text;

pub use half_ball::half_ball;
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write as _;
use text::BezierPatch;

/// A model file that ships.
#[derive(Clone, Debug)]
pub struct GeneratedModel {
    /// Its file name, without a folder.
    pub file: &'static str,
    /// Its content.
    pub text: String,
}

/// Half axes of both ellipsoids, mm.
pub const HALF_AXES: [f64; 3] = [50.0, 35.0, 25.0];
/// Radius of the sphere, mm.
pub const RADIUS: f64 = 50.0;

/// The text of an ellipsoid's model file, without poles: six patches of degree (4, 4). Half axes in millimetres.
pub fn ellipsoid(name: &str, half_axes: [f64; 3]) -> String {
    text::model(&format!("An ellipsoid with half axes {half_axes:?} mm."), name, &cube_sphere::patches(half_axes))
}

/// All of them.
pub fn all() -> Vec<GeneratedModel> {
    let poles = "without poles: six patches of degree (4, 4), a cube blown up to a sphere (host-tests/truth/src/generate/models/cube_sphere.rs).";
    vec![
        GeneratedModel {
            file: "sphere_body.toml",
            text: text::model(
                &format!("A sphere of radius {RADIUS} mm, exact and {poles}"),
                "sphere-body",
                &cube_sphere::patches([RADIUS; 3]),
            ),
        },
        GeneratedModel {
            file: "ellipsoid_body.toml",
            text: text::model(
                &format!("An ellipsoid with half axes 50, 35 and 25 mm, exact and {poles}"),
                "ellipsoid-body",
                &cube_sphere::patches(HALF_AXES),
            ),
        },
        GeneratedModel {
            file: "ellipsoid_poles.toml",
            text: text::model(
                "The same ellipsoid, half axes 50, 35 and 25 mm, from eight octants of degree (2, 2) that meet in two poles.",
                "ellipsoid-poles",
                &patches(HALF_AXES),
            ),
        },
        GeneratedModel {
            file: "rounded_cylinder.toml",
            text: text::model(
                "A cylinder of radius 30 mm and height 50 mm about z whose rims are rounded by 8 mm: all edges are smooth. Exact; four \
                 sectors, and each cap is a square with four patches around it, so that there are no poles.",
                "rounded-cylinder",
                &rounded_cylinder_patches(SHAPE),
            ),
        },
        GeneratedModel {
            file: "thin_plate.toml",
            text: text::model("A plate of 60 x 40 x 2 mm.", "thin-plate", &plate_patches([60.0, 40.0, 2.0])),
        },
    ]
}

// An ellipsoid from eight octants of degree (2, 2), each with a side that is one point, the pole.

/// A quarter of the unit circle: control points and weights.
const QUARTER: [[f64; 3]; 3] = [[1.0, 0.0, 1.0], [1.0, 1.0, FRAC_1_SQRT_2], [0.0, 1.0, 1.0]];

/// The quarter rotated by `turns` right angles about the origin.
fn quarter(turns: usize) -> [[f64; 3]; 3] {
    QUARTER.map(|[x, y, w]| match turns % 4 {
        0 => [x, y, w],
        1 => [-y, x, w],
        2 => [-x, -y, w],
        _ => [y, -x, w],
    })
}

/// `u` runs about z, `v` from the equator to a pole.
fn patches(half_axes: [f64; 3]) -> Vec<BezierPatch> {
    let octant = |sector: usize, upper: bool| {
        let point = |[x, y, w]: [f64; 3], [radius, height, weight]: [f64; 3]| {
            let height = if upper { height } else { -height };
            let [x, y, z] = [x * radius, y * radius, height];
            [x * half_axes[0], y * half_axes[1], z * half_axes[2], w * weight]
        };
        let points = quarter(sector).map(|about| QUARTER.map(|along| point(about, along)).to_vec()).to_vec();
        let name = format!("{}{sector}", if upper { "upper" } else { "lower" });
        BezierPatch { name, degree: [2, 2], points, flip: !upper }
    };
    [true, false].into_iter().flat_map(|upper| (0..4).map(move |sector| octant(sector, upper))).collect()
}

// A cuboid from six planes.

/// A cuboid from the origin to a corner.
fn plate_patches([x, y, z]: [f64; 3]) -> Vec<BezierPatch> {
    let plane = |name: &str, origin: [f64; 3], u: [f64; 3], v: [f64; 3]| {
        let at = |s: f64, t: f64| {
            let [x, y, z] = [0, 1, 2].map(|axis| origin[axis] + s * u[axis] + t * v[axis]);
            [x, y, z, 1.0]
        };
        let points = vec![vec![at(0.0, 0.0), at(0.0, 1.0)], vec![at(1.0, 0.0), at(1.0, 1.0)]];
        BezierPatch { name: name.to_owned(), degree: [1, 1], points, flip: false }
    };
    let (along_x, along_y, along_z) = ([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]);
    vec![
        plane("top", along_z, along_x, along_y),
        plane("bottom", [0.0; 3], along_y, along_x),
        plane("front", [0.0; 3], along_x, along_z),
        plane("back", along_y, along_z, along_x),
        plane("left", [0.0; 3], along_z, along_y),
        plane("right", along_x, along_y, along_z),
    ]
}

// Patches as text of a model file, to be edited.

/// A corner, in the model's unit.
pub type Corner = [f64; 3];

/// A cuboid's six patches as text, all normals inward if it is a hollow.
pub fn cuboid(name: &str, [x0, y0, z0]: Corner, [x1, y1, z1]: Corner, hollow: bool) -> String {
    // A corner, and where u and v lead from it.
    let sides = [
        ("top", [[x0, y0, z1], [x1, y0, z1], [x0, y1, z1]], false),
        ("bottom", [[x0, y0, z0], [x1, y0, z0], [x0, y1, z0]], true),
        ("left", [[x0, y0, z0], [x0, y1, z0], [x0, y0, z1]], true),
        ("right", [[x1, y0, z0], [x1, y1, z0], [x1, y0, z1]], false),
        ("front", [[x0, y0, z0], [x1, y0, z0], [x0, y0, z1]], false),
        ("back", [[x0, y1, z0], [x1, y1, z0], [x0, y1, z1]], true),
    ];
    let mut text = String::new();
    for (side, [from, u, v], flip) in sides {
        let far = [0, 1, 2].map(|axis| u[axis] + v[axis] - from[axis]);
        let flip = flip != hollow;
        let _ = write!(
            text,
            "[[patch]]\nname = \"{name} {side}\"\ndegree = [1, 1]\npoints = [[{from:?}, {v:?}], [{u:?}, {far:?}]]\nflip = {flip}\n"
        );
    }
    text
}

/// Why an edit cannot be made.
const MODEL: &str = "text of a model file";

/// The text of a model with all its points moved, in its unit.
///
/// # Panics
/// If it is no model.
pub fn moved(text: &str, offset: [f64; 3]) -> String {
    let mut model: toml::Table = text.parse().expect(MODEL);
    for patch in model["patch"].as_array_mut().expect(MODEL) {
        for point in
            patch["points"].as_array_mut().expect(MODEL).iter_mut().flat_map(|row| row.as_array_mut().expect(MODEL))
        {
            for (coordinate, by) in point.as_array_mut().expect(MODEL).iter_mut().zip(offset) {
                let at = coordinate.as_float().or_else(|| coordinate.as_integer().map(|at| at as f64)).expect(MODEL);
                *coordinate = toml::Value::Float(at + by);
            }
        }
    }
    model.to_string()
}

// A cuboid with all edges rounded alike: planes, quarters of cylinders, and octants of spheres with a pole each.

/// The text of its model file; sides and radius in millimetres, the origin in its middle.
pub fn rounded_box(sides: [f64; 3], radius: f64) -> String {
    let about = format!("A box of {sides:?} mm, its edges rounded by {radius} mm.");
    text::model(&about, "rounded-box", &rounded_box_patches(sides, radius))
}

fn rounded_box_patches(sides: [f64; 3], radius: f64) -> Vec<BezierPatch> {
    let [x, y, z] = sides.map(|side| 0.5 * side - radius);
    // The centre of the octant of a sector about z.
    let corner = |sector: usize| match sector % 4 {
        0 => [x, y],
        1 => [-x, y],
        2 => [-x, -y],
        _ => [x, -y],
    };
    let at = |[cx, cy]: [f64; 2], [dx, dy, w]: [f64; 3], [out, up, weight]: [f64; 3], level: f64| {
        [cx + radius * dx * out, cy + radius * dy * out, level * (z + radius * up), w * weight]
    };
    let equator = [1.0, 0.0, 1.0];
    let mut patches = Vec::new();
    for sector in 0..4 {
        let [start, ..] = quarter(sector);
        // Along a side of the box, between two corners, in the direction in which a sector begins.
        let along = [corner(sector + 3), corner(sector)];
        let mut add = |name: &str, degree, points, flip| {
            patches.push(BezierPatch { name: format!("{name}{sector}"), degree, points, flip });
        };
        for (level, name) in [(1.0, "upper"), (-1.0, "lower")] {
            let octant = quarter(sector).map(|about| QUARTER.map(|up| at(corner(sector), about, up, level)).to_vec());
            add(&format!("{name}_corner"), [2, 2], octant.to_vec(), level < 0.0);
            let edge = along.map(|end| QUARTER.map(|up| at(end, start, up, level)).to_vec());
            add(&format!("{name}_edge"), [1, 2], edge.to_vec(), level < 0.0);
        }
        let upright = |centre, about| [-1.0, 1.0].map(|level| at(centre, about, equator, level)).to_vec();
        add("upright_edge", [2, 1], quarter(sector).map(|about| upright(corner(sector), about)).to_vec(), false);
        add("side", [1, 1], along.map(|end| upright(end, start)).to_vec(), false);
    }
    for (level, name) in [(1.0, "top"), (-1.0, "bottom")] {
        let point = |sector| at(corner(sector), [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], level);
        let points = vec![vec![point(2), point(1)], vec![point(3), point(0)]];
        patches.push(BezierPatch { name: name.to_owned(), degree: [1, 1], points, flip: level < 0.0 });
    }
    patches
}

// A cylinder with rounded rims, in four sectors, without poles.

/// The shape, mm.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// Of the wall.
    pub radius: f64,
    /// From cap to cap.
    pub height: f64,
    /// Of the rims' rounding.
    pub rounding: f64,
}

/// The one that ships.
const SHAPE: Shape = Shape { radius: 30.0, height: 50.0, rounding: 8.0 };

/// The middle of the body is the origin. A point of the profile is `[radius, height, weight]`.
fn rounded_cylinder_patches(shape: Shape) -> Vec<BezierPatch> {
    let Shape { radius, height, rounding } = shape;
    let (inner, wall) = (radius - rounding, 0.5 * height - rounding);
    let rim = QUARTER.map(|[r, h, w]| [inner + rounding * r, wall + rounding * h, w]);
    let mirrored = |[r, h, w]: [f64; 3]| [r, -h, w];
    let mut patches = Vec::new();
    for sector in 0..4 {
        // `u` runs about z, `v` up the profile.
        let turned = |kind: &str, profile: &[[f64; 3]]| {
            let point = |[x, y, w]: [f64; 3], [r, h, weight]: [f64; 3]| [x * r, y * r, h, w * weight];
            let row = |about| profile.iter().map(|along| point(about, *along)).collect();
            BezierPatch {
                name: format!("{kind}{sector}"),
                degree: [2, profile.len() - 1],
                points: quarter(sector).map(row).to_vec(),
                flip: false,
            }
        };
        patches.push(turned("wall", &[[radius, -wall, 1.0], [radius, wall, 1.0]]));
        patches.push(turned("upper_rim", &rim));
        let [a, b, c] = rim.map(mirrored);
        patches.push(turned("lower_rim", &[c, b, a]));
    }
    for (kind, z, flip) in [("top", 0.5 * height, false), ("bottom", -0.5 * height, true)] {
        patches.extend(cap(kind, inner, z, flip));
    }
    patches
}

/// A disc: a square whose corners lie halfway out, and between each of its sides and the circle a patch ruled by
/// straight lines. Along the side the weights are 1, as the square's are; along the arc they are the arc's.
fn cap(kind: &str, radius: f64, z: f64, flip: bool) -> Vec<BezierPatch> {
    let corner = |turns: usize| {
        let [[x, y, _], ..] = quarter(turns);
        [0.5 * radius * x, 0.5 * radius * y, z, 1.0]
    };
    let square = BezierPatch {
        name: format!("{kind}_middle"),
        degree: [1, 1],
        points: vec![vec![corner(3), corner(0)], vec![corner(2), corner(1)]],
        // The corners run clockwise from (u, v) = (0, 0).
        flip: !flip,
    };
    let sector = |turns: usize| {
        let (from, to) = (corner(turns), corner(turns + 1));
        let halfway = [0, 1, 2, 3].map(|axis| 0.5 * (from[axis] + to[axis]));
        let arc = quarter(turns).map(|[x, y, w]| [radius * x, radius * y, z, w]);
        let [a, b, c] = arc;
        BezierPatch {
            name: format!("{kind}{turns}"),
            degree: [1, 2],
            points: vec![vec![from, halfway, to], vec![a, b, c]],
            flip,
        }
    };
    [square].into_iter().chain((0..4).map(sector)).collect()
}
