// Baked table, not for editing: palpate bake capped_box.toml --out capped_box.rs
// Table format 7. SHA-256 of the model file: 21e70fde5e93324ff67d2d8e8050f949f102ea8475d56dd65d5be85ec60a6a0b
// A body of 6 faces, 12 edges and 8 vertices. CRC-32 of its numbers: ff96fa28

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
static NODES: [[u16; 8]; 17] = [
    [1, 2, 3, 4, 5, 6, 7, 8],
    [33030, 33031, 32925, 32934, 32992, 32993, 32841, 9],
    [33032, 33033, 32940, 32910, 32994, 32995, 10, 32832],
    [32922, 32937, 33035, 33034, 32838, 11, 32997, 32996],
    [32943, 32913, 32970, 32968, 12, 32835, 32954, 32952],
    [32844, 32847, 32868, 13, 32998, 33000, 33010, 33011],
    [32850, 32853, 14, 32871, 33002, 33003, 33012, 33013],
    [32874, 15, 32892, 32895, 33018, 33019, 33024, 33026],
    [16, 32877, 32898, 32901, 33020, 33021, 33028, 33029],
    [32904, 32956, 32928, 32984, 32800, 32960, 32780, 32816],
    [32958, 32907, 32988, 32946, 32962, 32804, 32824, 32768],
    [32931, 32986, 32919, 32974, 32776, 32820, 32812, 32978],
    [32990, 32949, 32972, 32916, 32828, 32772, 32976, 32808],
    [32856, 32964, 32862, 32784, 33004, 32999, 33006, 33007],
    [32966, 32859, 32788, 32865, 33001, 33005, 33008, 33009],
    [32880, 32792, 32886, 32982, 33014, 33015, 33022, 33025],
    [32796, 32883, 32980, 32889, 33016, 33017, 33027, 33023],
];
#[rustfmt::skip]
static ENTRIES: [u32; 268] = [
    2150433408, 3221816311, 3223193589, 1080022593, 2150433771, 3222255607, 3225290048,
    1080022989, 2152530560, 3222254848, 3225290741, 1079313357, 2152530923, 3221815552,
    3223192896, 1079312961, 3221815875, 3223307845, 3226455887, 1079580225, 3221816205,
    3223308109, 3224358405, 1079850561, 3222255171, 3225405261, 3226455557, 1079580621,
    3222255501, 3224358735, 3225404997, 1079850957, 3223192896, 2152596471, 3221356800,
    1079312576, 3223193589, 2150498560, 3221357559, 1080022208, 3225290048, 2150499319,
    3222269943, 1080023033, 3225290741, 2152595712, 3222269184, 1079313401, 3227063873,
    3221815872, 3222995525, 1078726635, 3227064269, 3222255168, 3225092941, 1078726272,
    3227334209, 3221816301, 3222995789, 1076629120, 3227334605, 3222255597, 3224113131,
    1077609029, 2150499072, 2149450747, 1080028800, 2150499303, 2151547008, 1080029163,
    2152596224, 2151547899, 1079116779, 2152596455, 2149449856, 1079116416, 3221356800,
    3223313664, 1078976507, 3221357184, 3223305856, 1078976507, 3221357547, 3223306219,
    1076878464, 3221357559, 3223314423, 1076878464, 3221487936, 3223309632, 1078974455,
    3221488629, 3223310325, 1076876544, 3221815616, 3223309632, 1078972363, 3221816309,
    3223310325, 1076874881, 3221881088, 3223309568, 1078968295, 3221881847, 3223310327,
    1076870912, 3222252800, 3225407479, 1078968064, 3222253559, 3224354791, 1077923072,
    3222254912, 3225407477, 1078972033, 3222255605, 3224358859, 1077923136, 3222265152,
    3225407477, 1078973696, 3222265845, 3224360951, 1077923136, 3222269184, 3225411575,
    1078975616, 3222269568, 3225403371, 1078975616, 3222269931, 3224363003, 1077919360,
    3222269943, 3224363003, 1077927168, 3222405440, 3225551863, 1079312576, 3222406133,
    3223453952, 1080022208, 3223323392, 3222275067, 1080028800, 3223323623, 3224371328,
    1080029163, 3224502592, 3223454711, 1080023033, 3224503285, 3225551104, 1079313401,
    3225420544, 3224372219, 1079116779, 3225420775, 3222274176, 1079116416, 3226796609,
    3222405376, 1078068203, 3226797005, 3224503287, 1078067840, 3227124352, 3222274688,
    1077937127, 3227124715, 3224372203, 1077936896, 3227496064, 3222275051, 1075839744,
    3227496427, 3223323623, 1076888192, 3227506241, 3222406135, 1075970688, 3227506637,
    3223454699, 1077018880, 2151547008, 1076757503, 2151547520, 1076757503, 3222405701,
    1079579840, 3222405965, 1079850176, 3222995525, 1079579840, 3222995789, 1079850176,
    3223307845, 1073939013, 3223308109, 1073939277, 3223323647, 1076887680, 3224371840,
    1075839999, 3224502853, 1079851001, 3224503117, 1079580665, 3225092677, 1079851001,
    3225092941, 1079580665, 3225404997, 1074784077, 3225405261, 1074783813, 3227063873,
    1074921991, 3227064269, 1077019407, 3227334209, 1074922255, 3227334605, 1077019143,
    1966208, 1966720, 1967083, 1967099, 4064235, 4064251, 1074004224, 1074004551,
    1074004608, 1074004749, 1074004971, 1074004983, 1074069888, 1074070515, 1074335040,
    1074335303, 1074335501, 1074335733, 1074397440, 1074397824, 1074398187, 1074398199,
    1074672960, 1074673223, 1074673421, 1074673653, 1074769152, 1074769536, 1074769899,
    1074769911, 1074779520, 1074780147, 1074781440, 1074781767, 1074781824, 1074781965,
    1074782187, 1074782199, 1074790528, 1074791040, 1074791403, 1074791419, 1076888555,
    1076888571,
];
/// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 4288084520;
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
