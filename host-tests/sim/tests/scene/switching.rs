//! Switched while it is felt.

use crate::common::{FOAM, LIMITS, MATERIAL, PERIOD, RATE, Random, double, part, single, soft};
use glam::DVec3;
use palpate::math::Vec3;
use palpate::scene::{Motion, Part, Path, Scene, SceneError};
use palpate::servo::Surface;
use palpate::track::{Contact, Controller, Placement, Probe};

const SWITCHES: u32 = 100_000;

/// Bodies, stiffness, placement and tip are switched at random instants while the tool rests in contact: whatever comes
/// of it, the force of a tick is that of the one before but for what is let go of.
#[test]
fn no_switch_changes_the_force_by_more_than_is_let_go_of_in_a_tick() {
    switch(part(Motion::Resting(Placement::IDENTITY), MATERIAL), SWITCHES);
    switch(soft(&FOAM, Motion::Resting(Placement::IDENTITY), MATERIAL), SWITCHES / 20);
}

fn switch<S: Surface>(part: Part<'_, S>, switches: u32) {
    let mut random = Random::new(4);
    let origin = DVec3::new(-0.03, -0.02, -0.033);
    let place = |x: f64, z: f64| Placement { origin: single(origin + DVec3::new(x, 0.0, z)), ..Placement::IDENTITY };
    let mut parts = [Part { motion: Motion::Resting(place(0.0, 0.0)), ..part }; 3];
    for (index, part) in parts.iter_mut().enumerate() {
        part.group = index as u8;
    }
    parts[1] = Part { motion: Motion::Resting(place(0.01, 0.001)), ..parts[1] };
    parts[2] = Part { motion: Motion::Resting(place(-0.01, -0.002)), ..parts[2] };
    let scene = Scene::new(LIMITS, parts);
    let mut state = scene.rest();
    let (mut done, mut touched, mut worst, mut kinds) = (0, 0, 0.0_f64, [0; 4]);
    let (mut last, mut until) = (DVec3::ZERO, 2_000);
    let mut probe = DVec3::new(0.0, 0.0, 0.02);
    let mut tick = 0_u32;
    while done < switches {
        tick += 1;
        // It comes from the front now and then, and rests some millimetres deep in between.
        let phase = f64::from(tick % 600) / 600.0;
        let depth = 0.008 - 0.012 * (1.0 - (phase * core::f64::consts::TAU).cos()) * 0.5;
        let step = depth - probe.z;
        probe.z += step;
        let mut switched = false;
        if tick > until {
            until = tick + random.below(40) as u32;
            let kind = random.below(4);
            switched = true;
            let index = random.below(3);
            match kind {
                0 => {
                    let groups = state.groups() ^ 1 << index;
                    scene.switch(&mut state, groups);
                }
                1 => scene.harden(&mut state, index, random.between(100.0, 1_000.0) as f32, 1.0).unwrap(),
                2 => scene
                    .place(&mut state, index, place(random.between(-0.01, 0.01), random.between(-0.003, 0.003)))
                    .unwrap(),
                _ => scene.set_tip_radius(&mut state, random.between(0.0, 0.004) as f32).unwrap(),
            }
            if last.length() > 0.0 {
                done += 1;
                kinds[kind] += 1;
            }
        }
        let velocity = DVec3::new(0.0, 0.0, step / f64::from(PERIOD));
        let seen = Probe { position: single(probe), velocity: single(velocity) };
        scene.follow(&Controller::SecondOrder, &mut state, seen, PERIOD);
        let force = double(state.force());
        touched += u32::from(state.part(state.felt()).unwrap().contact() == Contact::Touching);
        let change = (force - last).length();
        if switched {
            worst = worst.max(change);
        }
        last = force;
    }
    let limit = f64::from(LIMITS.release_n_per_s * PERIOD);
    println!("{done} switches {kinds:?}, touched {touched} of {tick} ticks: {worst:.4} N a tick of {limit:.4} N");
    // Rounding of forces up to 5 N.
    assert!(worst <= limit + 1e-6, "{worst}");
    assert!(touched > tick / 20);
}

/// What is switched on around a tool that is inside it is not felt until the tool has been in front.
#[test]
fn contact_begins_only_from_the_front() {
    let resting = part(Motion::Resting(Placement::IDENTITY), MATERIAL);
    let scene = Scene::new(LIMITS, [resting]);
    let mut state = scene.rest();
    let mut height = 0.03_f32;
    let mut follow = |state: &mut _, z: f32| {
        for _ in 0..2_000 {
            // No faster than 40 mm/s.
            height += (z - height).clamp(-1e-5, 1e-5);
            let at = Vec3::new(0.03, 0.02, height);
            scene.follow(&Controller::SecondOrder, state, Probe::at(at), PERIOD);
        }
    };
    scene.switch(&mut state, 0);
    follow(&mut state, 0.03);
    scene.switch(&mut state, 1);
    follow(&mut state, 0.03);
    assert_eq!(state.force(), Vec3::ZERO, "it was inside when the body came");
    follow(&mut state, 0.04);
    follow(&mut state, 0.03);
    assert!(state.force().z > 1.0, "{}", state.force());
    // Off: what was felt fades.
    scene.switch(&mut state, 0);
    follow(&mut state, 0.03);
    assert_eq!(state.force(), Vec3::ZERO);
    // A larger tip that reaches in from outside is not pushed out, until it has been out.
    scene.switch(&mut state, 1);
    follow(&mut state, 0.04);
    scene.set_tip_radius(&mut state, 0.01).unwrap();
    follow(&mut state, 0.04);
    assert_eq!(state.force(), Vec3::ZERO);
    follow(&mut state, 0.05);
    follow(&mut state, 0.04);
    assert!(state.force().z > 1.0, "{}", state.force());
}

#[test]
fn what_is_out_of_range_is_refused_and_changes_nothing() {
    let moving =
        part(Motion::Prescribed(Path::new(Placement::IDENTITY).turning(Vec3::Z, Vec3::ZERO, 1.0, RATE)), MATERIAL);
    let scene = Scene::new(LIMITS, [moving]);
    let mut state = scene.rest();
    let before = state;
    assert_eq!(scene.harden(&mut state, 0, f32::NAN, 1.0), Err(SceneError::TooStiff { body: 0, max_n_per_m: 2_000.0 }));
    assert_eq!(scene.harden(&mut state, 0, 2_001.0, 1.0), Err(SceneError::TooStiff { body: 0, max_n_per_m: 2_000.0 }));
    assert_eq!(
        scene.harden(&mut state, 0, 100.0, -1.0),
        Err(SceneError::TooDamped { body: 0, max_n_s_per_m: LIMITS.max_damping_n_s_per_m })
    );
    assert_eq!(scene.harden(&mut state, 7, 100.0, 1.0), Err(SceneError::Missing(7)));
    assert_eq!(scene.place(&mut state, 0, Placement::IDENTITY), Err(SceneError::Placement(0)));
    assert_eq!(scene.set_tip_radius(&mut state, -1.0), Err(SceneError::TipRadius));
    assert_eq!(state, before);
}
