//! A body of many patches as the text of a model file, to see what becomes of a large part: a plate with dunes on it.
//! On top lies a smooth bicubic spline surface as Bézier patches of 8 mm, beneath as many flat ones, around them walls.

use std::fmt::Write as _;

/// Of a patch, millimetres.
const STEP: f64 = 8.0;
const THICKNESS: f64 = 12.0;
/// Maximum height of a point of the spline's net.
const HEIGHT: f64 = 3.0;

type Point = [f64; 3];

/// The model file, with `across` patches along each side: for `n` there are `2 n² + 4 n` patches.
///
/// # Panics
/// If `across` is 0.
pub fn dunes(across: usize) -> String {
    assert!(across > 0, "a plate of no patches");
    let patches = 2 * across * across + 4 * across;
    let mut text = format!("# {patches} patches: cargo run -p palpate-truth --example large_part {across}\n");
    text += "name = \"dunes\"\nunit = \"mm\"\n";
    let top: Vec<Vec<[[Point; 4]; 4]>> = (0..across).map(|i| (0..across).map(|j| dune(i, j)).collect()).collect();
    let last = across - 1;
    for (i, row) in top.iter().enumerate() {
        for (j, net) in row.iter().enumerate() {
            patch(&mut text, &format!("top {i} {j}"), false, &net.map(|row| row.to_vec()));
            let corner = |a: usize, b: usize| down([(i + a) as f64 * STEP, (j + b) as f64 * STEP, 0.0]);
            let rows = [0, 1].map(|a| vec![corner(a, 0), corner(a, 1)]);
            patch(&mut text, &format!("bottom {i} {j}"), true, &rows);
        }
    }
    let wall = |upper: [Point; 4]| upper.map(|point| vec![point, down(point)]);
    for (i, row) in top.iter().enumerate() {
        patch(&mut text, &format!("front {i}"), true, &wall(row[0].map(|row| row[0])));
        patch(&mut text, &format!("back {i}"), false, &wall(row[last].map(|row| row[3])));
    }
    for (j, (first, other)) in top[0].iter().zip(&top[last]).enumerate() {
        patch(&mut text, &format!("left {j}"), false, &wall(first[0]));
        patch(&mut text, &format!("right {j}"), true, &wall(other[3]));
    }
    text
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

/// Adds a patch; its rows run along `v`.
fn patch(text: &mut String, name: &str, flip: bool, rows: &[Vec<Point>]) {
    let [p, q] = [rows.len() - 1, rows[0].len() - 1];
    let _ = writeln!(text, "\n[[patch]]\nname = \"{name}\"\ndegree = [{p}, {q}]\nflip = {flip}\npoints = {rows:?}");
}
