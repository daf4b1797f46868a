//! An exact sphere without poles: six rational patches of degree (4, 4).
//!
//! # Derivation
//! A pair of complex numbers `ψ = (a, b)`, a spinor, names the point `(2 Re āb, 2 Im āb, |a|² − |b|²) / (|a|² + |b|²)`
//! of the unit sphere; a common factor does not matter. So a polynomial `ψ(u, v)` of degree (2, 2) is a rational patch
//! of degree (4, 4) that lies on the sphere exactly.
//!
//! The face about +z of a cube blown up to the sphere has its corners at `(±1, ±1, 1)/√3` and great circles between
//! them. Take corner spinors `ψ = (cos θ/2, e^{iφ} sin θ/2)` with `cos θ = 1/√3` and `φ` an odd multiple of 45°. The
//! segment from one spinor to another is the short great circle if their product `⟨ψ, χ⟩` is real and positive. For
//! neighbouring corners it is not: its argument is `α = arctan(tan² θ/2) = 15°`, a quarter of half the face's solid
//! angle 2π/3. (That the phases do not close around the face is why no patch of degree (2, 2) does it.) So a border is
//! the segment to `e^{−iα} χ` times a linear factor whose argument makes the α good: `((1 − t) ψ + t e^{−iα} χ) ((1 −
//! t) + t e^{iα})`, of degree 2, with control spinors `ψ, (e^{−iα} χ + e^{iα} ψ)/2, χ`. The factor's square is common
//! to all four homogeneous coordinates: the border is the great circle, at a pace that is the same from both ends. The
//! middle control spinor is free; `(cos θ/2 · cos² α, 0)` continues the pattern of the others.

use super::text::BezierPatch;
use std::f64::consts::FRAC_PI_4;

/// A complex number.
type Complex = [f64; 2];
/// A rotation.
type Turn = fn([f64; 3]) -> [f64; 3];

/// The homogeneous control points of the face about +z of the unit sphere.
fn face() -> [[[f64; 4]; 5]; 5] {
    let spinors = spinors();
    let mut net = [[[0.0; 4]; 5]; 5];
    for (i, j, k, l) in (0..81).map(|n| (n % 3, n / 3 % 3, n / 9 % 3, n / 27)) {
        let share = quartic_share(i, k) * quartic_share(j, l);
        let ([a, b], [c, d]) = (spinors[i][j], spinors[k][l]);
        let [re, im] = conjugate_product(a, d);
        // Summed over all pairs, the parts that are not symmetric in the two spinors cancel.
        let (upper, lower) = (conjugate_product(a, c)[0], conjugate_product(b, d)[0]);
        let entry = [2.0 * re, 2.0 * im, upper - lower, upper + lower];
        for (total, value) in net[i + k][j + l].iter_mut().zip(entry) {
            *total += share * value;
        }
    }
    net
}

/// The control spinors; `u` runs along x, `v` along y.
fn spinors() -> [[[Complex; 2]; 3]; 3] {
    let cosine = 1.0 / 3.0_f64.sqrt();
    let (c, s) = ((0.5 * (1.0 + cosine)).sqrt(), (0.5 * (1.0 - cosine)).sqrt());
    let alpha = (s * s / (c * c)).atan();
    let corner = |x: f64, y: f64| [[c, 0.0], [s * FRAC_PI_4.cos() * x, s * FRAC_PI_4.sin() * y]];
    let turned = |[a, b]: [Complex; 2], angle: f64| {
        let factor = [angle.cos(), angle.sin()];
        [product(factor, a), product(factor, b)]
    };
    // From one corner to the next, anticlockwise about z.
    let middle = |from: [Complex; 2], to: [Complex; 2]| {
        let (from, to) = (turned(from, alpha), turned(to, -alpha));
        [0, 1].map(|component| [0, 1].map(|part| 0.5 * (from[component][part] + to[component][part])))
    };
    let [sw, se, ne, nw] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let centre = [[c * alpha.cos() * alpha.cos(), 0.0], [0.0, 0.0]];
    [[sw, middle(nw, sw), nw], [middle(sw, se), centre, middle(ne, nw)], [se, middle(se, ne), ne]]
}

fn product([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

/// `ā b`.
fn conjugate_product([a, b]: Complex, other: Complex) -> Complex {
    product([a, -b], other)
}

/// A control point of the face about +z, `x, y, z, w`, from the eighth of the net that the others mirror: so that all
/// symmetries of the cube, and with them the borders that two faces share, hold to the last bit.
fn symmetric_point(net: &[[[f64; 4]; 5]; 5], i: usize, j: usize) -> [f64; 4] {
    let (x_off, y_off) = (i as isize - 2, j as isize - 2);
    let (large, small) = (x_off.abs().max(y_off.abs()), x_off.abs().min(y_off.abs()));
    let [x, y, z, w] = net[(2 + large) as usize][(2 + small) as usize];
    let [mut x, mut y, mut z] = [x / w, y / w, z / w];
    if large == 2 {
        // On the border, the plane x = z.
        x = 0.5 * (x + z);
        z = x;
    }
    if small == large {
        x = if large == 2 { x } else { 0.5 * (x + y) };
        y = x;
    }
    let along_x = if x_off.abs() >= y_off.abs() { x } else { y };
    let along_y = if x_off.abs() >= y_off.abs() { y } else { x };
    [along_x * x_off.signum() as f64, along_y * y_off.signum() as f64, z, w]
}

/// The six patches of an ellipsoid with these half axes.
pub(super) fn patches(half_axes: [f64; 3]) -> Vec<BezierPatch> {
    let net = face();
    let heaviest = net.iter().flatten().map(|[.., w]| *w).fold(0.0, f64::max);
    // Right-handed, so that the outward normal is f_u × f_v: each turns +z into another of the six directions.
    let turns: [(&str, Turn); 6] = [
        ("+z", |[x, y, z]| [x, y, z]),
        ("-z", |[x, y, z]| [x, -y, -z]),
        ("+x", |[x, y, z]| [z, x, y]),
        ("-x", |[x, y, z]| [-z, x, -y]),
        ("+y", |[x, y, z]| [y, z, x]),
        ("-y", |[x, y, z]| [-y, -z, x]),
    ];
    turns
        .into_iter()
        .map(|(name, turn)| {
            let point = |i: usize, j: usize| {
                let [x, y, z, w] = symmetric_point(&net, i, j);
                let [x, y, z] = turn([x, y, z]);
                [x * half_axes[0], y * half_axes[1], z * half_axes[2], w / heaviest]
            };
            let points = (0..5).map(|i| (0..5).map(|j| point(i, j)).collect()).collect();
            BezierPatch { name: name.to_owned(), degree: [4, 4], points, flip: false }
        })
        .collect()
}

/// How much the product of the Bernstein coefficients `i` and `k` of two parabolas adds to coefficient `i + k` of the
/// quartic: `C(2, i) C(2, k) / C(4, i + k)`.
fn quartic_share(i: usize, k: usize) -> f64 {
    const OF_TWO: [f64; 3] = [1.0, 2.0, 1.0];
    const OF_FOUR: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
    OF_TWO[i] * OF_TWO[k] / OF_FOUR[i + k]
}
