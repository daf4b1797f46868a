//! A thin plate: pushed through, the force never turns round; slid off the rim, it lets go.

use crate::scene::Scene;
use palpate::body::{Body, BodyWitness};
use palpate::math::{Vec3, vec3};
use palpate::track::{Contact, Controller, Probe};

fn tick(body: &Body, state: &mut BodyWitness, probe: Vec3) {
    body.step(&Controller::SecondOrder, state, Probe::at(probe), 2.5e-4);
}

/// From above the middle of the plate (60 × 40 × 2 mm, its top at z = 2 mm) down to a depth, in steps of 5 µm.
fn push(body: &Body, at: [f32; 2], depth: f32) -> BodyWitness {
    let mut state = body.start();
    let mut height = 5e-3_f32;
    while height > 2e-3 - depth {
        tick(body, &mut state, vec3(at[0], at[1], height));
        height -= 5e-6;
        if state.contact == Contact::Touching {
            assert!(state.normal.z > 0.999, "at height {height} the force points to {}", state.normal);
            assert!((state.gap - (height + 5e-6 - 2e-3)).abs() < 1e-6, "at height {height} the gap is {}", state.gap);
        }
    }
    state
}

#[test]
fn pushing_through_never_turns_the_force_round() {
    let scene = Scene::load("thin_plate");
    for at in [[0.030, 0.020], [0.005, 0.005], [0.059, 0.020], [0.0005, 0.0395]] {
        // Ten times the plate's thickness.
        let state = push(&scene.body, at, 0.020);
        assert_eq!(state.contact, Contact::Touching, "at {at:?}");
    }
}

#[test]
fn sliding_off_the_rim_lets_go() {
    let scene = Scene::load("thin_plate");
    let mut state = push(&scene.body, [0.030, 0.020], 0.001);
    let mut x = 0.030_f32;
    while x < 0.062 {
        tick(&scene.body, &mut state, vec3(x, 0.020, 0.001));
        let inside = x < 0.060;
        // Within a step of the rim either is right.
        if (x - 0.060).abs() > 3e-5 {
            assert_eq!(state.contact == Contact::Touching, inside, "at x = {x}: {state:?}");
        }
        x += 1e-5;
    }
    assert!(state.gap > 0.0);
}
