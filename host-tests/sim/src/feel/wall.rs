//! A flat wall across a device's workspace.

use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};

/// The sides of the wall, metres.
const SIZE: f32 = 0.16;

/// Rows: 1, s; columns: 1, t; by the axis of the normal.
static LEVEL: [[[f32; 3]; 4]; 3] = [
    [[0.0, 0.0, 0.0], [0.0, 0.0, SIZE], [0.0, SIZE, 0.0], [0.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [SIZE, 0.0, 0.0], [0.0, 0.0, SIZE], [0.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [0.0, SIZE, 0.0], [SIZE, 0.0, 0.0], [0.0, 0.0, 0.0]],
];

const fn across(axis: usize) -> SplinePatch<'static> {
    SplineTable {
        degree: [1, 1],
        breaks_u: &[0.0, 1.0],
        breaks_v: &[0.0, 1.0],
        coefficients: Coefficients::Polynomial(&LEVEL[axis]),
        shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
        orientation: Orientation::Outward,
        size_m: SIZE,
        crc: None,
    }
    .checked()
}

static WALLS: [SplinePatch<'static>; 3] = [across(0), across(1), across(2)];

/// A square wall of 160 mm through the origin. Its normal is the last axis that a device with this number of joints
/// moves along: x, y or z.
pub fn wall(joints: usize) -> &'static SplinePatch<'static> {
    &WALLS[joints.clamp(1, 3) - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::math::Vec3;
    use palpate::patch::Patch as _;

    #[test]
    fn each_wall_faces_along_its_axis_and_goes_through_the_origin() {
        for (joints, axis) in [(1, Vec3::X), (2, Vec3::Y), (3, Vec3::Z)] {
            let point = wall(joints).evaluate(0.5, 0.5);
            assert_eq!(point.point, Vec3::ZERO);
            assert_eq!(point.tangent_u.cross(point.tangent_v).normalize(), axis);
        }
    }
}
