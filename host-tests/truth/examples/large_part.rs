//! A body of many patches as a model file, to see what becomes of a large part:
//!
//! ```sh
//! cargo run --release -p palpate-truth --example large_part > large.toml && cargo palpate parts large.toml
//! ```
//!
//! A plate with dunes on it: on top a smooth bicubic spline surface as 15 × 15 Bézier patches of 8 mm, as many flat
//! ones beneath, and walls: 510 patches. A number on the command line is in the place of 15.

/// Patches along each side.
const ACROSS: usize = 15;
/// Of a patch, millimetres.
const STEP: f64 = 8.0;
const THICKNESS: f64 = 12.0;
/// Greatest height of a point of the spline's net.
const HEIGHT: f64 = 3.0;

type Point = [f64; 3];

fn main() {
    let across = std::env::args().nth(1).map_or(ACROSS, |number| number.parse().expect("a number of patches"));
    assert!(across > 0, "a plate of no patches");
    let patches = 2 * across * across + 4 * across;
    println!("# {patches} patches: cargo run -p palpate-truth --example large_part {across}");
    println!("name = \"dunes\"\nunit = \"mm\"");
    let top: Vec<Vec<[[Point; 4]; 4]>> = (0..across).map(|i| (0..across).map(|j| dune(i, j)).collect()).collect();
    let last = across - 1;
    for (i, row) in top.iter().enumerate() {
        for (j, net) in row.iter().enumerate() {
            patch(&format!("top {i} {j}"), false, &net.map(|row| row.to_vec()));
            let corner = |a: usize, b: usize| down([(i + a) as f64 * STEP, (j + b) as f64 * STEP, 0.0]);
            let rows = [0, 1].map(|a| vec![corner(a, 0), corner(a, 1)]);
            patch(&format!("bottom {i} {j}"), true, &rows);
        }
    }
    let wall = |upper: [Point; 4]| upper.map(|point| vec![point, down(point)]);
    for (i, row) in top.iter().enumerate() {
        patch(&format!("front {i}"), true, &wall(row[0].map(|row| row[0])));
        patch(&format!("back {i}"), false, &wall(row[last].map(|row| row[3])));
    }
    for (j, (first, other)) in top[0].iter().zip(&top[last]).enumerate() {
        patch(&format!("left {j}"), false, &wall(first[0]));
        patch(&format!("right {j}"), true, &wall(other[3]));
    }
}

fn down([x, y, _]: Point) -> Point {
    [x, y, -THICKNESS]
}

/// A piece of a uniform cubic spline surface over the plane, as a Bézier patch.
fn dune(i: usize, j: usize) -> [[Point; 4]; 4] {
    let net: [[f64; 4]; 4] = std::array::from_fn(|a| std::array::from_fn(|b| height(i + a, j + b)));
    let along_v = net.map(bezier);
    let columns: [[f64; 4]; 4] = std::array::from_fn(|b| bezier(along_v.map(|row| row[b])));
    let place = |index: usize, k: usize| (index as f64 + k as f64 / 3.0) * STEP;
    std::array::from_fn(|a| std::array::from_fn(|b| [place(i, a), place(j, b), columns[b][a]]))
}

/// The Bézier points of a piece of a uniform cubic spline (knot insertion).
fn bezier([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
}

/// A point of the net: any heights, the same each time.
fn height(i: usize, j: usize) -> f64 {
    let (x, y) = (i as f64, j as f64);
    0.5 * HEIGHT * ((0.9 * x + 0.3 * y).sin() + (0.7 * y - 0.4 * x).cos())
}

/// Prints a patch; its rows run along `v`.
fn patch(name: &str, flip: bool, rows: &[Vec<Point>]) {
    let [p, q] = [rows.len() - 1, rows[0].len() - 1];
    println!("\n[[patch]]\nname = \"{name}\"\ndegree = [{p}, {q}]\nflip = {flip}\npoints = {rows:?}");
}
