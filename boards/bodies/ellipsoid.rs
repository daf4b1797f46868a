// Baked table, not for editing: palpate bake ellipsoid.toml --out ellipsoid.rs
// Table format 8. SHA-256 of the model file: e52eb8a1a86691231b9d0c9a61c8223adead9325d1ae123056db7d8bae331d8f

// Patch 0, "cap".
#[rustfmt::skip]
static PATCH_0_BREAKS_U: [f32; 2] = [0.0, 1.0];
#[rustfmt::skip]
static PATCH_0_BREAKS_V: [f32; 2] = [0.0, 1.0];
#[rustfmt::skip]
static PATCH_0_COEFFICIENTS: [[f32; 4]; 9] = [
    [0.0, 0.0, 0.02, 0.6666667],
    [0.0, 0.06, 0.0, 0.0],
    [0.0, 0.0, -0.02, 0.6666667],
    [0.08, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -0.02, 0.6666667],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
];

/// All patches of the model, in the order of its file.
#[allow(dead_code, long_running_const_eval)]
#[rustfmt::skip]
pub static PATCHES: [palpate::patch::SplinePatch; 1] = [
    palpate::patch::SplineTable {
        degree: [2, 2],
        breaks_u: &PATCH_0_BREAKS_U,
        breaks_v: &PATCH_0_BREAKS_V,
        coefficients: palpate::patch::Coefficients::Rational(&PATCH_0_COEFFICIENTS),
        shape: palpate::patch::ShapeBounds {
            second_derivatives: palpate::patch::SecondDerivativeBounds {
                uu: 0.18266162,
                uv: 0.07750345,
                vv: 0.14129409,
            },
            third_derivatives: palpate::patch::ThirdDerivativeBounds {
                uuu: 0.7256523,
                uuv: 0.18439472,
                uvv: 0.24201487,
                vvv: 0.5475642,
                jump_uu: 1.7300898e-7,
                jump_vv: 1.3054948e-7,
            },
            curvature: palpate::patch::Curvature {
                min: 7.9618325,
                max: 43.74316,
            },
            min_stretch: 0.0018785878,
            max_stretch: 0.014551159,
            max_bend: 123.56153,
        },
        orientation: palpate::patch::Orientation::Outward,
        size_m: 0.096,
        crc: Some(TABLE_CRC),
    }
        .checked(),
];
/// The type of the surface.
#[allow(dead_code)]
pub type Surface = palpate::patch::SplinePatch<'static>;
/// The first patch.
#[allow(dead_code)]
pub const SURFACE: &Surface = &PATCHES[0];
/// The first patch: a tick of a patch takes one step at any effort.
#[allow(dead_code)]
pub const fn with_effort(_: palpate::body::Effort) -> Surface {
    PATCHES[0]
}
/// CRC-32 of its numbers, [`palpate::patch::SplinePatch::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 2552934459;
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
