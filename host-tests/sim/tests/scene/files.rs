//! Scene files: what is read, and what is refused by whose name.

use crate::common::{BOX, FOAM, LIMITS, RATE, STIFF};
use glam::DVec3;
use palpate::scene::{Motion, SceneError};
use palpate_sim::scene::{SceneFile, SceneFileError, Shape, source};

const SHIPPED: &str = include_str!("../../../scenes/turntable.toml");
const SHAPE: Shape = Shape { centre: DVec3::ZERO, low: DVec3::ZERO, high: DVec3::new(0.06, 0.04, 0.0335), motion: 0.0 };

#[test]
fn the_scene_that_ships_is_what_it_says() {
    let file = SceneFile::read(SHIPPED).unwrap();
    let bodies = [(&BOX, SHAPE); 3];
    let parts = file.parts(RATE, &bodies);
    assert!(matches!(parts[0].motion, Motion::Prescribed(_)) && matches!(parts[1].motion, Motion::Prescribed(_)));
    let Motion::Free(block) = parts[2].motion else { panic!("the block is free") };
    // A block of 60 × 40 × 33.5 mm and 200 g, about its longest side.
    assert!((block.inertia_kg_m2.x - 0.2 * (0.04 * 0.04 + 0.0335 * 0.0335) / 12.0).abs() < 1e-9);
    file.scene::<_, 3>(LIMITS, &bodies).unwrap();
    let text = source(&file, LIMITS, &bodies, &["tables".to_owned(), "tables".to_owned(), "tables".to_owned()]);
    assert_eq!(text.matches("mod body_").count(), 1, "tables of one model are there once");
    assert_eq!(text.matches("surface: &BODY_0,").count(), 3);
}

/// One of the turntable's parts is a foam.
#[test]
fn a_scene_with_a_soft_body_is_one_of_soft_bodies() {
    let file = with("model = \"capped_box\"", "model = \"capped_box\"\nmodes = \"foam.toml\"").unwrap();
    let bodies = [(&FOAM, Shape { motion: 0.004, ..SHAPE }), (&STIFF, SHAPE), (&STIFF, SHAPE)];
    let spheres = file.parts(RATE, &bodies).iter().map(|part| part.sphere.radius_m).collect::<Vec<_>>();
    assert!((spheres[0] - spheres[1] - 0.004).abs() < 1e-5, "{spheres:?}");
    file.scene::<_, 3>(LIMITS, &bodies).unwrap();
    let tables = ["tables and modes", "tables", "tables"].map(str::to_owned);
    let text = source(&file, LIMITS, &bodies, &tables);
    assert_eq!(text.matches("SoftBody<'static> = soft(body_0::BODY").count(), 1);
    assert_eq!(text.matches("SoftBody<'static> = soft(body_1::BODY").count(), 1);
    assert!(text.contains("&body_0::MODES, &body_0::MOTION);") && text.contains("&[], &[]);"));
}

/// The shipped scene with one text in the place of another.
fn with(from: &str, to: &str) -> Result<SceneFile, SceneFileError> {
    assert!(SHIPPED.contains(from), "{from}");
    SceneFile::read(&SHIPPED.replacen(from, to, 1))
}

#[test]
fn what_makes_no_sense_is_refused_by_name() {
    let said = |from, to| with(from, to).unwrap_err().to_string();
    assert!(said("stiffness = 400", "stifness = 400").contains("stifness"));
    assert_eq!(
        said("axis = [0, 0, 1], about", "axis = [0, 0, 0], about"),
        "body \"part on the table\": an axis has no direction"
    );
    assert_eq!(said("\"its neighbour\"", "\"part on the table\""), "two bodies are called \"part on the table\"");
    assert_eq!(
        said("[body.free]", "sways = { by = [0, 0, 1], often = 1 }\n[body.free]"),
        "body \"block on a spring\" is free and on a path: one of the two"
    );
    assert_eq!(
        SceneFile::read("name = \"none\"\nbody = []").unwrap_err().to_string(),
        "a scene file has 1 to 8 bodies, this one 0"
    );
}

#[test]
fn what_the_library_refuses_names_the_body() {
    let bodies = [(&BOX, SHAPE); 3];
    let refused = |from, to| with(from, to).unwrap().scene::<_, 3>(LIMITS, &bodies).unwrap_err();
    for (from, to, name, error) in [
        ("mass = 0.2", "mass = 0.0", "block on a spring", SceneError::Motion(2)),
        ("mass = 0.2", "mass = 1e-5", "block on a spring", SceneError::Light(2)),
        ("stiffness = 400", "stiffness = 4000", "part on the table", SceneError::Stiffness(0)),
        ("static = 0.5", "static = 0.3", "its neighbour", SceneError::Friction(1)),
    ] {
        assert_eq!(refused(from, to), SceneFileError::Scene { body: Some(name.to_owned()), error });
    }
}

#[test]
fn an_effect_out_of_range_names_body_field_range_and_remedy() {
    let bodies = [(&BOX, SHAPE); 3];
    // 2,000 N/m less the 400 of the stiffest other body, 5 N, 5 N·s/m less the body's own 1.5.
    for (effect, said) in [
        ("max_force = 6", "max_force is 6 N; allowed are 0 to 5 N: set a force in this range"),
        ("max_force = nan", "max_force is NaN N; allowed are 0 to 5 N"),
        (
            "texture = { shape = \"bumps\", pitch = 2, share = 1.5 }",
            "texture.share is 1.5; allowed are 0 to 1: set a share",
        ),
        (
            "texture = { shape = \"ridges\", across = [1, 1, 0], pitch = 2, share = 0.2 }",
            "texture.pitch is 2 mm; allowed are 3.929 to 1000 mm: a smaller share or max_force",
        ),
        ("magnet = { force = 6, reach = 20 }", "magnet.force is 6 N; allowed are 0 to 5 N: set a smaller force"),
        ("magnet = { force = 2, reach = 4 }", "magnet.reach is 4 mm; allowed are 5.002 to 100 mm: a smaller force"),
        ("viscosity = { damping = 4, reach = 4 }", "viscosity.damping is 4 N·s/m; allowed are 0 to 3.5 N·s/m: set"),
        ("viscosity = { damping = 1, reach = 0 }", "viscosity.reach is 0 mm; allowed are 0.5 to 100 mm: set a reach"),
    ] {
        let file = with("damping = 1.5", &format!("damping = 1.5\n{effect}")).unwrap();
        let error = file.scene::<_, 3>(LIMITS, &bodies).unwrap_err().to_string();
        assert!(error.starts_with(&format!("body \"part on the table\": {said}")), "{effect}: {error}");
    }
    let said = with("damping = 1.5", "damping = 1.5\ntexture = { shape = \"waves\" }").unwrap_err().to_string();
    assert!(said.contains("unknown variant `waves`, expected `ridges` or `bumps`"), "{said}");
}
