//! What a profile sweeps about z, in four sectors; a profile that touches the axis has a pole there.

use super::net::Net;
use std::f64::consts::FRAC_1_SQRT_2;

/// Of Bézier curves of `[radius, height]`, upwards on the outside.
pub(super) fn nets(profile: &[Vec<[f64; 2]>]) -> Vec<Net> {
    let sector = |piece: &Vec<[f64; 2]>, turns: usize| {
        let [x, y] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][turns];
        let arc = [[x, y, 1.0], [x - y, y + x, FRAC_1_SQRT_2], [-y, x, 1.0]];
        let along = |[x, y, w]: [f64; 3]| piece.iter().map(|[radius, z]| [x * radius, y * radius, *z, w]).collect();
        Net::bezier(arc.map(along).to_vec())
    };
    profile.iter().flat_map(|piece| (0..4).map(move |turns| sector(piece, turns))).collect()
}
