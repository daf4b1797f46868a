//! A picture of the result: patches seen from a corner, seams as lines, deviation by colour.

use crate::measure::Measured;
use crate::part::Part;
use crate::patches::Made;
use glam::{DMat3, DVec2, DVec3};
use std::fmt::Write as _;

const WIDTH: f64 = 800.0;
const CELLS: usize = 6;

/// The picture as SVG. Blue is no deviation, red the tolerance.
pub fn svg(part: &Part, made: &[Made], measured: &Measured, tolerance: f64) -> String {
    // From the front, right and above: x to the right and towards the eye.
    let turn = DMat3::from_rotation_x(-0.96) * DMat3::from_rotation_z(-0.61);
    let seen = |point: DVec3| {
        let point = turn * point;
        (DVec2::new(point.x, -point.y), point.z)
    };
    let mut cells: Vec<(f64, String)> = Vec::new();
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for made in made {
        for point in &made.bezier.points {
            let (at, _) = seen(*point);
            (low, high) = (low.min(at), high.max(at));
        }
    }
    let scale = (WIDTH - 20.0) / (high - low).max_element().max(f64::MIN_POSITIVE);
    let place = |at: DVec2| (at - low) * scale + 10.0;
    for (index, made) in made.iter().enumerate() {
        let share = (measured.each[index] / tolerance).clamp(0.0, 1.0);
        let is_flipped = part.faces[made.face].flip;
        for k in 0..CELLS * CELLS {
            let corner = |i: usize, j: usize| {
                let at = [k % CELLS + i, k / CELLS + j].map(|k| k as f64 / CELLS as f64);
                made.bezier.at(at[0], at[1])[0]
            };
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
            let facing = (turn * normal).z * if is_flipped { -1.0 } else { 1.0 };
            let light = 45.0 + 40.0 * facing.abs();
            let hue = 220.0 * (1.0 - share);
            let points: Vec<DVec2> = corners.iter().map(|point| place(seen(*point).0)).collect();
            let path: Vec<String> = points.iter().map(|at| format!("{:.1},{:.1}", at.x, at.y)).collect();
            let depth = corners.iter().map(|point| seen(*point).1).sum::<f64>();
            let fill = format!("hsl({hue:.0},60%,{light:.0}%)");
            let mut cell = format!(
                "<polygon points=\"{}\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"0.6\"/>",
                path.join(" ")
            );
            // The patch's own border.
            let (i, j) = (k % CELLS, k / CELLS);
            for (is_border, a, b) in [(j == 0, 0, 1), (i == CELLS - 1, 1, 2), (j == CELLS - 1, 2, 3), (i == 0, 3, 0)] {
                if is_border {
                    let (a, b) = (points[a], points[b]);
                    let _ = write!(
                        cell,
                        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#222\" stroke-width=\"1\"/>",
                        a.x, a.y, b.x, b.y
                    );
                }
            }
            cells.push((depth, cell));
        }
    }
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let size = (high - low) * scale + 20.0;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0} {:.0}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        size.x,
        size.y + 24.0
    );
    for (_, cell) in cells {
        text.push_str(&cell);
        text.push('\n');
    }
    let _ = write!(
        text,
        "<text x=\"10\" y=\"{:.0}\">{} patches; blue: on the part, red: {tolerance} mm off</text>\n</svg>\n",
        size.y + 16.0,
        made.len()
    );
    text
}
