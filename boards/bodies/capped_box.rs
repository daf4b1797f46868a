// Baked table, not for editing: palpate bake capped_box.toml --out capped_box.rs
// Table format 7. SHA-256 of the model file: 21e70fde5e93324ff67d2d8e8050f949f102ea8475d56dd65d5be85ec60a6a0b
// A body of 6 faces, 12 edges and 8 vertices. CRC-32 of its numbers: a9d065db

// Span borders.
#[rustfmt::skip]
static BREAKS_0: [f32; 2] = [0.0, 1.0];

// Face 0: "dome".
#[rustfmt::skip]
static FACE_0: [[f32; 3]; 16] = [
    [0.03, 0.02, 0.0335],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, -0.022],
    [0.0, -2e-10, 0.0],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.03],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.008],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_0_SIDE_0: [[f32; 3]; 3] = [
    [-0.06, -0.0, -0.03],
    [-0.0, -0.0, -0.0],
    [-0.0, -0.0, -0.008],
];
#[rustfmt::skip]
static FACE_0_SIDE_1: [[f32; 3]; 3] = [
    [0.06, 0.0, -0.03],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.008],
];
#[rustfmt::skip]
static FACE_0_SIDE_2: [[f32; 3]; 3] = [
    [-0.0, -0.04, -0.022],
    [-0.0, -0.0, -0.0],
    [-0.0, -0.0, -0.008],
];
#[rustfmt::skip]
static FACE_0_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.04, -0.022],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.008],
];

// Face 1: "side_y0".
#[rustfmt::skip]
static FACE_1: [[f32; 3]; 16] = [
    [0.03, 0.0, 0.014],
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 1.2375001e-10],
    [0.0, 0.0, 1.025e-10],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.016],
    [0.0, 0.0, -0.032],
    [0.0, 0.0, -3.1500003e-10],
    [0.0, 0.0, 2.999999e-11],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_1_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Face 2: "side_x60".
#[rustfmt::skip]
static FACE_2: [[f32; 3]; 16] = [
    [0.06, 0.02, 0.013],
    [0.0, 0.0, 0.026],
    [0.0, 0.0, -2.25e-11],
    [0.0, 0.0, -5.5e-11],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.012],
    [0.0, 0.0, -0.024],
    [0.0, 0.0, 2.7e-10],
    [0.0, 0.0, 6.6e-10],
    [0.0, -2e-10, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_2_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.026],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.024],
];

// Face 3: "side_y40".
#[rustfmt::skip]
static FACE_3: [[f32; 3]; 16] = [
    [0.03, 0.04, 0.014],
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 1.2375001e-10],
    [0.0, 0.0, 1.025e-10],
    [-0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.016],
    [0.0, 0.0, -0.032],
    [0.0, 0.0, -3.1500003e-10],
    [0.0, 0.0, 2.999999e-11],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_3_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Face 4: "side_x0".
#[rustfmt::skip]
static FACE_4: [[f32; 3]; 16] = [
    [0.0, 0.02, 0.013],
    [0.0, 0.0, 0.026],
    [0.0, 0.0, -2.25e-11],
    [0.0, 0.0, -5.5e-11],
    [0.0, -0.04, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.012],
    [0.0, 0.0, -0.024],
    [0.0, 0.0, 2.7e-10],
    [0.0, 0.0, 6.6e-10],
    [0.0, 2e-10, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_4_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.026],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.024],
];

// Face 5: "bottom".
#[rustfmt::skip]
static FACE_5: [[f32; 3]; 16] = [
    [0.03, 0.02, 0.0],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, -2e-10, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

// Edge 0.
#[rustfmt::skip]
static EDGE_0: [[f32; 3]; 3] = [
    [3.469447e-18, 0.02, 0.026],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, -0.024],
];

// Edge 1.
#[rustfmt::skip]
static EDGE_1: [[f32; 3]; 3] = [
    [0.06, 0.02, 0.026],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, -0.024],
];

// Edge 2.
#[rustfmt::skip]
static EDGE_2: [[f32; 3]; 3] = [
    [0.03, 3.469447e-18, 0.028],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Edge 3.
#[rustfmt::skip]
static EDGE_3: [[f32; 3]; 3] = [
    [0.03, 0.04, 0.028],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Edge 4.
#[rustfmt::skip]
static EDGE_4: [[f32; 3]; 2] = [[3.469447e-18, 0.0, 0.01], [0.0, 0.0, 0.02]];

// Edge 5.
#[rustfmt::skip]
static EDGE_5: [[f32; 3]; 2] = [[0.06, 0.0, 0.01], [0.0, 0.0, 0.02]];

// Edge 6.
#[rustfmt::skip]
static EDGE_6: [[f32; 3]; 2] = [[0.03, 0.0, 0.0], [0.06, 0.0, 0.0]];

// Edge 7.
#[rustfmt::skip]
static EDGE_7: [[f32; 3]; 2] = [[0.06, 0.04, 0.01], [0.0, 0.0, 0.02]];

// Edge 8.
#[rustfmt::skip]
static EDGE_8: [[f32; 3]; 2] = [[0.06, 0.02, 0.0], [0.0, 0.04, 0.0]];

// Edge 9.
#[rustfmt::skip]
static EDGE_9: [[f32; 3]; 2] = [[3.469447e-18, 0.04, 0.01], [0.0, 0.0, 0.02]];

// Edge 10.
#[rustfmt::skip]
static EDGE_10: [[f32; 3]; 2] = [[0.03, 0.04, 0.0], [-0.06, 0.0, 0.0]];

// Edge 11.
#[rustfmt::skip]
static EDGE_11: [[f32; 3]; 2] = [[0.0, 0.02, 0.0], [0.0, -0.04, 0.0]];

#[rustfmt::skip]
static FACES: [palpate::body::Face; 6] = [
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_0),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.064,
                    uv: 0.008000003,
                    vv: 0.048000004,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 4.46869e-9,
                    uuv: 0.016000008,
                    uvv: 0.016000008,
                    vvv: 5.66869e-9,
                    jump_uu: 1.0654187e-15,
                    jump_vv: 1.351521e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: 10.41762,
                    max: 27.820251,
                },
                min_stretch: 0.0015893048,
                max_stretch: 0.004844992,
                max_bend: 31.43603,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.06,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 0,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_0,
                    ),
                    second_derivative: 0.016000003,
                }),
            },
            palpate::body::Side::Edge {
                edge: 1,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_1,
                    ),
                    second_derivative: 0.016000003,
                }),
            },
            palpate::body::Side::Edge {
                edge: 2,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_2,
                    ),
                    second_derivative: 0.016000003,
                }),
            },
            palpate::body::Side::Edge {
                edge: 3,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_3,
                    ),
                    second_derivative: 0.016000003,
                }),
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_1),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.06400001,
                    uv: 0.03200001,
                    vv: 6.0176547e-10,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 4.46869e-9,
                    uuv: 0.06400001,
                    uvv: 5.18869e-9,
                    vvv: 5.12869e-9,
                    jump_uu: 1.0654187e-15,
                    jump_vv: 1.222775e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.00030398238,
                max_stretch: 0.004719708,
                max_bend: 59.20362,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.06,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 4,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-16.666666, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 5,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(16.666666, 0.0, 0.0),
                    offset: 0.99999994,
                },
            },
            palpate::body::Side::Edge {
                edge: 6,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 0.0, -35.714287),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 2,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_1_SIDE_3,
                    ),
                    second_derivative: 0.06400001,
                }),
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_2),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.048000004,
                    uv: 0.024000004,
                    vv: 4.6676557e-10,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 5.6686895e-9,
                    uuv: 0.048000008,
                    uvv: 6.98869e-9,
                    vvv: 5.12869e-9,
                    jump_uu: 1.3515209e-15,
                    jump_vv: 1.222775e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.00027739094,
                max_stretch: 0.0022981395,
                max_bend: 78.805695,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.04,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 5,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -25.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 7,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 25.0, 0.0),
                    offset: 1.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 8,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 0.0, -38.46154),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 1,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_2_SIDE_3,
                    ),
                    second_derivative: 0.048000004,
                }),
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_3),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.06400001,
                    uv: 0.03200001,
                    vv: 6.0176547e-10,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 4.46869e-9,
                    uuv: 0.06400001,
                    uvv: 5.18869e-9,
                    vvv: 5.12869e-9,
                    jump_uu: 1.0654187e-15,
                    jump_vv: 1.222775e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.00030398238,
                max_stretch: 0.004719708,
                max_bend: 59.20362,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.06,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 7,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(16.666666, 0.0, 0.0),
                    offset: 0.99999994,
                },
            },
            palpate::body::Side::Edge {
                edge: 9,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-16.666666, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 10,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -0.0, -35.714287),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 3,
                reversed: true,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_3_SIDE_3,
                    ),
                    second_derivative: 0.06400001,
                }),
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_4),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.048000004,
                    uv: 0.024000004,
                    vv: 4.5117712e-10,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 4.179127e-9,
                    uuv: 0.048000008,
                    uvv: 5.4991274e-9,
                    vvv: 3.6391268e-9,
                    jump_uu: 9.963815e-16,
                    jump_vv: 8.6763544e-16,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.00027739094,
                max_stretch: 0.0022981395,
                max_bend: 78.805695,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.04,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 9,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 25.0, 0.0),
                    offset: 1.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 4,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -25.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 11,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-0.0, 0.0, -38.46154),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 0,
                reversed: true,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 2,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_4_SIDE_3,
                    ),
                    second_derivative: 0.048000004,
                }),
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [3, 3],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_5),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 6.467655e-10,
                    uv: 4.6765362e-11,
                    vv: 4.6765362e-11,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 5.66869e-9,
                    uuv: 4.46869e-9,
                    uvv: 4.46869e-9,
                    vvv: 4.46869e-9,
                    jump_uu: 1.351521e-15,
                    jump_vv: 1.0654187e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0015999998,
                max_stretch: 0.0036,
                max_bend: 4.0519654e-7,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.06,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 6,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -25.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 10,
                reversed: true,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 25.0, 0.0),
                    offset: 1.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 11,
                reversed: true,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-16.666666, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 8,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(16.666666, 0.0, 0.0),
                    offset: 0.99999994,
                },
            },
        ],
    },
];
#[rustfmt::skip]
static EDGES: [palpate::body::Edge; 12] = [
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_0),
            second_derivative: 0.048000004,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 0,
            },
            palpate::body::EdgeFace {
                face: 4,
                side: 3,
            },
        ],
        ends: [0, 1],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_1),
            second_derivative: 0.048000004,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 2,
                side: 3,
            },
        ],
        ends: [2, 3],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_2),
            second_derivative: 0.06400001,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 1,
                side: 3,
            },
        ],
        ends: [0, 2],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_3),
            second_derivative: 0.06400001,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 3,
            },
            palpate::body::EdgeFace {
                face: 3,
                side: 3,
            },
        ],
        ends: [1, 3],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_4),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 1,
                side: 0,
            },
            palpate::body::EdgeFace {
                face: 4,
                side: 1,
            },
        ],
        ends: [4, 0],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_5),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 1,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 2,
                side: 0,
            },
        ],
        ends: [5, 2],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_6),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 1,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 5,
                side: 0,
            },
        ],
        ends: [4, 5],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_7),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 2,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 3,
                side: 0,
            },
        ],
        ends: [6, 3],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_8),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 2,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 5,
                side: 3,
            },
        ],
        ends: [5, 6],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_9),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 3,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 4,
                side: 0,
            },
        ],
        ends: [7, 1],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_10),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 3,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 5,
                side: 1,
            },
        ],
        ends: [6, 7],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_11),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [
            palpate::body::EdgeFace {
                face: 4,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 5,
                side: 2,
            },
        ],
        ends: [7, 4],
        kind: palpate::body::EdgeKind::Convex,
    },
];
#[rustfmt::skip]
static VERTICES: [palpate::body::Vertex; 8] = [
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.0, 0.02),
        outward: palpate::math::vec3(-0.6796613, -0.68437976, 0.263979),
        first_spoke: 0,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.04, 0.02),
        outward: palpate::math::vec3(-0.6796613, 0.68437976, 0.263979),
        first_spoke: 3,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.06, 0.0, 0.02),
        outward: palpate::math::vec3(0.6796613, -0.68437976, 0.263979),
        first_spoke: 6,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.06, 0.04, 0.02),
        outward: palpate::math::vec3(0.6796613, 0.68437976, 0.263979),
        first_spoke: 9,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.0, 0.0),
        outward: palpate::math::vec3(-0.57735026, -0.57735026, -0.57735026),
        first_spoke: 12,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.06, 0.0, 0.0),
        outward: palpate::math::vec3(0.57735026, -0.57735026, -0.57735026),
        first_spoke: 15,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.06, 0.04, 0.0),
        outward: palpate::math::vec3(0.57735026, 0.57735026, -0.57735026),
        first_spoke: 18,
        spokes: 3,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.04, 0.0),
        outward: palpate::math::vec3(-0.57735026, 0.57735026, -0.57735026),
        first_spoke: 21,
        spokes: 3,
        is_open: false,
    },
];
#[rustfmt::skip]
static SPOKES: [palpate::body::Spoke; 24] = [
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.8574929, 0.51449573),
        edge: 0,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.88235295, 0.0, 0.47058824),
        edge: 2,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.0, -1.0),
        edge: 4,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.8574929, 0.51449573),
        edge: 0,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.88235295, 0.0, 0.47058824),
        edge: 3,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.0, -1.0),
        edge: 9,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.8574929, 0.51449573),
        edge: 1,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.88235295, -0.0, 0.47058824),
        edge: 2,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.0, -1.0),
        edge: 5,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.8574929, 0.51449573),
        edge: 1,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.88235295, -0.0, 0.47058824),
        edge: 3,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -0.0, -1.0),
        edge: 7,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 4,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, 0.0, 0.0),
        edge: 6,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, 1.0, -0.0),
        edge: 11,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 5,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, -0.0, -0.0),
        edge: 6,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 1.0, 0.0),
        edge: 8,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 7,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -1.0, -0.0),
        edge: 8,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, 0.0, 0.0),
        edge: 10,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 9,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, -0.0, -0.0),
        edge: 10,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, -1.0, 0.0),
        edge: 11,
        at_upper_end: false,
    },
];

#[rustfmt::skip]
static NODES: [[u16; 8]; 41] = [
    [1, 2, 3, 4, 5, 6, 7, 8],
    [33229, 33230, 33010, 33043, 32929, 9, 10, 11],
    [33231, 33232, 33055, 32947, 12, 32932, 13, 14],
    [33007, 33046, 33257, 33256, 15, 16, 32992, 17],
    [33058, 32950, 33109, 33107, 18, 19, 20, 32820],
    [32863, 32941, 32881, 21, 33197, 33199, 33209, 33210],
    [32944, 32866, 22, 32884, 33201, 33202, 33211, 33212],
    [32887, 23, 32905, 33004, 33217, 33218, 33223, 33225],
    [24, 32890, 33001, 32908, 33219, 33220, 33227, 33228],
    [33233, 33174, 33233, 33174, 33247, 33241, 33247, 33241],
    [33067, 32911, 33039, 33165, 32804, 25, 32776, 26],
    [32914, 33173, 33037, 33175, 27, 33075, 28, 32844],
    [33182, 33234, 33182, 33234, 33242, 33248, 33242, 33248],
    [33181, 32917, 33183, 33061, 33077, 29, 32852, 30],
    [32920, 33069, 33193, 33063, 31, 32808, 32, 32768],
    [33042, 33167, 33113, 32983, 32772, 33, 32832, 34],
    [33040, 33177, 32980, 33179, 35, 32848, 36, 33125],
    [33258, 33180, 33258, 33180, 33266, 33262, 33266, 33262],
    [33185, 33064, 33187, 32977, 32856, 37, 33123, 38],
    [33195, 33196, 32974, 33249, 39, 32860, 40, 32965],
    [33188, 33111, 33188, 33111, 32859, 33131, 32859, 33131],
    [32869, 33079, 32875, 32780, 33203, 33198, 33205, 33206],
    [33081, 32872, 32784, 32878, 33200, 33204, 33207, 33208],
    [32893, 32788, 32899, 33135, 33213, 33214, 33221, 33224],
    [32792, 32896, 33133, 32902, 33215, 33216, 33226, 33222],
    [33148, 33237, 33147, 33028, 33162, 33164, 33161, 33163],
    [33033, 33019, 33170, 33141, 33270, 33153, 33268, 33268],
    [33238, 33235, 32923, 33071, 33245, 33243, 32935, 33243],
    [33022, 33031, 33143, 33169, 33155, 32796, 33268, 32840],
    [33236, 33239, 33073, 32926, 33244, 33246, 33244, 32938],
    [33049, 32956, 33189, 33083, 32800, 33095, 32812, 33252],
    [33240, 33092, 32968, 33091, 33102, 33104, 33101, 33103],
    [32953, 33051, 33085, 33190, 33093, 33254, 33252, 33252],
    [33172, 33137, 33036, 33013, 33267, 33267, 33269, 33149],
    [33145, 33025, 33146, 33261, 33159, 33157, 33160, 33158],
    [33139, 33171, 33016, 33034, 33267, 32836, 33151, 32828],
    [32989, 33117, 33260, 33259, 32998, 33264, 33265, 33264],
    [33191, 33087, 33052, 32962, 32816, 33253, 32824, 33099],
    [33115, 32986, 33054, 33121, 33263, 32995, 33263, 33127],
    [33089, 33192, 32959, 33250, 33253, 33253, 33097, 33255],
    [32971, 33251, 33119, 33120, 33105, 32997, 33129, 33128],
];
#[rustfmt::skip]
static ENTRIES: [u32; 503] = [
    2150444416, 3223148543, 3223716224, 1076626059, 2152541568, 3225245695, 3225813376,
    1078723211, 2152542195, 3223147520, 3225814003, 1078723211, 3221815875, 3223307845,
    3226455887, 1079580225, 3221816205, 3223308109, 3224358405, 1079850561, 3222255171,
    3225405261, 3226455557, 1079580621, 3222255501, 3224358735, 3225404997, 1079850957,
    3223071009, 3221520608, 3226281971, 1079282018, 3223071702, 3221521400, 3224184192,
    1079957858, 3223192576, 2152611835, 3225945079, 1078738839, 3223193599, 2150513792,
    3223847168, 1076641027, 3224053319, 3221785592, 3223071702, 1079958056, 3224053517,
    3222191096, 3225168161, 1079958254, 3224895616, 2151431296, 2151570560, 1076757503,
    3225168161, 3222264824, 3224184819, 1079958452, 3225168854, 3222264032, 3226281344,
    1079282612, 3225290751, 2152610944, 3225944320, 1078738179, 3226150471, 3222190304,
    3225168854, 1079282414, 3226150669, 3221784800, 3223071009, 1079282216, 3227063873,
    3221815872, 3222995525, 1078726635, 3227064269, 3222255168, 3225092941, 1078726272,
    3227334209, 3221816301, 3222995789, 1076629120, 3227334605, 3222255597, 3224113131,
    1077609029, 2150445043, 3223716851, 1076626059, 3221356800, 3223313664, 1078976507,
    3221357559, 3223314423, 1076878464, 3221487936, 3223309632, 1078974455, 3221488629,
    3223310325, 1076876544, 3221815616, 3223309632, 1078972363, 3221816309, 3223310325,
    1076874881, 3221881088, 3223313664, 1078968295, 3221881847, 3223314423, 1076870912,
    3222252800, 3225411575, 1078968064, 3222253559, 3224354791, 1077927168, 3222254912,
    3225407477, 1078972033, 3222255605, 3224358859, 1077923136, 3222265152, 3225407477,
    1078973696, 3222265845, 3224360951, 1077923136, 3222269184, 3225411575, 1078975616,
    3222269943, 3224363003, 1077927168, 3222405184, 3225551863, 1079050432, 3222405440,
    3225551863, 1079312576, 3222406133, 3223453952, 1080022208, 3222406141, 3223453952,
    1080030400, 3222766752, 3225946105, 1079148704, 3222767610, 3223848128, 1080027296,
    3222798464, 2149334144, 1989760, 3222799355, 2149335035, 1990651, 3223170208,
    3221323840, 1078833145, 3223171066, 3221324797, 1076735168, 3223305856, 3221357184,
    1078976507, 3223306219, 3221357547, 1076878464, 3223323392, 3222275067, 1080028800,
    3223323623, 3224371328, 1080029163, 3223782785, 3222672382, 1080031555, 3223782785,
    3222767610, 1080027490, 3223783379, 3224768544, 1080032149, 3223783379, 3224863904,
    1080028084, 3223847927, 2150514683, 1076641687, 3223848128, 3222767614, 1080031360,
    3223848953, 3224863776, 1080032251, 3224502336, 3223454711, 1080031225, 3224502592,
    3223454711, 1080023033, 3224503285, 3225551104, 1079313401, 3224503293, 3225551104,
    1079051257, 3224863904, 3223848953, 1080028154, 3224864762, 3225945280, 1079149562,
    3224896507, 2151432187, 4087803, 3225267360, 3222270973, 1076735993, 3225268218,
    3222270016, 1078832320, 3225403008, 3222269931, 1076879355, 3225403371, 3222269568,
    1078975616, 3225420544, 3224372219, 1079116779, 3225420775, 3222274176, 1079116416,
    3225879937, 3224769534, 1079018389, 3225879937, 3224864762, 1079149492, 3225880531,
    3222671392, 1079017795, 3225880531, 3222766752, 1079148898, 3225945280, 3224864766,
    1079018491, 3225946105, 3222766624, 1079017600, 3226765666, 3222701346, 1078396883,
    3226766260, 3224799158, 1078396289, 3226796609, 3222405376, 1078068203, 3226797005,
    3224503287, 1078067840, 3227124352, 3222274688, 1077937127, 3227124715, 3224372203,
    1077936896, 3227441506, 3222702006, 1076299137, 3227442100, 3223783379, 1077314850,
    3227496064, 3222275051, 1075839744, 3227496427, 3223323623, 1076888192, 3227506241,
    3222406135, 1075970688, 3227506637, 3223454699, 1077018880, 3222405120, 1078068215,
    3222406143, 1075970304, 3222701346, 1079281824, 3222702006, 1079957664, 3222995525,
    1079579840, 3222995789, 1079850176, 3223307845, 1073939013, 3223308109, 1073939277,
    3223782983, 1080027688, 3223782983, 1080031753, 3223783181, 1080027886, 3223783181,
    1080031951, 3223848128, 1075283967, 3224151424, 1075594238, 3224151424, 1075654650,
    3224152051, 1077690400, 3224152051, 1077750944, 3224218816, 1075689470, 3224218816,
    1075689471, 3224219641, 1077785632, 3224371328, 1075839999, 3224371840, 1075839999,
    3224502592, 1075971071, 3224503295, 1078067456, 3224798498, 1079958522, 3224799158,
    1079282682, 3224863776, 1076365311, 3224863904, 1076365311, 3225092677, 1079851001,
    3225092941, 1079580665, 3225267360, 1076738047, 3225269280, 1076738047, 3225290048,
    1076757503, 3225404997, 1074784077, 3225405261, 1074783813, 3225880135, 1079018191,
    3225880135, 1079149294, 3225880333, 1079017993, 3225880333, 1079149096, 3225945280,
    1077381119, 3225946105, 1075282944, 3226248576, 1077691390, 3226248576, 1077751802,
    3226249203, 1075593248, 3226249203, 1075653792, 3226315968, 1077786622, 3226315968,
    1077786623, 3226316793, 1075688448, 3226316793, 1075688480, 3226534465, 1078068203,
    3226534861, 1078067840, 3226765864, 1078396685, 3226766062, 1078396487, 3227063488,
    1074922053, 3227063873, 1074921991, 3227064269, 1077019407, 3227064313, 1077019469,
    3227333824, 1074922317, 3227334209, 1074922255, 3227334605, 1077019143, 3227334649,
    1077019205, 3227441704, 1076299335, 3227441902, 1076299533, 3227514433, 1075970688,
    3227514829, 1075971051, 1074004224, 1074004551, 1074004608, 1074004749, 1074004971,
    1074004983, 1074069888, 1074070515, 1074335040, 1074335303, 1074335501, 1074335733,
    1074397440, 1074397824, 1074398187, 1074398199, 1074672960, 1074673223, 1074673421,
    1074673653, 1074769152, 1074769536, 1074769899, 1074769911, 1074779520, 1074780147,
    1074781440, 1074781767, 1074781824, 1074781965, 1074782187, 1074782199, 1074790528,
    1074791040, 1074791403, 1074791419, 1074921792, 1074922485, 1075217698, 1075218358,
    1075282976, 1075283104, 1075283962, 1075283966, 1075511877, 1075512141, 1075587361,
    1075588054, 1075686560, 1075687418, 1075709248, 1075709941, 1075971063, 1076299731,
    1076365305, 1076569671, 1076569869, 1076667776, 1076668403, 1076888555, 1076888571,
    1077019637, 1077315510, 1077381114, 1077381118, 1077609293, 1077684513, 1077685206,
    1077784570, 1077807093, 1078666823, 1078667021, 1078764928, 1078765555,
];
/// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 2849007067;
/// The body.
#[allow(dead_code, long_running_const_eval)]
#[rustfmt::skip]
pub static BODY: palpate::body::Body = palpate::body::BodyTables {
    faces: &FACES,
    edges: &EDGES,
    vertices: &VERTICES,
    spokes: &SPOKES,
    locator: palpate::body::Locator {
        corner: palpate::math::vec3(-0.03, -0.04, -0.04325),
        side: 0.12,
        nodes: &NODES,
        entries: &ENTRIES,
    },
    size_m: 0.06,
    is_convex: true,
    crc: Some(TABLE_CRC),
}
    .checked();
/// The type of the surface.
#[allow(dead_code)]
pub type Surface = palpate::body::Body<'static>;
/// The body.
#[allow(dead_code)]
pub const SURFACE: &Surface = &BODY;
/// The body with another effort in each tick.
#[allow(dead_code)]
pub const fn with_effort(effort: palpate::body::Effort) -> Surface {
    BODY.with_effort(effort)
}
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
