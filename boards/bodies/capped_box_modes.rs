// Baked modes, not for editing: palpate bake capped_box --soft host-tests/soft/foam.toml --held bottom --modes 8 --out capped_box.rs

/// Modes of deformation of the body.
#[allow(dead_code)]
#[rustfmt::skip]
pub static MODES: [palpate::field::Mode; 8] = [
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(-0.10496447, 0.053479586, -0.03697863),
            linear: [
                palpate::math::vec3(3.4988158, -6.5123577, 0.0),
                palpate::math::vec3(5.248224, 4.9023957, 1.8489313),
                palpate::math::vec3(0.0, -32.743176, -11.441489),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 108.5393, 0.0),
                palpate::math::vec3(-174.94078, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(0.0, -122.55989, 0.0),
                palpate::math::vec3(0.0, 0.0, 572.07446),
                palpate::math::vec3(0.0, 82.04783, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.3254989,
            stretch: 35.615063,
            bend: 649.5095,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(0.01672644, -0.07250276, -0.03898157),
            linear: [
                palpate::math::vec3(3.2749045, 2.4167588, 1.2993857),
                palpate::math::vec3(-3.3116348, 3.625138, 0.0),
                palpate::math::vec3(-44.63145, 0.0, -9.752804),
            ],
            quadratic: [
                palpate::math::vec3(-54.58174, 0.0, 0.0),
                palpate::math::vec3(0.0, -120.83794, 0.0),
                palpate::math::vec3(0.0, 0.0, 325.09348),
                palpate::math::vec3(82.79087, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(412.04712, 0.0, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.2325,
            stretch: 45.93132,
            bend: 894.84344,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(-0.066877976, 0.04962494, 0.1149871),
            linear: [
                palpate::math::vec3(0.0, -1.6541647, -3.8329034),
                palpate::math::vec3(3.3438988, 0.0, -5.749355),
                palpate::math::vec3(-20.26183, 36.552887, 0.0),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 191.64517),
                palpate::math::vec3(0.0, -1218.4296, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(1013.09143, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.6839032,
            stretch: 62.73983,
            bend: 1604.8197,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(-0.6120894, 0.49118972, 0.06781014),
            linear: [
                palpate::math::vec3(20.402979, -53.027855, 0.0),
                palpate::math::vec3(30.60447, -0.9223926, -3.390507),
                palpate::math::vec3(0.0, 39.92149, -17.648071),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 883.7976, 0.0),
                palpate::math::vec3(-1020.149, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(0.0, 23.059814, 0.0),
                palpate::math::vec3(0.0, 0.0, 882.40356),
                palpate::math::vec3(0.0, -1440.5856, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.2149655,
            stretch: 88.95847,
            bend: 3184.4155,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(0.25617895, 0.20960297, -0.19521782),
            linear: [
                palpate::math::vec3(-8.539298, 0.0, 9.526214),
                palpate::math::vec3(0.0, -10.480148, 11.196095),
                palpate::math::vec3(15.387746, -3.9268122, 30.219124),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 0.0, -158.77023),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(-512.92487, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, -279.90237),
                palpate::math::vec3(0.0, 196.3406, 0.0),
                palpate::math::vec3(0.0, 0.0, -64.136314),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.337331,
            stretch: 36.46138,
            bend: 786.33325,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(0.039668016, 0.35475525, -0.032270588),
            linear: [
                palpate::math::vec3(-12.199038, -11.825175, 1.0756862),
                palpate::math::vec3(14.517587, -17.737762, 0.0),
                palpate::math::vec3(-37.511883, 0.0, 38.695824),
            ],
            quadratic: [
                palpate::math::vec3(203.31729, 0.0, 0.0),
                palpate::math::vec3(0.0, 591.2588, 0.0),
                palpate::math::vec3(0.0, 0.0, -1289.8607),
                palpate::math::vec3(-362.93967, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(1505.5947, 0.0, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.8356874,
            stretch: 93.31707,
            bend: 3332.077,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(-0.08994762, 0.1792741, -0.50438476),
            linear: [
                palpate::math::vec3(0.0, -5.9758034, 16.812826),
                palpate::math::vec3(4.4973807, 0.0, 25.219238),
                palpate::math::vec3(-31.44643, -31.005556, 0.0),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, -840.6413),
                palpate::math::vec3(0.0, 1033.5186, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(1572.3215, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 0.0),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.772202,
            stretch: 77.054436,
            bend: 2072.044,
            twist: 0.0,
        },
    },
    palpate::field::Mode {
        field: palpate::field::Quadratic {
            constant: palpate::math::vec3(0.21801053, -0.016566431, -0.2933412),
            linear: [
                palpate::math::vec3(-7.267018, 0.0, 37.926373),
                palpate::math::vec3(0.0, 0.8283216, -12.5896015),
                palpate::math::vec3(-45.049324, 21.19646, 5.3490515),
            ],
            quadratic: [
                palpate::math::vec3(0.0, 0.0, -632.1062),
                palpate::math::vec3(0.0, 0.0, 0.0),
                palpate::math::vec3(1501.644, 0.0, 0.0),
                palpate::math::vec3(0.0, 0.0, 314.74002),
                palpate::math::vec3(0.0, -1059.8231, 0.0),
                palpate::math::vec3(0.0, 0.0, -32.473343),
            ],
        },
        bump: None,
        limit: 0.000973,
        bounds: palpate::field::FieldBounds {
            motion: 1.7410312,
            stretch: 73.62755,
            bend: 2239.0352,
            twist: 0.0,
        },
    },
];
/// How each of them moves.
#[allow(dead_code)]
#[rustfmt::skip]
pub const MOTION: [palpate::field::Modal; 8] = [
    palpate::field::Modal {
        mass_kg: 0.009856793,
        damping_n_s_per_m: 0.5123204,
        stiffness_n_per_m: 665.71387,
    },
    palpate::field::Modal {
        mass_kg: 0.012744897,
        damping_n_s_per_m: 0.7290204,
        stiffness_n_per_m: 1042.5167,
    },
    palpate::field::Modal {
        mass_kg: 0.006974411,
        damping_n_s_per_m: 0.44917855,
        stiffness_n_per_m: 723.22,
    },
    palpate::field::Modal {
        mass_kg: 0.004238619,
        damping_n_s_per_m: 0.43212646,
        stiffness_n_per_m: 1101.3804,
    },
    palpate::field::Modal {
        mass_kg: 0.010325355,
        damping_n_s_per_m: 1.1056892,
        stiffness_n_per_m: 2960.064,
    },
    palpate::field::Modal {
        mass_kg: 0.008835085,
        damping_n_s_per_m: 1.0496457,
        stiffness_n_per_m: 3117.5588,
    },
    palpate::field::Modal {
        mass_kg: 0.005452115,
        damping_n_s_per_m: 0.65492976,
        stiffness_n_per_m: 1966.819,
    },
    palpate::field::Modal {
        mass_kg: 0.005643939,
        damping_n_s_per_m: 0.68749064,
        stiffness_n_per_m: 2093.5881,
    },
];
