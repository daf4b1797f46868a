// Baked table, not for editing: palpate bake capped_box.toml --out capped_box.rs
// Table format 7. SHA-256 of the model file: 21e70fde5e93324ff67d2d8e8050f949f102ea8475d56dd65d5be85ec60a6a0b
// A body of 6 faces, 12 edges and 8 vertices. CRC-32 of its numbers: a5742f52

// Span borders.
#[rustfmt::skip]
static BREAKS_0: [f32; 2] = [0.0, 1.0];

// Face 0: "dome".
#[rustfmt::skip]
static FACE_0: [[f32; 3]; 9] = [
    [0.03, 0.02, 0.0335],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, -0.022],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.03],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.008],
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
static FACE_1: [[f32; 3]; 6] = [
    [0.03, 0.0, 0.014],
    [0.0, 0.0, 0.028],
    [0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.016],
    [0.0, 0.0, -0.032],
];
#[rustfmt::skip]
static FACE_1_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Face 2: "side_x60".
#[rustfmt::skip]
static FACE_2: [[f32; 3]; 6] = [
    [0.06, 0.02, 0.013],
    [0.0, 0.0, 0.026],
    [0.0, 0.04, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.012],
    [0.0, 0.0, -0.024],
];
#[rustfmt::skip]
static FACE_2_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.026],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.024],
];

// Face 3: "side_y40".
#[rustfmt::skip]
static FACE_3: [[f32; 3]; 6] = [
    [0.03, 0.04, 0.014],
    [0.0, 0.0, 0.028],
    [-0.06, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.016],
    [0.0, 0.0, -0.032],
];
#[rustfmt::skip]
static FACE_3_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.028],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.032],
];

// Face 4: "side_x0".
#[rustfmt::skip]
static FACE_4: [[f32; 3]; 6] = [
    [0.0, 0.02, 0.013],
    [0.0, 0.0, 0.026],
    [0.0, -0.04, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.012],
    [0.0, 0.0, -0.024],
];
#[rustfmt::skip]
static FACE_4_SIDE_3: [[f32; 3]; 3] = [
    [0.0, 0.0, 0.026],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, -0.024],
];

// Face 5: "bottom".
#[rustfmt::skip]
static FACE_5: [[f32; 3]; 4] = [
    [0.03, 0.02, 0.0],
    [0.06, 0.0, 0.0],
    [0.0, 0.04, 0.0],
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
            degree: [2, 2],
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
                    uuu: 0.0,
                    uuv: 0.016000008,
                    uvv: 0.016000008,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: 10.414347,
                    max: 27.83647,
                },
                min_stretch: 0.001588721,
                max_stretch: 0.004844992,
                max_bend: 31.456305,
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
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_1),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.06400001,
                    uv: 0.03200001,
                    vv: 0.0,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.0,
                    uuv: 0.06400001,
                    uvv: 0.0,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0003038701,
                max_stretch: 0.0047198185,
                max_bend: 59.238007,
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
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_2),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.048000004,
                    uv: 0.024000004,
                    vv: 0.0,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.0,
                    uuv: 0.048000008,
                    uvv: 0.0,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0002772858,
                max_stretch: 0.002298244,
                max_bend: 78.84772,
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
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_3),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.06400001,
                    uv: 0.03200001,
                    vv: 0.0,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.0,
                    uuv: 0.06400001,
                    uvv: 0.0,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0003038701,
                max_stretch: 0.0047198185,
                max_bend: 59.238007,
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
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_4),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.048000004,
                    uv: 0.024000004,
                    vv: 0.0,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.0,
                    uuv: 0.048000004,
                    uvv: 0.0,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0002772858,
                max_stretch: 0.002298244,
                max_bend: 78.84772,
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
            degree: [1, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&FACE_5),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.0,
                    uv: 4.6765362e-11,
                    vv: 0.0,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.0,
                    uuv: 0.0,
                    uvv: 0.0,
                    vvv: 0.0,
                    jump_uu: 0.0,
                    jump_vv: 0.0,
                },
                curvature: palpate::patch::Curvature {
                    min: -0.0,
                    max: -0.0,
                },
                min_stretch: 0.0015999998,
                max_stretch: 0.0036,
                max_bend: 1.9485569e-8,
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
    [33229, 33230, 33010, 33043, 32941, 9, 10, 11],
    [33231, 33232, 33055, 32953, 12, 32944, 13, 14],
    [33007, 33046, 33260, 33259, 15, 16, 32998, 17],
    [33058, 32956, 33121, 33087, 18, 19, 20, 32820],
    [32863, 32866, 32887, 21, 33197, 33199, 33209, 33210],
    [32869, 32872, 22, 32890, 33201, 33202, 33211, 33212],
    [32893, 23, 32911, 32914, 33217, 33218, 33223, 33225],
    [24, 32896, 32917, 32920, 33219, 33220, 33227, 33228],
    [33233, 33234, 33233, 33234, 33249, 33243, 33249, 33243],
    [33067, 32923, 33039, 33151, 32804, 25, 32776, 26],
    [32926, 33069, 33037, 33185, 27, 33079, 28, 32844],
    [33235, 33236, 33235, 33236, 33244, 33250, 33244, 33250],
    [33071, 32929, 33189, 33061, 33081, 29, 32852, 30],
    [32932, 33073, 33089, 33063, 31, 32808, 32, 32768],
    [33042, 33149, 33129, 32989, 32772, 33, 32832, 34],
    [33040, 33187, 32986, 33127, 35, 32848, 36, 33139],
    [33263, 33262, 33263, 33262, 33271, 33267, 33271, 33267],
    [33191, 33064, 33125, 32983, 32856, 37, 33137, 38],
    [33091, 33251, 32959, 33252, 39, 32860, 40, 32974],
    [33261, 33123, 33261, 33123, 32859, 33143, 32859, 33143],
    [32875, 33083, 32881, 32780, 33203, 33198, 33205, 33206],
    [33085, 32878, 32784, 32884, 33200, 33204, 33207, 33208],
    [32899, 32788, 32905, 33147, 33213, 33214, 33221, 33224],
    [32792, 32902, 33145, 32908, 33215, 33216, 33226, 33222],
    [33164, 33239, 33163, 33028, 33178, 33180, 33177, 33179],
    [33033, 33019, 33182, 33157, 33275, 33169, 33273, 33273],
    [33240, 33237, 32935, 33075, 33247, 33245, 32947, 33245],
    [33022, 33031, 33159, 33181, 33171, 32796, 33273, 32840],
    [33238, 33241, 33077, 32938, 33246, 33248, 33246, 32950],
    [33049, 32965, 33193, 33093, 32800, 33107, 32812, 33255],
    [33242, 33102, 32977, 33101, 33114, 33116, 33113, 33115],
    [32962, 33051, 33095, 33194, 33105, 33257, 33255, 33255],
    [33184, 33153, 33036, 33013, 33272, 33272, 33274, 33165],
    [33161, 33025, 33162, 33266, 33175, 33173, 33176, 33174],
    [33155, 33183, 33016, 33034, 33272, 32836, 33167, 32828],
    [32995, 33133, 33265, 33264, 33004, 33269, 33270, 33269],
    [33195, 33097, 33052, 32971, 32816, 33256, 32824, 33111],
    [33131, 32992, 33054, 33135, 33268, 33001, 33268, 33141],
    [33099, 33196, 32968, 33253, 33256, 33256, 33109, 33258],
    [32980, 33254, 33103, 33136, 33117, 33003, 33119, 33142],
];
#[rustfmt::skip]
static ENTRIES: [u32; 508] = [
    2150444416, 3223148543, 3223716224, 1076626059, 2152541568, 3225245695, 3225813376,
    1078723211, 2152542195, 3223147520, 3225814003, 1078723211, 3221815875, 3223307845,
    3226455887, 1079580225, 3221816205, 3223308109, 3224358405, 1079850561, 3222255171,
    3225405261, 3226455557, 1079580621, 3222255501, 3224358735, 3225404997, 1079850957,
    3223071009, 3221520608, 3226281971, 1079282018, 3223071702, 3221521400, 3224184192,
    1079957858, 3223192576, 2152611835, 3225945079, 1078738839, 3223193599, 2150513792,
    3223847168, 1076641027, 3224053319, 3221785592, 3223071702, 1079958056, 3224053517,
    3222191096, 3225168161, 1079958254, 3224241151, 2151431296, 2151570560, 1077411968,
    3225168161, 3222264824, 3224184819, 1079958452, 3225168854, 3222264032, 3226281344,
    1079282612, 3225290751, 2152610944, 3225944320, 1078738179, 3226150471, 3222190304,
    3225168854, 1079282414, 3226150669, 3221784800, 3223071009, 1079282216, 3227063873,
    3221815872, 3222995525, 1078726635, 3227064269, 3222255168, 3225092941, 1078726272,
    3227334209, 3221816301, 3222995789, 1076629120, 3227334605, 3222255597, 3224113131,
    1077609029, 2150445043, 3223716851, 1076626059, 3221356800, 3223313664, 1078976507,
    3221357184, 3223305856, 1078976507, 3221357547, 3223306219, 1076878464, 3221357559,
    3223314423, 1076878464, 3221487936, 3223309632, 1078974455, 3221488629, 3223310325,
    1076876544, 3221815616, 3223309632, 1078972363, 3221816309, 3223310325, 1076874881,
    3221881088, 3223309568, 1078968295, 3221881847, 3223310327, 1076870912, 3222252800,
    3225407479, 1078968064, 3222253559, 3224354791, 1077923072, 3222254912, 3225407477,
    1078972033, 3222255605, 3224358859, 1077923136, 3222265152, 3225407477, 1078973696,
    3222265845, 3224360951, 1077923136, 3222269184, 3225411575, 1078975616, 3222269568,
    3225403371, 1078975616, 3222269931, 3224363003, 1077919360, 3222269943, 3224363003,
    1077927168, 3222405184, 3225551863, 1079050432, 3222405440, 3225551863, 1079312576,
    3222406133, 3223453952, 1080022208, 3222406141, 3223453952, 1080030400, 3222766752,
    3225946105, 1079148704, 3222767610, 3223848128, 1080027296, 3222798464, 2149334144,
    1989760, 3222799355, 2149335035, 1990651, 3223170208, 3221323840, 1078833145,
    3223171066, 3221324797, 1076735168, 3223323392, 3222275067, 1080028800, 3223323623,
    3224371328, 1080029163, 3223454711, 3224502336, 1080031225, 3223782785, 3222672382,
    1080031555, 3223782785, 3222767610, 1080027490, 3223783379, 3224768544, 1080032149,
    3223783379, 3224863904, 1080028084, 3223847927, 2150514683, 1076641687, 3223848128,
    3222767614, 1080031360, 3223848953, 3224863776, 1080032251, 3224502592, 3223454711,
    1080023033, 3224503285, 3225551104, 1079313401, 3224503293, 3225551104, 1079051257,
    3224863904, 3223848953, 1080028154, 3224864762, 3225945280, 1079149562, 3224896507,
    2151432187, 4087803, 3225267360, 3222270973, 1076735993, 3225268218, 3222270016,
    1078832320, 3225420544, 3224372219, 1079116779, 3225420775, 3222274176, 1079116416,
    3225879937, 3224769534, 1079018389, 3225879937, 3224864762, 1079149492, 3225880531,
    3222671392, 1079017795, 3225880531, 3222766752, 1079148898, 3225945280, 3224864766,
    1079018491, 3225946105, 3222766624, 1079017600, 3226765666, 3222701346, 1078396883,
    3226766260, 3224799158, 1078396289, 3226796609, 3222405376, 1078068203, 3226797005,
    3224503287, 1078067840, 3227124352, 3222274688, 1077937127, 3227124715, 3224372203,
    1077936896, 3227441506, 3222702006, 1076299137, 3227442100, 3223783379, 1077314850,
    3227496064, 3222275051, 1075839744, 3227496427, 3223323623, 1076888192, 3227506241,
    3222406135, 1075970688, 3227506637, 3223454699, 1077018880, 3222405120, 1078068215,
    3222405701, 1079579840, 3222405965, 1079850176, 3222406143, 1075970304, 3222701346,
    1079281824, 3222702006, 1079957664, 3222995525, 1079579840, 3222995789, 1079850176,
    3223307845, 1073939013, 3223308109, 1073939277, 3223323647, 1076887680, 3223454336,
    1080030785, 3223454699, 1080031181, 3223782983, 1080027688, 3223782983, 1080031753,
    3223783181, 1080027886, 3223783181, 1080031951, 3223848128, 1075283967, 3223848959,
    1077380128, 3224151424, 1075594238, 3224151424, 1075654650, 3224152051, 1077690400,
    3224152051, 1077750944, 3224218816, 1075689470, 3224218816, 1075689471, 3224219641,
    1077785632, 3224221695, 1077785632, 3224371840, 1075839999, 3224502592, 1075971071,
    3224502853, 1079851001, 3224503117, 1079580665, 3224503295, 1078067456, 3224798498,
    1079958522, 3224799158, 1079282682, 3224863904, 1076365311, 3225092677, 1079851001,
    3225092941, 1079580665, 3225267360, 1076738047, 3225290048, 1076757503, 3225404997,
    1074784077, 3225405261, 1074783813, 3225551488, 1079051213, 3225551851, 1079050817,
    3225880135, 1079018191, 3225880135, 1079149294, 3225880333, 1079017993, 3225880333,
    1079149096, 3225945280, 1077381119, 3225946105, 1075282944, 3226248576, 1077691390,
    3226248576, 1077751802, 3226249203, 1075593248, 3226249203, 1075653792, 3226315968,
    1077786622, 3226315968, 1077786623, 3226316793, 1075688448, 3226316793, 1075688480,
    3226765864, 1078396685, 3226766062, 1078396487, 3227063873, 1074921991, 3227064269,
    1077019407, 3227334209, 1074922255, 3227334605, 1077019143, 3227441704, 1076299335,
    3227441902, 1076299533, 1074004224, 1074004551, 1074004608, 1074004749, 1074004971,
    1074004983, 1074069888, 1074070515, 1074335040, 1074335303, 1074335501, 1074335733,
    1074397440, 1074397824, 1074398187, 1074398199, 1074672960, 1074673223, 1074673421,
    1074673653, 1074769152, 1074769536, 1074769899, 1074769911, 1074779520, 1074780147,
    1074781440, 1074781767, 1074781824, 1074781965, 1074782187, 1074782199, 1074790528,
    1074791040, 1074791403, 1074791419, 1074921792, 1074922053, 1074922317, 1074922485,
    1075217698, 1075218358, 1075282976, 1075283104, 1075283962, 1075283966, 1075511877,
    1075512141, 1075587361, 1075588054, 1075686560, 1075687418, 1075709248, 1075709941,
    1075971051, 1075971063, 1076299731, 1076365305, 1076569671, 1076569869, 1076667776,
    1076668403, 1076888555, 1076888571, 1077019205, 1077019469, 1077019637, 1077315510,
    1077381114, 1077381118, 1077609293, 1077684513, 1077685206, 1077784570, 1077807093,
    1078666823, 1078667021, 1078764928, 1078765555,
];
/// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 2775854930;
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
pub type Surface = palpate::body::Body<'static, palpate::field::Rigid<{ BODY.kinds() }>>;
/// The body, with code for its own kinds of patches alone.
#[allow(dead_code)]
pub const SURFACE: &Surface = &BODY.of_kinds();
/// The body with another effort in each tick, as far as it fits the bench boards' period.
#[allow(dead_code)]
pub const fn with_effort(effort: palpate::body::Effort) -> Surface {
    BODY.with_effort(effort).fitted(palpate::body::TickLimit::BENCH).of_kinds()
}
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
