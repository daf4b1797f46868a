//! What is taken down and filled in again is the same in every bit, and numbers that are no device's are refused.

use palpate::device::SupplyRange;
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::presets::{
    NOVINT_FALCON, NOVINT_FALCON_PROTECTION, PHANTOM_PREMIUM, PHANTOM_PREMIUM_PROTECTION, POLHEM_V2,
    POLHEM_V2_PROTECTION, WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION,
};
use palpate::math::vec3;
use palpate::render::{Effects, Friction, Magnet, Texture, TextureShape, Viscosity};
use palpate::scene::{Joint, Limits, RigidBody, Sphere, Tether};
use palpate::track::Placement;
use palpate_sim::recorded::{Entry, Movement, Recorded, SceneNumbers, Turn};

fn shipped() -> Vec<Recorded> {
    let watched = palpate::device::Protection { supply: Some(SupplyRange::TWENTY_FOUR), ..NOVINT_FALCON_PROTECTION };
    vec![
        Recorded::new(&WOODEN_HAPTICS_2016, Some(WOODEN_HAPTICS_2016_PROTECTION)),
        Recorded::new(&PHANTOM_PREMIUM, Some(PHANTOM_PREMIUM_PROTECTION)),
        Recorded::new(&POLHEM_V2, Some(POLHEM_V2_PROTECTION)),
        Recorded::new(&NOVINT_FALCON, Some(NOVINT_FALCON_PROTECTION)),
        Recorded::new(&NOVINT_FALCON, Some(watched)),
        Recorded::new(&POLHEM_V2, None),
    ]
}

/// `Debug` of a float is the shortest that reads back as the same: two that print alike are alike in every bit.
fn text(of: &impl std::fmt::Debug) -> String {
    format!("{of:?}")
}

#[test]
fn devices_come_back_in_every_bit() {
    for mut recorded in shipped() {
        assert_eq!(text(&recorded), text(&Recorded::of(&recorded.numbers()).unwrap()));
        recorded.device.feeds[1] = Feed::Voltage(VoltageFeed::three_phase(24.0, 0.3, 100.0, 4.0));
        assert_eq!(text(&recorded), text(&Recorded::of(&recorded.numbers()).unwrap()));
    }
}

#[test]
fn numbers_of_no_device_are_refused() {
    for recorded in shipped() {
        let numbers = recorded.numbers();
        for count in 0..numbers.len() {
            assert!(Recorded::of(&numbers[..count]).is_none(), "{count} of {} numbers", numbers.len());
        }
        assert!(Recorded::of(&[&numbers[..], &[0.0]].concat()).is_none(), "one too many");
    }
}

#[test]
fn scenes_come_back_in_every_bit() {
    let start = Placement {
        axes: [vec3(0.0, 1.0, 0.0), vec3(-1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0)],
        origin: vec3(0.1, 0.2, 0.3),
        velocity: vec3(0.4, 0.5, 0.6),
        angular_velocity: vec3(0.7, 0.8, 0.9),
    };
    let turn = Turn { axis: vec3(0.6, 0.0, 0.8), pivot: vec3(0.01, 0.02, 0.03), rate: 0.35 };
    let free = |joint| {
        Movement::Free(RigidBody {
            joint,
            centre_m: vec3(0.001, 0.002, 0.003),
            gravity_m_per_s2: vec3(0.0, 0.0, -9.81),
            damping_n_s_per_m: 0.5,
            angular_damping_n_m_s_per_rad: 2e-3,
            angular_stiffness_n_m_per_rad: 1.5,
            tether: Some(Tether {
                anchor_m: vec3(1.0, 2.0, 3.0),
                slack_m: vec3(4.0, 5.0, 6.0),
                stiffness_n_per_m: 7.0,
                damping_n_s_per_m: 8.0,
            }),
            ..RigidBody::new(start, 0.2, vec3(1e-4, 2e-4, 3e-4))
        })
    };
    let movements = [
        Movement::Resting(start),
        Movement::Prescribed { start, turn: Some(turn), sway: None },
        Movement::Prescribed { start, turn: None, sway: Some((vec3(0.01, 0.0, 0.02), 5.5)) },
        Movement::Prescribed { start, turn: Some(turn), sway: Some((vec3(0.01, 0.0, 0.02), 5.5)) },
        free(Joint::Free),
        free(Joint::Fixed),
        free(Joint::Slider(vec3(0.0, 0.6, 0.8))),
        free(Joint::Hinge { axis: vec3(0.0, 0.6, 0.8), pivot: vec3(0.1, 0.2, 0.3) }),
    ];
    let friction = Friction {
        stiffness_n_per_m: 600.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.5,
        dynamic_coefficient: 0.4,
    };
    let ridges = TextureShape::Ridges { across: vec3(0.6, 0.8, 0.0), pitch_m: 0.002 };
    let effects = [
        Effects { max_force_n: 1.5, ..Effects::NONE },
        Effects { texture: Some(Texture { shape: ridges, max_fraction: 0.1 }), ..Effects::NONE },
        Effects {
            texture: Some(Texture { shape: TextureShape::Bumps { pitch_m: 0.003 }, max_fraction: 0.2 }),
            magnet: Some(Magnet { force_n: 0.5, reach_m: 0.004 }),
            viscosity: Some(Viscosity { damping_n_s_per_m: 1.5, reach_m: 0.005 }),
            ..Effects::NONE
        },
    ];
    let entries = (0..).zip(movements).map(|(body, movement)| Entry {
        body,
        movement,
        stiffness: 400.0 + body as f32,
        damping: 1.5,
        friction: (body % 2 == 0).then_some(friction),
        effects: effects.get(body as usize).copied(),
        sphere: Sphere { centre_m: vec3(0.1, 0.2, 0.3), radius_m: 0.05 },
        group: body as u8,
    });
    let limits = Limits {
        max_stiffness_n_per_m: 1e3,
        max_damping_n_s_per_m: 5.0,
        max_force_n: 4.0,
        release_n_per_s: 80.0,
        rate_hz: 4e3,
        max_speed_m_per_s: 2.0,
    };
    let scene = SceneNumbers { limits, entries: entries.collect() };
    let numbers = scene.numbers();
    assert_eq!(text(&scene), text(&SceneNumbers::of(&numbers).unwrap()));
    assert!((0..numbers.len()).all(|count| SceneNumbers::of(&numbers[..count]).is_none()), "cut short");
}
