//! Points of a face with their derivatives, for a controller of one's own.

use palpate::math::Vec3;
use palpate::patch::SplinePatch;

/// The columns `f, f_u, f_v, f_uu, f_uv, f_vv` at these parameters; `placed` says where a point of the tables lies.
pub fn columns(patch: &SplinePatch<'_>, at: &[[f64; 2]], placed: impl Fn(Vec3) -> [f64; 3]) -> [Vec<[f64; 3]>; 6] {
    let mut columns: [Vec<[f64; 3]>; 6] = Default::default();
    for [u, v] in at {
        let at = patch.evaluate_curved(*u as f32, *v as f32);
        let (surface, second) = (at.surface, at.second);
        let vectors = [surface.tangent_u, surface.tangent_v, second.half_uu * 2.0, second.uv, second.half_vv * 2.0];
        columns[0].push(placed(surface.point));
        for (column, vector) in columns[1..].iter_mut().zip(vectors) {
            column.push(vector.as_dvec3().to_array());
        }
    }
    columns
}
