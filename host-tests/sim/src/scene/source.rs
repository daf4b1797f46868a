//! A scene as Rust source, for an image.

use super::file::SceneFile;
use super::parts::Shape;
use crate::recorded::{Movement, Turn};
use palpate::math::Vec3;
use palpate::render::{Effects, Texture, TextureShape};
use palpate::scene::{Joint, Limits, Part, Tether};
use palpate::track::Placement;
use std::fmt::Write as _;

/// The source: a module of tables for each body, and the scene of them as `Surface` and `SURFACE`, which an image takes
/// as it takes a body's. `tables` is each body's own source, with that of its modes.
pub fn source<S>(file: &SceneFile, limits: Limits, bodies: &[(&'static S, Shape)], tables: &[String]) -> String {
    let mut text = String::from("// A scene, written by palpate from a scene file: not for editing.\n");
    // Those of bodies of one model are there once.
    let first = |index: usize| tables.iter().position(|other| *other == tables[index]).unwrap_or(index);
    let (count, is_soft, rate_hz) = (tables.len(), file.is_soft(), limits.rate_hz);
    let surface = if is_soft { "palpate::servo::SoftBody<'static>" } else { "palpate::body::Body<'static>" };
    for (index, table) in tables.iter().enumerate().filter(|(index, _)| first(*index) == *index) {
        let mut body = format!("body_{index}::BODY.with_effort(palpate::body::Effort::ONE)");
        if is_soft {
            // A rigid body among them has no modes.
            let modes = match file.body[index].modes {
                Some(_) => format!("&body_{index}::MODES, &body_{index}::MOTION"),
                None => "&[], &[]".to_owned(),
            };
            body = format!("soft({body}, {modes})");
        }
        let _ = writeln!(
            text,
            "/// Tables of {:?}.\nmod body_{index} {{\n{table}\n}}\nstatic BODY_{index}: {surface} = {body};",
            file.body[index].model
        );
    }
    if is_soft {
        let _ = writeln!(
            text,
            "/// A body with its modes.\nconst fn soft(body: palpate::body::Body<'static>, \
             modes: &'static [palpate::field::Mode], motion: &[palpate::field::Modal]) -> {surface} {{\n    \
             let Ok(soft) = palpate::body::Soft::new(body, modes) else {{ panic!(\"modes\") }};\n    \
             let Ok(surface) = palpate::servo::SoftBody::new(soft, motion, {rate_hz:?}) else {{ panic!(\"motion\") }};\n    \
             surface\n}}"
        );
    }
    let Limits {
        max_stiffness_n_per_m: max_stiffness,
        max_damping_n_s_per_m: max_damping,
        max_force_n: max_force,
        release_n_per_s: let_go,
        rate_hz: rate,
        max_speed_m_per_s: max_speed,
    } = file.limits(limits);
    let _ = writeln!(
        text,
        "/// What is felt.\npub type Surface = palpate::scene::Scene<'static, {surface}, {count}>;\n\
         /// The scene.\n#[rustfmt::skip]\nconst fn scene() -> Surface {{\n    palpate::scene::Scene::new(\n    \
         palpate::scene::Limits {{ max_stiffness_n_per_m: {max_stiffness:?}, max_damping_n_s_per_m: {max_damping:?}, \
         max_force_n: {max_force:?}, release_n_per_s: {let_go:?}, rate_hz: {rate:?}, max_speed_m_per_s: {max_speed:?} }},\n    ["
    );
    let entries = file.body.iter().zip(bodies).zip(file.parts(limits.rate_hz, bodies));
    for (index, ((entry, (_, shape)), part)) in entries.enumerate() {
        let (centre, radius) = (vector(part.sphere.centre_m), part.sphere.radius_m);
        let _ = writeln!(
            text,
            "        palpate::scene::Part {{ surface: &BODY_{}, motion: {}, material: {}, \
             sphere: palpate::scene::Sphere {{ centre_m: {centre}, radius_m: {radius:?} }}, group: {} }},",
            first(index),
            motion(&entry.movement(shape), limits.rate_hz),
            material(&part),
            part.group
        );
    }
    text += "    ],\n)\n}\nstatic SCENE: Surface = scene();\n\
             /// The scene.\n#[allow(dead_code)]\npub const SURFACE: &Surface = &SCENE;\n\
             /// The scene: its bodies have the effort of the emulated boards.\n#[allow(dead_code)]\n\
             pub const fn with_effort(_: palpate::body::Effort) -> Surface {\n    scene()\n}\n";
    text
}

fn vector(vector: Vec3) -> String {
    let [x, y, z] = vector.to_array();
    format!("palpate::math::vec3({x:?}, {y:?}, {z:?})")
}

fn placement(of: &Placement) -> String {
    let [a, b, c] = of.axes.map(vector);
    let origin = vector(of.origin);
    format!(
        "palpate::track::Placement {{ axes: [{a}, {b}, {c}], origin: {origin}, ..palpate::track::Placement::IDENTITY }}"
    )
}

fn material<S>(part: &Part<'static, S>) -> String {
    let material = &part.material;
    let friction = material.friction.map_or_else(
        || "None".to_owned(),
        |friction| {
            format!(
                "Some(palpate::render::Friction {{ stiffness_n_per_m: {:?}, damping_n_s_per_m: {:?}, static_coefficient: {:?}, \
                 dynamic_coefficient: {:?} }})",
                friction.stiffness_n_per_m,
                friction.damping_n_s_per_m,
                friction.static_coefficient,
                friction.dynamic_coefficient
            )
        },
    );
    let effects = material.effects.map_or_else(|| "None".to_owned(), effects);
    format!(
        "palpate::scene::Material {{ friction: {friction}, effects: {effects}, ..palpate::scene::Material::new({:?}, {:?}) }}",
        material.stiffness_n_per_m, material.damping_n_s_per_m
    )
}

fn effects(Effects { texture, magnet, viscosity, max_force_n }: &Effects) -> String {
    let mut text = String::from("Some(const { &palpate::render::Effects { ");
    if let Some(Texture { shape, max_fraction }) = texture {
        let shape = match shape {
            TextureShape::Ridges { across, pitch_m } => {
                format!("Ridges {{ across: {}, pitch_m: {pitch_m:?} }}", vector(*across))
            }
            TextureShape::Bumps { pitch_m } => format!("Bumps {{ pitch_m: {pitch_m:?} }}"),
            TextureShape::Custom(_) => unreachable!("a file names its shapes"),
        };
        let _ = write!(
            text,
            "texture: Some(palpate::render::Texture {{ shape: palpate::render::TextureShape::{shape}, max_fraction: {max_fraction:?} }}), "
        );
    }
    // As `Debug` writes them they are source, but for their path.
    let written = [
        magnet.map(|magnet| format!("magnet: Some(palpate::render::{magnet:?})")),
        viscosity.map(|viscosity| format!("viscosity: Some(palpate::render::{viscosity:?})")),
        max_force_n.is_finite().then(|| format!("max_force_n: {max_force_n:?}")),
    ];
    for part in written.into_iter().flatten() {
        text += &format!("{part}, ");
    }
    text + "..palpate::render::Effects::NONE } })"
}

fn motion(movement: &Movement, rate: f32) -> String {
    match movement {
        Movement::Resting(start) => format!("palpate::scene::Motion::Resting({})", placement(start)),
        Movement::Prescribed { start, turn, sway } => {
            let mut text = format!("palpate::scene::Path::new({})", placement(start));
            if let Some(Turn { axis, pivot, rate: by }) = turn {
                let _ = write!(text, ".turning({}, {}, {by:?}, {rate:?})", vector(*axis), vector(*pivot));
            }
            if let Some((amplitude, by)) = sway {
                let _ = write!(text, ".swaying({}, {by:?}, {rate:?})", vector(*amplitude));
            }
            format!("palpate::scene::Motion::Prescribed({text})")
        }
        Movement::Free(body) => {
            let joint = match body.joint {
                Joint::Free => "Free".to_owned(),
                Joint::Fixed => "Fixed".to_owned(),
                Joint::Slider(axis) => format!("Slider({})", vector(axis)),
                Joint::Hinge { axis, pivot } => {
                    format!("Hinge {{ axis: {}, pivot: {} }}", vector(axis), vector(pivot))
                }
            };
            let tether = body.tether.map_or_else(
                || "None".to_owned(),
                |Tether { anchor_m: anchor, slack_m: slack, stiffness_n_per_m: stiffness, damping_n_s_per_m: damping }| {
                    format!(
                        "Some(palpate::scene::Tether {{ anchor_m: {}, slack_m: {}, stiffness_n_per_m: {stiffness:?}, damping_n_s_per_m: {damping:?} }})",
                        vector(anchor),
                        vector(slack)
                    )
                },
            );
            format!(
                "palpate::scene::Motion::Free(palpate::scene::RigidBody {{ start: {}, mass_kg: {:?}, inertia_kg_m2: {}, \
                 centre_m: {}, joint: palpate::scene::Joint::{joint}, gravity_m_per_s2: {}, damping_n_s_per_m: {:?}, \
                 angular_damping_n_m_s_per_rad: {:?}, tether: {tether}, angular_stiffness_n_m_per_rad: {:?} }})",
                placement(&body.start),
                body.mass_kg,
                vector(body.inertia_kg_m2),
                vector(body.centre_m),
                vector(body.gravity_m_per_s2),
                body.damping_n_s_per_m,
                body.angular_damping_n_m_s_per_rad,
                body.angular_stiffness_n_m_per_rad
            )
        }
    }
}
