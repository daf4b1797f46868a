// Baked table, not for editing: palpate bake capped_box.toml --out capped_box.rs
// Table format 8. SHA-256 of the model file: 21e70fde5e93324ff67d2d8e8050f949f102ea8475d56dd65d5be85ec60a6a0b
// A body of 6 faces, 12 edges and 8 vertices. CRC-32 of its numbers: fc82de86

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
    [279, 280, 174, 183, 241, 242, 90, 9],
    [281, 282, 189, 159, 243, 244, 10, 81],
    [171, 186, 284, 283, 87, 11, 246, 245],
    [192, 162, 219, 217, 12, 84, 203, 201],
    [93, 96, 117, 13, 247, 249, 259, 260],
    [99, 102, 14, 120, 251, 252, 261, 262],
    [123, 15, 141, 144, 267, 268, 273, 275],
    [16, 126, 147, 150, 269, 270, 277, 278],
    [153, 205, 177, 233, 49, 209, 29, 65],
    [207, 156, 237, 195, 211, 53, 73, 17],
    [180, 235, 168, 223, 25, 69, 61, 227],
    [239, 198, 221, 165, 77, 21, 225, 57],
    [105, 213, 111, 33, 253, 248, 255, 256],
    [215, 108, 37, 114, 250, 254, 257, 258],
    [129, 41, 135, 231, 263, 264, 271, 274],
    [45, 132, 229, 138, 265, 266, 276, 272],
];
#[rustfmt::skip]
static RECTANGLES: [u8; 324] = [
    128, 2, 125, 63, 144, 245, 7, 30, 100, 253, 235, 3, 125, 127, 251, 64, 5, 222, 124,
    253, 0, 181, 223, 60, 80, 0, 1, 25, 36, 80, 67, 2, 89, 100, 252, 79, 207, 31, 100,
    145, 141, 3, 217, 116, 252, 5, 206, 31, 100, 211, 67, 182, 223, 124, 145, 141, 183,
    223, 124, 211, 247, 3, 14, 16, 32, 192, 0, 5, 16, 224, 247, 3, 2, 76, 253, 247, 239,
    159, 127, 253, 0, 237, 159, 63, 80, 64, 2, 89, 36, 176, 235, 15, 12, 100, 251, 77, 3,
    11, 232, 192, 237, 3, 217, 126, 251, 0, 3, 190, 63, 224, 128, 238, 127, 62, 224, 128,
    0, 190, 254, 254, 235, 3, 2, 40, 32, 0, 221, 191, 255, 253, 128, 190, 191, 254, 251,
    128, 220, 127, 255, 253, 64, 1, 4, 212, 252, 247, 215, 95, 63, 64, 245, 207, 15, 80,
    253, 64, 1, 185, 252, 252, 245, 3, 25, 232, 252, 0, 1, 10, 208, 252, 231, 191, 127,
    63, 160, 247, 207, 15, 240, 251, 0, 173, 127, 255, 250, 64, 181, 95, 127, 251, 64,
    221, 95, 255, 253, 64, 1, 82, 63, 32, 0, 3, 176, 63, 0, 231, 3, 0, 8, 0, 128, 2, 10,
    40, 0, 235, 3, 186, 62, 0, 128, 174, 191, 254, 250, 255, 3, 14, 40, 224, 69, 2, 2,
    76, 145, 77, 3, 2, 76, 211, 69, 2, 211, 52, 48, 255, 3, 144, 127, 211, 249, 23, 217,
    116, 254, 69, 230, 127, 32, 32, 15, 3, 178, 62, 224, 0, 1, 116, 36, 64, 128, 2, 212,
    48, 64, 235, 3, 116, 63, 64, 128, 1, 53, 63, 80, 64, 13, 121, 228, 144, 13, 15, 89,
    255, 144, 64, 53, 126, 100, 227, 13, 55, 94, 127, 227, 128, 213, 63, 127, 253, 71,
    222, 15, 232, 253, 13, 223, 191, 254, 253, 0, 0, 0, 0,
];
#[rustfmt::skip]
static CANDIDATES: [u8; 404] = [
    9, 48, 2, 71, 96, 7, 137, 48, 10, 207, 96, 15, 17, 48, 16, 79, 96, 19, 145, 48, 20,
    199, 96, 23, 131, 113, 26, 211, 97, 31, 3, 114, 34, 75, 98, 39, 131, 242, 34, 83, 98,
    43, 195, 178, 28, 175, 97, 47, 199, 16, 49, 35, 99, 53, 71, 144, 54, 131, 99, 59,
    207, 144, 48, 195, 99, 63, 79, 16, 55, 3, 100, 67, 247, 49, 68, 103, 36, 73, 183, 50,
    74, 207, 36, 79, 119, 50, 80, 199, 164, 78, 247, 50, 82, 139, 228, 70, 73, 85, 86,
    150, 149, 90, 205, 101, 95, 81, 213, 86, 22, 22, 91, 197, 101, 99, 35, 115, 100, 114,
    54, 98, 135, 38, 103, 3, 118, 106, 202, 54, 56, 231, 166, 108, 3, 119, 114, 82, 55,
    118, 135, 167, 122, 195, 119, 114, 242, 55, 128, 135, 167, 130, 67, 120, 134, 146,
    56, 138, 199, 168, 142, 3, 249, 140, 242, 56, 146, 139, 232, 134, 67, 249, 120, 50,
    56, 150, 235, 231, 114, 131, 249, 120, 178, 55, 154, 75, 231, 114, 3, 244, 110, 210,
    54, 88, 175, 38, 109, 227, 181, 102, 142, 54, 60, 107, 230, 100, 199, 57, 57, 86,
    115, 158, 43, 99, 59, 11, 122, 162, 150, 181, 164, 111, 106, 95, 207, 185, 56, 246,
    243, 158, 51, 99, 67, 19, 250, 162, 22, 54, 165, 103, 106, 99, 119, 113, 50, 18, 118,
    19, 143, 35, 99, 151, 122, 170, 82, 122, 173, 239, 42, 161, 23, 123, 174, 10, 122,
    179, 75, 234, 170, 119, 112, 56, 42, 118, 15, 11, 230, 50, 205, 165, 180, 109, 171,
    180, 135, 107, 187, 199, 107, 191, 103, 100, 187, 199, 100, 191, 167, 33, 192, 39,
    34, 194, 75, 236, 166, 175, 170, 196, 143, 107, 199, 207, 107, 201, 111, 100, 199,
    207, 100, 201, 175, 33, 202, 47, 34, 204, 247, 97, 206, 183, 226, 208, 119, 98, 208,
    247, 226, 206, 196, 69, 182, 36, 77, 86, 44, 205, 86, 66, 45, 214, 130, 45, 218, 194,
    45, 222, 2, 46, 226, 66, 46, 230, 130, 46, 234, 66, 40, 168, 194, 42, 138, 194, 46,
    238, 2, 47, 242, 2, 41, 176, 34, 43, 146, 66, 47, 246, 66, 38, 248, 162, 47, 252,
    226, 47, 110, 102, 106, 170, 230, 106, 162, 238, 234, 162, 0, 0,
];
/// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 4236435078;
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
        lists: palpate::body::Lists {
            entries: 268,
            entry_bits: 12,
            face_bits: 3,
            rectangles: &RECTANGLES,
            candidates: &CANDIDATES,
        },
    },
    size_m: 0.06,
    is_convex: true,
    crc: Some(TABLE_CRC),
}
    .checked()
    .with_effort(palpate::body::Effort {
        steps: 4,
        candidates: 4,
    });
/// The type of the surface.
#[allow(dead_code)]
pub type Surface = palpate::body::Body<'static, palpate::field::Rigid<{ BODY.kinds() }>>;
/// The body, with code for its own kinds of patches alone.
#[allow(dead_code)]
pub const SURFACE: &Surface = &BODY.of_kinds();
/// The body with another effort in each tick, as far as every tick keeps the limit that it was baked for.
#[allow(dead_code)]
pub const fn with_effort(effort: palpate::body::Effort) -> Surface {
    BODY.with_effort(effort).fitted(palpate::body::TickLimit::BENCH).of_kinds()
}
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin_m` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
