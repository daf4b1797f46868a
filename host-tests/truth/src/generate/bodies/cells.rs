//! A body of cuboid cells: planes of degree 1, edges that bend either way or not at all.

use super::net::Net;

/// The faces between the cells that are filled and those that are not; the cells lie between these lines along x, y
/// and z.
pub(super) fn nets(lines: [&[f64]; 3], is_filled: impl Fn([usize; 3]) -> bool) -> Vec<Net> {
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
