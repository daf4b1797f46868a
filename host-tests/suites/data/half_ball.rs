// Baked table, not for editing: palpate bake half_ball.toml --out half_ball.rs
// Table format 7. SHA-256 of the model file: 8f0233ab18bff9eeb1e114f105852a17a7926877df3c21b33703ab64693ef0be
// A body of 8 faces, 12 edges and 6 vertices. CRC-32 of its numbers: a1eeaf53

// Span borders.
#[rustfmt::skip]
static BREAKS_0: [f32; 2] = [0.0, 1.0];

// Face 0: "ball0".
#[rustfmt::skip]
static FACE_0: [[f32; 4]; 9] = [
    [0.010928301, 0.010928301, 0.015454952, 0.7285534],
    [-0.018106602, -0.018106602, 0.025606602, 0.0],
    [-0.0075, -0.0075, -0.010606602, 0.5],
    [-0.018106602, 0.018106602, 0.0, 0.0],
    [0.03, -0.03, 0.0, 0.0],
    [0.012426407, -0.012426407, 0.0, 0.0],
    [-0.0075, -0.0075, 0.010606602, 0.5],
    [0.012426407, 0.012426407, 0.017573593, 0.0],
    [0.005147186, 0.005147186, -0.0072792205, 0.34314576],
];
#[rustfmt::skip]
static FACE_0_SIDE_0: [[f32; 3]; 4] = [
    [1.785789e-18, -0.03, -1.190526e-18],
    [-1.190526e-18, -0.010294372, 2.381052e-18],
    [-4.762104e-18, -0.020588744, 2.381052e-18],
    [-2.381052e-18, -0.0070649404, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_0_SIDE_1: [[f32; 3]; 4] = [
    [-0.03, 1.785789e-18, -1.190526e-18],
    [-0.010294372, -1.190526e-18, 2.381052e-18],
    [-0.020588744, -4.762104e-18, 2.381052e-18],
    [-0.0070649404, -2.381052e-18, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_0_SIDE_2: [[f32; 3]; 5] = [
    [-2.381052e-18, -2.381052e-18, -0.042426407],
    [0.0, 0.0, 0.0],
    [-2.381052e-18, -2.381052e-18, -0.058233764],
    [9.524208e-18, -9.524208e-18, 0.0],
    [5.95263e-18, 5.95263e-18, -0.01998267],
];

// Face 1: "disc0".
#[rustfmt::skip]
static FACE_1: [[f32; 4]; 6] = [
    [0.009053301, 0.009053301, 0.0, 0.8535534],
    [-0.018106602, -0.018106602, 0.0, 0.0],
    [-0.015, 0.015, 0.0, 0.0],
    [0.03, -0.03, 0.0, 0.0],
    [-0.0062132035, -0.0062132035, 0.0, 0.58578646],
    [0.012426407, 0.012426407, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_1_SIDE_2: [[f32; 3]; 5] = [
    [0.021213204, 0.021213204, 0.0],
    [-0.035147186, 0.035147186, 0.0],
    [-4.762104e-18, -4.762104e-18, 0.0],
    [-0.024121216, 0.024121216, 0.0],
    [-0.009991335, -0.009991335, 0.0],
];

// Face 2: "ball1".
#[rustfmt::skip]
static FACE_2: [[f32; 4]; 9] = [
    [-0.010928301, 0.010928301, 0.015454952, 0.7285534],
    [0.018106602, -0.018106602, 0.025606602, 0.0],
    [0.0075, -0.0075, -0.010606602, 0.5],
    [-0.018106602, -0.018106602, 0.0, 0.0],
    [0.03, 0.03, 0.0, 0.0],
    [0.012426407, 0.012426407, 0.0, 0.0],
    [0.0075, -0.0075, 0.010606602, 0.5],
    [-0.012426407, 0.012426407, 0.017573593, 0.0],
    [-0.005147186, 0.005147186, -0.0072792205, 0.34314576],
];
#[rustfmt::skip]
static FACE_2_SIDE_0: [[f32; 3]; 4] = [
    [0.03, 1.785789e-18, -1.190526e-18],
    [0.010294372, -1.190526e-18, 2.381052e-18],
    [0.020588744, -4.762104e-18, 2.381052e-18],
    [0.0070649404, -2.381052e-18, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_2_SIDE_1: [[f32; 3]; 4] = [
    [-1.785789e-18, -0.03, -1.190526e-18],
    [1.190526e-18, -0.010294372, 2.381052e-18],
    [4.762104e-18, -0.020588744, 2.381052e-18],
    [2.381052e-18, -0.0070649404, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_2_SIDE_2: [[f32; 3]; 5] = [
    [2.381052e-18, -2.381052e-18, -0.042426407],
    [0.0, 0.0, 0.0],
    [2.381052e-18, -2.381052e-18, -0.058233764],
    [9.524208e-18, 9.524208e-18, 0.0],
    [-5.95263e-18, 5.95263e-18, -0.01998267],
];

// Face 3: "disc1".
#[rustfmt::skip]
static FACE_3: [[f32; 4]; 6] = [
    [-0.009053301, 0.009053301, 0.0, 0.8535534],
    [0.018106602, -0.018106602, 0.0, 0.0],
    [-0.015, -0.015, 0.0, 0.0],
    [0.03, 0.03, 0.0, 0.0],
    [0.0062132035, -0.0062132035, 0.0, 0.58578646],
    [-0.012426407, 0.012426407, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_3_SIDE_2: [[f32; 3]; 5] = [
    [-0.021213204, 0.021213204, 0.0],
    [-0.035147186, -0.035147186, 0.0],
    [4.762104e-18, -4.762104e-18, 0.0],
    [-0.024121216, -0.024121216, 0.0],
    [0.009991335, -0.009991335, 0.0],
];

// Face 4: "ball2".
#[rustfmt::skip]
static FACE_4: [[f32; 4]; 9] = [
    [-0.010928301, -0.010928301, 0.015454952, 0.7285534],
    [0.018106602, 0.018106602, 0.025606602, 0.0],
    [0.0075, 0.0075, -0.010606602, 0.5],
    [0.018106602, -0.018106602, 0.0, 0.0],
    [-0.03, 0.03, 0.0, 0.0],
    [-0.012426407, 0.012426407, 0.0, 0.0],
    [0.0075, 0.0075, 0.010606602, 0.5],
    [-0.012426407, -0.012426407, 0.017573593, 0.0],
    [-0.005147186, -0.005147186, -0.0072792205, 0.34314576],
];
#[rustfmt::skip]
static FACE_4_SIDE_0: [[f32; 3]; 4] = [
    [-1.785789e-18, 0.03, -1.190526e-18],
    [1.190526e-18, 0.010294372, 2.381052e-18],
    [4.762104e-18, 0.020588744, 2.381052e-18],
    [2.381052e-18, 0.0070649404, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_4_SIDE_1: [[f32; 3]; 4] = [
    [0.03, -1.785789e-18, -1.190526e-18],
    [0.010294372, 1.190526e-18, 2.381052e-18],
    [0.020588744, 4.762104e-18, 2.381052e-18],
    [0.0070649404, 2.381052e-18, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_4_SIDE_2: [[f32; 3]; 5] = [
    [2.381052e-18, 2.381052e-18, -0.042426407],
    [0.0, 0.0, 0.0],
    [2.381052e-18, 2.381052e-18, -0.058233764],
    [-9.524208e-18, 9.524208e-18, 0.0],
    [-5.95263e-18, -5.95263e-18, -0.01998267],
];

// Face 5: "disc2".
#[rustfmt::skip]
static FACE_5: [[f32; 4]; 6] = [
    [-0.009053301, -0.009053301, 0.0, 0.8535534],
    [0.018106602, 0.018106602, 0.0, 0.0],
    [0.015, -0.015, 0.0, 0.0],
    [-0.03, 0.03, 0.0, 0.0],
    [0.0062132035, 0.0062132035, 0.0, 0.58578646],
    [-0.012426407, -0.012426407, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_5_SIDE_2: [[f32; 3]; 5] = [
    [-0.021213204, -0.021213204, 0.0],
    [0.035147186, -0.035147186, 0.0],
    [4.762104e-18, 4.762104e-18, 0.0],
    [0.024121216, -0.024121216, 0.0],
    [0.009991335, 0.009991335, 0.0],
];

// Face 6: "ball3".
#[rustfmt::skip]
static FACE_6: [[f32; 4]; 9] = [
    [0.010928301, -0.010928301, 0.015454952, 0.7285534],
    [-0.018106602, 0.018106602, 0.025606602, 0.0],
    [-0.0075, 0.0075, -0.010606602, 0.5],
    [0.018106602, 0.018106602, 0.0, 0.0],
    [-0.03, -0.03, 0.0, 0.0],
    [-0.012426407, -0.012426407, 0.0, 0.0],
    [-0.0075, 0.0075, 0.010606602, 0.5],
    [0.012426407, -0.012426407, 0.017573593, 0.0],
    [0.005147186, -0.005147186, -0.0072792205, 0.34314576],
];
#[rustfmt::skip]
static FACE_6_SIDE_0: [[f32; 3]; 4] = [
    [-0.03, -1.785789e-18, -1.190526e-18],
    [-0.010294372, 1.190526e-18, 2.381052e-18],
    [-0.020588744, 4.762104e-18, 2.381052e-18],
    [-0.0070649404, 2.381052e-18, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_6_SIDE_1: [[f32; 3]; 4] = [
    [1.785789e-18, 0.03, -1.190526e-18],
    [-1.190526e-18, 0.010294372, 2.381052e-18],
    [-4.762104e-18, 0.020588744, 2.381052e-18],
    [-2.381052e-18, 0.0070649404, -2.381052e-18],
];
#[rustfmt::skip]
static FACE_6_SIDE_2: [[f32; 3]; 5] = [
    [-2.381052e-18, 2.381052e-18, -0.042426407],
    [0.0, 0.0, 0.0],
    [-2.381052e-18, 2.381052e-18, -0.058233764],
    [-9.524208e-18, -9.524208e-18, 0.0],
    [5.95263e-18, -5.95263e-18, -0.01998267],
];

// Face 7: "disc3".
#[rustfmt::skip]
static FACE_7: [[f32; 4]; 6] = [
    [0.009053301, -0.009053301, 0.0, 0.8535534],
    [-0.018106602, 0.018106602, 0.0, 0.0],
    [0.015, 0.015, 0.0, 0.0],
    [-0.03, -0.03, 0.0, 0.0],
    [-0.0062132035, 0.0062132035, 0.0, 0.58578646],
    [0.012426407, -0.012426407, 0.0, 0.0],
];
#[rustfmt::skip]
static FACE_7_SIDE_2: [[f32; 3]; 5] = [
    [0.021213204, -0.021213204, 0.0],
    [0.035147186, 0.035147186, 0.0],
    [-4.762104e-18, 4.762104e-18, 0.0],
    [0.024121216, 0.024121216, 0.0],
    [-0.009991335, 0.009991335, 0.0],
];

// Edge 0.
#[rustfmt::skip]
static EDGE_0: [[f32; 4]; 3] = [
    [0.018106602, 0.0, 0.018106602, 0.8535534],
    [-0.03, 0.0, 0.03, 0.0],
    [-0.012426407, 0.0, -0.012426407, 0.58578646],
];

// Edge 1.
#[rustfmt::skip]
static EDGE_1: [[f32; 4]; 3] = [
    [0.0, 0.018106602, 0.018106602, 0.8535534],
    [0.0, -0.03, 0.03, 0.0],
    [0.0, -0.012426407, -0.012426407, 0.58578646],
];

// Edge 2.
#[rustfmt::skip]
static EDGE_2: [[f32; 4]; 3] = [
    [0.018106602, 0.018106602, 0.0, 0.8535534],
    [-0.03, 0.03, 0.0, 0.0],
    [-0.012426407, -0.012426407, 0.0, 0.58578646],
];

// Edge 3.
#[rustfmt::skip]
static EDGE_3: [[f32; 3]; 2] = [[0.015, 0.0, 0.0], [-0.03, 0.0, 0.0]];

// Edge 4.
#[rustfmt::skip]
static EDGE_4: [[f32; 3]; 2] = [[0.0, 0.015, 0.0], [0.0, -0.03, 0.0]];

// Edge 5.
#[rustfmt::skip]
static EDGE_5: [[f32; 4]; 3] = [
    [-0.018106602, 0.0, 0.018106602, 0.8535534],
    [0.03, 0.0, 0.03, 0.0],
    [0.012426407, 0.0, -0.012426407, 0.58578646],
];

// Edge 6.
#[rustfmt::skip]
static EDGE_6: [[f32; 4]; 3] = [
    [-0.018106602, 0.018106602, 0.0, 0.8535534],
    [-0.03, -0.03, 0.0, 0.0],
    [0.012426407, -0.012426407, 0.0, 0.58578646],
];

// Edge 7.
#[rustfmt::skip]
static EDGE_7: [[f32; 3]; 2] = [[-0.015, 0.0, 0.0], [0.03, 0.0, 0.0]];

// Edge 8.
#[rustfmt::skip]
static EDGE_8: [[f32; 4]; 3] = [
    [0.0, -0.018106602, 0.018106602, 0.8535534],
    [0.0, 0.03, 0.03, 0.0],
    [0.0, 0.012426407, -0.012426407, 0.58578646],
];

// Edge 9.
#[rustfmt::skip]
static EDGE_9: [[f32; 4]; 3] = [
    [-0.018106602, -0.018106602, 0.0, 0.8535534],
    [0.03, -0.03, 0.0, 0.0],
    [0.012426407, 0.012426407, 0.0, 0.58578646],
];

// Edge 10.
#[rustfmt::skip]
static EDGE_10: [[f32; 3]; 2] = [[0.0, -0.015, 0.0], [0.0, 0.03, 0.0]];

// Edge 11.
#[rustfmt::skip]
static EDGE_11: [[f32; 4]; 3] = [
    [0.018106602, -0.018106602, 0.0, 0.8535534],
    [0.03, 0.03, 0.0, 0.0],
    [-0.012426407, 0.012426407, 0.0, 0.58578646],
];

#[rustfmt::skip]
static FACES: [palpate::body::Face; 8] = [
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 2],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_0),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.084102675,
                    uv: 0.07658906,
                    vv: 0.08498841,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947182,
                    uuv: 0.12639898,
                    uvv: 0.131351,
                    vvv: 0.21142238,
                    jump_uu: 4.9941974e-8,
                    jump_vv: 5.0407024e-8,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025175787,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 0,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_0,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 1,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_1,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 2,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_0_SIDE_2,
                    ),
                    second_derivative: 0.17641556,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 1,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_1),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.08410268,
                    uv: 0.050177176,
                    vv: 4.1335137e-11,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947184,
                    uuv: 0.083342575,
                    uvv: 4.6001225e-9,
                    vvv: 4.6001225e-9,
                    jump_uu: 4.9941978e-8,
                    jump_vv: 1.0967547e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025146906,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Inward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 3,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -47.140453, -0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 4,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-47.140453, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 2,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_1_SIDE_2,
                    ),
                    second_derivative: 0.110769495,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 3,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 2],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_2),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.084102675,
                    uv: 0.07658906,
                    vv: 0.08498841,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947182,
                    uuv: 0.12639898,
                    uvv: 0.131351,
                    vvv: 0.21142238,
                    jump_uu: 4.9941974e-8,
                    jump_vv: 5.0407024e-8,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025175787,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 1,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_2_SIDE_0,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 5,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_2_SIDE_1,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 6,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_2_SIDE_2,
                    ),
                    second_derivative: 0.17641556,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 1,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_3),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.08410268,
                    uv: 0.050177176,
                    vv: 4.1335137e-11,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947184,
                    uuv: 0.083342575,
                    uvv: 4.6001225e-9,
                    vvv: 4.6001225e-9,
                    jump_uu: 4.9941978e-8,
                    jump_vv: 1.0967547e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025146906,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Inward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 4,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(47.140453, 0.0, -0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 7,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, -47.140453, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 6,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_3_SIDE_2,
                    ),
                    second_derivative: 0.110769495,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 3,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 2],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_4),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.084102675,
                    uv: 0.07658906,
                    vv: 0.08498841,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947182,
                    uuv: 0.12639898,
                    uvv: 0.131351,
                    vvv: 0.21142238,
                    jump_uu: 4.9941974e-8,
                    jump_vv: 5.0407024e-8,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025175787,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 5,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_4_SIDE_0,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 8,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_4_SIDE_1,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 9,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_4_SIDE_2,
                    ),
                    second_derivative: 0.17641556,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 1,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_5),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.08410268,
                    uv: 0.050177176,
                    vv: 4.1335137e-11,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947184,
                    uuv: 0.083342575,
                    uvv: 4.6001225e-9,
                    vvv: 4.6001225e-9,
                    jump_uu: 4.9941978e-8,
                    jump_vv: 1.0967547e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025146906,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Inward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 7,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-0.0, 47.140453, -0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 10,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(47.140453, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 9,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_5_SIDE_2,
                    ),
                    second_derivative: 0.110769495,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 3,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 2],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_6),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.084102675,
                    uv: 0.07658906,
                    vv: 0.08498841,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947182,
                    uuv: 0.12639898,
                    uvv: 0.131351,
                    vvv: 0.21142238,
                    jump_uu: 4.9941974e-8,
                    jump_vv: 5.0407024e-8,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025175787,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Outward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 8,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_6_SIDE_0,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 0,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 3,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_6_SIDE_1,
                    ),
                    second_derivative: 0.062372316,
                }),
            },
            palpate::body::Side::Edge {
                edge: 11,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_6_SIDE_2,
                    ),
                    second_derivative: 0.17641556,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 1,
            },
        ],
    },
    palpate::body::Face {
        patch: palpate::patch::SplineTable {
            degree: [2, 1],
            breaks_u: &BREAKS_0,
            breaks_v: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&FACE_7),
            shape: palpate::patch::ShapeBounds {
                second_derivatives: palpate::patch::SecondDerivativeBounds {
                    uu: 0.08410268,
                    uv: 0.050177176,
                    vv: 4.1335137e-11,
                },
                third_derivatives: palpate::patch::ThirdDerivativeBounds {
                    uuu: 0.20947184,
                    uuv: 0.083342575,
                    uvv: 4.6001225e-9,
                    vvv: 4.6001225e-9,
                    jump_uu: 4.9941978e-8,
                    jump_vv: 1.0967547e-15,
                },
                curvature: palpate::patch::Curvature {
                    min: f32::NEG_INFINITY,
                    max: f32::INFINITY,
                },
                min_stretch: 0.0,
                max_stretch: 0.0025146906,
                max_bend: f32::INFINITY,
            },
            orientation: palpate::patch::Orientation::Inward,
            size_m: 0.03,
            crc: None,
        }
            .checked_in_body(),
        sides: [
            palpate::body::Side::Edge {
                edge: 10,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(-47.140453, 0.0, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 3,
                reversed: false,
                separator: palpate::body::Separator::Plane {
                    across: palpate::math::vec3(0.0, 47.140453, 0.0),
                    offset: 0.0,
                },
            },
            palpate::body::Side::Edge {
                edge: 11,
                reversed: false,
                separator: palpate::body::Separator::Ruled(palpate::body::SplineCurve {
                    degree: 4,
                    breaks: &BREAKS_0,
                    coefficients: palpate::patch::Coefficients::Polynomial(
                        &FACE_7_SIDE_2,
                    ),
                    second_derivative: 0.110769495,
                }),
            },
            palpate::body::Side::Pole {
                vertex: 3,
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
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_0),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 0,
            },
            palpate::body::EdgeFace {
                face: 6,
                side: 1,
            },
        ],
        ends: [0, 1],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_1),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 2,
                side: 0,
            },
        ],
        ends: [2, 1],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_2),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 0,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 1,
                side: 2,
            },
        ],
        ends: [0, 2],
        kind: palpate::body::EdgeKind::Convex,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 1,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Polynomial(&EDGE_3),
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
                face: 7,
                side: 1,
            },
        ],
        ends: [0, 3],
        kind: palpate::body::EdgeKind::Smooth,
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
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 3,
                side: 0,
            },
        ],
        ends: [2, 3],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_5),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 2,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 4,
                side: 0,
            },
        ],
        ends: [4, 1],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_6),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 2,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 3,
                side: 2,
            },
        ],
        ends: [2, 4],
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
                face: 3,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 5,
                side: 0,
            },
        ],
        ends: [4, 3],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_8),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 4,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 6,
                side: 0,
            },
        ],
        ends: [5, 1],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_9),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
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
        ends: [4, 5],
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
                face: 5,
                side: 1,
            },
            palpate::body::EdgeFace {
                face: 7,
                side: 0,
            },
        ],
        ends: [5, 3],
        kind: palpate::body::EdgeKind::Smooth,
    },
    palpate::body::Edge {
        curve: palpate::body::SplineCurve {
            degree: 2,
            breaks: &BREAKS_0,
            coefficients: palpate::patch::Coefficients::Rational(&EDGE_11),
            second_derivative: 0.084102675,
        },
        third_derivative: 0.20947182,
        jump: 4.9941974e-8,
        faces: [
            palpate::body::EdgeFace {
                face: 6,
                side: 2,
            },
            palpate::body::EdgeFace {
                face: 7,
                side: 2,
            },
        ],
        ends: [5, 0],
        kind: palpate::body::EdgeKind::Convex,
    },
];
#[rustfmt::skip]
static VERTICES: [palpate::body::Vertex; 6] = [
    palpate::body::Vertex {
        point: palpate::math::vec3(0.03, 0.0, 0.0),
        outward: palpate::math::vec3(0.70710677, 0.0, -0.70710677),
        first_spoke: 0,
        spokes: 4,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.0, 0.03),
        outward: palpate::math::vec3(0.0, 0.0, 1.0),
        first_spoke: 4,
        spokes: 4,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.03, 0.0),
        outward: palpate::math::vec3(0.0, 0.70710677, -0.70710677),
        first_spoke: 8,
        spokes: 4,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, 0.0, 0.0),
        outward: palpate::math::vec3(0.0, 0.0, -1.0),
        first_spoke: 12,
        spokes: 4,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(-0.03, 0.0, 0.0),
        outward: palpate::math::vec3(-0.70710677, 0.0, -0.70710677),
        first_spoke: 16,
        spokes: 4,
        is_open: false,
    },
    palpate::body::Vertex {
        point: palpate::math::vec3(0.0, -0.03, 0.0),
        outward: palpate::math::vec3(0.0, -0.70710677, -0.70710677),
        first_spoke: 20,
        spokes: 4,
        is_open: false,
    },
];
#[rustfmt::skip]
static SPOKES: [palpate::body::Spoke; 24] = [
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 0,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 1.0, 0.0),
        edge: 2,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, 0.0, 0.0),
        edge: 3,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -1.0, -0.0),
        edge: 11,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, -0.0, -0.0),
        edge: 0,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, 1.0, -0.0),
        edge: 1,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, -0.0, -0.0),
        edge: 5,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -1.0, -0.0),
        edge: 8,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 1,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, -0.0, -0.0),
        edge: 2,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, -1.0, 0.0),
        edge: 4,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, 0.0, 0.0),
        edge: 6,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, -0.0, -0.0),
        edge: 3,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, 1.0, -0.0),
        edge: 4,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, -0.0, -0.0),
        edge: 7,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, -1.0, -0.0),
        edge: 10,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 5,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-0.0, 1.0, -0.0),
        edge: 6,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, 0.0, 0.0),
        edge: 7,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, -1.0, 0.0),
        edge: 9,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 0.0, 1.0),
        edge: 8,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(-1.0, -0.0, -0.0),
        edge: 9,
        at_upper_end: true,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(0.0, 1.0, 0.0),
        edge: 10,
        at_upper_end: false,
    },
    palpate::body::Spoke {
        direction: palpate::math::vec3(1.0, 0.0, 0.0),
        edge: 11,
        at_upper_end: false,
    },
];

#[rustfmt::skip]
static NODES: [[u16; 8]; 1] = [[32768, 32768, 32768, 32768, 32768, 32768, 32768, 32768]];
#[rustfmt::skip]
static ENTRIES: [u32; 8] = [
    2148500448, 2149549024, 2150597600, 2151646176, 2152694752, 2153743328, 2154791904,
    8356832,
];
/// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
#[allow(dead_code)]
pub const TABLE_CRC: u32 = 2716774227;
/// The body.
#[allow(dead_code, long_running_const_eval)]
#[rustfmt::skip]
pub static BODY: palpate::body::Body = palpate::body::BodyTables {
    faces: &FACES,
    edges: &EDGES,
    vertices: &VERTICES,
    spokes: &SPOKES,
    locator: palpate::body::Locator {
        corner: palpate::math::vec3(-0.06, -0.06, -0.045),
        side: 0.12,
        nodes: &NODES,
        entries: &ENTRIES,
    },
    size_m: 0.06,
    is_convex: false,
    crc: Some(TABLE_CRC),
}
    .checked();
/// The type of the surface.
#[allow(dead_code)]
pub type Surface = palpate::body::Body<'static>;
/// The body.
#[allow(dead_code)]
pub const SURFACE: &Surface = &BODY;
/// Where the origin of these tables lies in the model, metres: a place of the model less this is one of the
/// tables. With the model's own origin at `o` in the device's frame, `body_origin` is `o + CENTRE`.
#[allow(dead_code)]
pub const CENTRE: palpate::math::Vec3 = palpate::math::vec3(0.0, 0.0, 0.0);
