// Baked table, not for editing: palpate bake table1c.toml --out table1c.rs
// Table format 8. SHA-256 of the model file: 668530816185a611a71cfead6cb364236b8674232ce642dbeb8effb2de5e210d

// Patch 0, "S".
#[rustfmt::skip]
static PATCH_0_BREAKS_U: [f32; 4] = [0.0, 0.33333334, 0.6666667, 1.0];
#[rustfmt::skip]
static PATCH_0_BREAKS_V: [f32; 4] = [0.0, 0.33333334, 0.6666667, 1.0];
#[rustfmt::skip]
static PATCH_0_COEFFICIENTS: [[f32; 3]; 81] = [
    [0.025, 0.025, 0.04125],
    [0.12, 0.0, 0.074999996],
    [-0.18, 0.0, -0.135],
    [0.0, 0.12, 0.12],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, -0.18, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.05125, 0.025, 0.052500002],
    [0.075, 0.0, 0.0],
    [0.045, 0.0, -0.09],
    [0.0, 0.12, 0.12],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, -0.18, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.081250004, 0.025, 0.041249998],
    [0.105000004, 0.0, -0.07500001],
    [0.045, 0.0, -0.135],
    [0.0, 0.12, 0.12],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, -0.18, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.025, 0.05125, 0.06125],
    [0.12, 0.0, 0.074999996],
    [-0.18, 0.0, -0.135],
    [0.0, 0.075, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.05125, 0.05125, 0.0725],
    [0.075, 0.0, 0.0],
    [0.045, 0.0, -0.09],
    [0.0, 0.075, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.081250004, 0.05125, 0.061249997],
    [0.105000004, 0.0, -0.07500001],
    [0.045, 0.0, -0.135],
    [0.0, 0.075, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.025, 0.081250004, 0.041249994],
    [0.12, 0.0, 0.074999996],
    [-0.18, 0.0, -0.135],
    [0.0, 0.105000004, -0.12000001],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.05125, 0.081250004, 0.052499995],
    [0.075, 0.0, 0.0],
    [0.045, 0.0, -0.09],
    [0.0, 0.105000004, -0.12000001],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.081250004, 0.081250004, 0.04124999],
    [0.105000004, 0.0, -0.07500001],
    [0.045, 0.0, -0.135],
    [0.0, 0.105000004, -0.12000001],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.045, -0.18],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

/// All patches of the model, in the order of its file.
#[allow(dead_code, long_running_const_eval)]
#[rustfmt::skip]
pub static PATCHES: [palpate::patch::SplinePatch; 1] = [
    palpate::patch::SplineTable {
        degree: [2, 2],
        breaks_u: &PATCH_0_BREAKS_U,
        breaks_v: &PATCH_0_BREAKS_V,
        coefficients: palpate::patch::Coefficients::Polynomial(&PATCH_0_COEFFICIENTS),
        shape: palpate::patch::ShapeBounds {
            second_derivatives: palpate::patch::SecondDerivativeBounds {
                uu: 0.50911695,
                uv: 7.01481e-10,
                vv: 0.45000005,
            },
            third_derivatives: palpate::patch::ThirdDerivativeBounds {
                uuu: 0.0,
                uuv: 2.0109108e-7,
                uvv: 2.0109108e-7,
                vvv: 0.0,
                jump_uu: 0.45000005,
                jump_vv: 0.45891178,
            },
            curvature: palpate::patch::Curvature {
                min: -2.959249e-10,
                max: 70.97095,
            },
            min_stretch: 0.0035884618,
            max_stretch: 0.079200014,
            max_bend: 131.06499,
        },
        orientation: palpate::patch::Orientation::Inward,
        size_m: 0.1,
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
pub const TABLE_CRC: u32 = 2188311744;
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
