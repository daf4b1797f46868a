//! The tracker by itself, without what the loop asks of the point; and what it makes of a probe that jumps, or is no
//! probe.

use crate::scene::{Scene, repeat};
use palpate::body::{BodyWitness, Effort};
use palpate::math::{Vec3, vec3};
use palpate::track::{Contact, Controller, FirstOrder, Gain, Probe};
use palpate_truth::measured::measured;

const PERIOD: f32 = 2.5e-4;

/// Nobody calls `meet`: in front of the body the tracker ends at the closest point all the same.
#[test]
fn the_closest_point_needs_no_contact() {
    for name in ["capped_box", "ellipsoid_body"] {
        let scene = Scene::load(name);
        let oracle = scene.oracle();
        let late: Vec<f64> = repeat(200, 7, |random| {
            let (probe, nearest) = scene.outside(&oracle, random, 0.0);
            let mut state = scene.body.start();
            // The search, and a step or two on each of a few features, the audit in between.
            for _ in 0..2_000 {
                scene.body.track(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
            }
            assert_eq!(state.contact, Contact::Behind, "{name}: touched without having been asked");
            f64::from(state.witness.surface.point.distance(probe)) - nearest[0].1.distance
        });
        let worst = late.iter().fold(0.0_f64, |worst, late| worst.max(*late)) / scene.size();
        println!("{name}: without contact the distance is too long by {worst:.1e} of the size at most");
        // The rounding of a point, and of a square root near it.
        assert!(worst < 1e-6, "{name}: {worst:e}");
    }
}

/// Whoever starts inside the box feels nothing, wherever he goes in there: over whatever edge the witness point goes,
/// the probe has not been in front. Once out he has, over a face, an edge or a corner.
#[test]
fn a_start_inside_is_not_felt_before_the_probe_has_been_out() {
    let scene = Scene::load("capped_box");
    let oracle = scene.oracle();
    // 0.4 m/s at 4 kHz.
    let stride = 1e-4;
    let walk = |state: &mut BodyWitness, from: Vec3, to: Vec3, most: Contact| {
        let ticks = (from.distance(to) / stride).ceil() as u32;
        for tick in 1..=ticks {
            let probe = from + (to - from) * (tick as f32 / ticks as f32);
            scene.body.step(&Controller::SecondOrder, state, Probe::at(probe), PERIOD);
            assert!(state.contact <= most, "{:?} at {probe}, on the way from {from} to {to}", state.contact);
        }
    };
    repeat(200, 11, |random| {
        let mut at = scene.inside(&oracle, random);
        let mut state = scene.body.start();
        for _ in 0..6 {
            let next = scene.inside(&oracle, random);
            walk(&mut state, at, next, Contact::Behind);
            at = next;
        }
        let (out, _) = scene.outside(&oracle, random, 0.0);
        walk(&mut state, at, out, Contact::InFront);
        // The last of the way to the closest point.
        for _ in 0..2_000 {
            scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(out), PERIOD);
        }
        assert!(state.contact == Contact::InFront && state.gap > 0.0, "{:?} outside at {out}", state.contact);
    });
}

/// Pressed from the dome over its rim, where it meets a side at an obtuse angle, into that side: the probe is inside
/// all the way, and is felt all the way.
#[test]
fn the_contact_holds_over_an_obtuse_edge() {
    let scene = Scene::load("capped_box");
    let oracle = scene.oracle();
    let mut state = scene.body.start();
    // In front of the dome, in through it, and down behind the side.
    let way = [vec3(0.006, 0.02, 0.045), vec3(0.006, 0.02, 0.028), vec3(0.001, 0.02, 0.022)];
    for leg in way.windows(2) {
        let ticks = (leg[0].distance(leg[1]) / 1e-5).ceil() as u32;
        for tick in 0..ticks {
            let probe = leg[0] + (leg[1] - leg[0]) * (tick as f32 / ticks as f32);
            scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
            let inside = oracle.is_inside_convex(oracle.nearest(probe.as_dvec3(), 0.0)[0].0, probe.as_dvec3());
            assert!(
                !inside || state.contact == Contact::Touching,
                "{:?} at {probe}, on {:?}",
                state.contact,
                state.feature
            );
        }
    }
    assert!(state.gap < 0.0 && state.normal.x < -0.9, "not on the side: {:?}", state.feature);
}

/// A slow tracker's witness point is left behind by a probe that is swept aside in front of it, too slowly for a jump.
/// Where that goes in, contact does not begin with the point far off: it is located anew.
#[test]
fn no_contact_begins_with_a_witness_point_left_behind() {
    let scene = Scene::load("capped_box");
    let slow = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Constant(0.1)));
    let mut state = scene.body.start();
    let above = |x: f32, z: f32| vec3(x, 0.02, z);
    for _ in 0..2_000 {
        scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(above(0.03, 0.05)), PERIOD);
    }
    assert_eq!(state.contact, Contact::InFront);
    let jump = scene.size() as f32 / 8.0;
    let (mut left_behind, mut relocated, mut begun) = (false, false, 0);
    let aside = 0.9 * jump;
    // Aside in four ticks, then down through the dome near its end, a tenth of a millimetre a tick.
    for tick in 0..350 {
        let before = state.contact;
        let probe = above((0.03 + aside * tick as f32).min(0.056), 0.05 - 1e-4 * tick as f32);
        scene.body.step(&slow, &mut state, Probe::at(probe), PERIOD);
        let distance = state.witness.surface.point.distance(probe);
        left_behind |= state.contact == Contact::InFront && distance > 3.0 * jump;
        relocated |= !state.is_located;
        if state.contact == Contact::Touching && before != Contact::Touching {
            begun += 1;
            assert!(distance < jump, "at {probe} contact begins with a point {distance} m away");
        }
    }
    assert!(left_behind, "the witness point kept up");
    assert!(relocated, "it was not located anew");
    assert_eq!(begun, 1, "the probe came from the front");
}

/// A probe that jumps is located anew, in front of the body and pressed into it, and until then touches nothing; one
/// that is swept just less far in a tick is followed.
#[test]
fn a_probe_that_jumps_is_located_anew() {
    let scene = Scene::load("capped_box");
    let oracle = scene.oracle();
    // At a greater effort the first tick ends the search.
    let body = scene.body.with_effort(Effort::ONE);
    let jump = scene.size() as f32 / 8.0;
    // Above the dome, and pushed in from there.
    for (end, contact) in [(0.05, Contact::InFront), (0.025, Contact::Touching)] {
        let mut held = body.start();
        let place = |tick: u32| vec3(0.03, 0.02, 0.05 + (end - 0.05) * tick as f32 / 2_000.0);
        for tick in 0..=2_000 {
            body.step(&Controller::SecondOrder, &mut held, Probe::at(place(tick)), PERIOD);
        }
        assert_eq!(held.contact, contact);
        for (reach, jumps) in [(0.99, false), (1.01, true)] {
            for aside in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y] {
                let mut state = held;
                let probe = place(2_000) + aside * (reach * jump);
                let step = body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
                let seen = (step.searched, state.is_located, state.contact);
                let wanted = (jumps, !jumps, if jumps { Contact::Behind } else { contact });
                assert_eq!(seen, wanted, "{aside} by {reach} of a jump from {}", place(2_000));
                for _ in 0..2_000 {
                    body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
                }
                // Inside, a probe that has jumped has not been in front.
                let wanted = if jumps && contact == Contact::Touching { Contact::Behind } else { contact };
                assert_eq!((state.is_located, state.contact), (true, wanted), "{aside} by {reach} of a jump");
                let (_, closest) = &oracle.nearest(probe.as_dvec3(), 0.0)[0];
                let late = f64::from(state.witness.surface.point.distance(probe)) - closest.distance;
                // Touched, the witness point stays on the sheet that was pressed. As above.
                assert!(state.contact == Contact::Touching || late < 1e-6 * scene.size(), "{late} m at {probe}");
            }
        }
    }
}

/// No coordinate that is not a number, nor one that is infinite, moves anything: on a face, at its side, on an edge, on
/// a vertex, inside.
#[test]
fn what_is_no_probe_moves_nothing() {
    let scene = Scene::load("capped_box");
    let places = [
        vec3(0.03, 0.02, 0.05),
        vec3(0.03, 0.02, 0.033),
        vec3(0.03, -0.02, -0.02),
        vec3(-0.02, -0.02, -0.02),
        vec3(0.08, 0.02, 0.01),
    ];
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for place in places {
        let mut state = scene.body.start();
        for tick in 0..2_000 {
            // From the front.
            let probe = place + Vec3::Z * (0.02 * (1.0 - tick as f32 / 2_000.0));
            scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
        }
        for value in bad {
            for axis in 0..3 {
                let mut probe = place;
                probe[axis] = value;
                let mut after = state;
                let step = scene.body.step(&Controller::SecondOrder, &mut after, Probe::at(probe), PERIOD);
                assert!(!step.switched, "{place} {probe}");
                assert_eq!(after, state, "{place} {probe}");
            }
        }
    }
}

/// Deeper than the least radius of curvature the closest point is not unique, and the body says so.
#[test]
fn too_deep_is_deeper_than_the_least_radius_of_curvature() {
    let scene = Scene::load("ellipsoid_body");
    let face = &scene.body.faces()[0].patch;
    let greatest = palpate::patch::Patch::shape(face).curvature.max;
    let mut state = scene.body.start_on(0, [0.5, 0.5]);
    state.gap = -0.99 / greatest;
    assert!(!scene.body.is_too_deep(&state));
    state.gap = -1.01 / greatest;
    assert!(scene.body.is_too_deep(&state));
}

/// At an effort of one the audit leaves ticks to a tracker that is on its way, but not all of them: a probe that goes
/// from one side of a ridge to the other in each tick has the nearer sheet within two passes.
#[test]
fn a_tracker_that_never_settles_does_not_keep_the_audit_from_a_nearer_sheet() {
    let sheet = |name: &str, [low, high]: [f64; 2], [z_low, z_high]: [f64; 2]| {
        let row = |x: f64, z: f64| format!("[[{x}, -10.0, {z}], [{x}, 10.0, {z}]]");
        let rows = format!("[{}, {}]", row(low, z_low), row(high, z_high));
        format!("[[patch]]\nname = \"{name}\"\ndegree = [1, 1]\npoints = {rows}\n")
    };
    let text = [
        "name = \"sheets\"\nunit = \"mm\"\n".to_owned(),
        sheet("left", [-20.0, 0.0], [-2.0, 0.0]),
        sheet("right", [0.0, 20.0], [0.0, -2.0]),
        sheet("above", [20.0, -20.0], [10.0, 10.0]),
    ];
    let scene = Scene::parsed("sheets", &text.concat());
    let body = scene.body.with_effort(Effort::ONE);
    assert!(!body.is_convex());
    let mut state = body.start();
    let mut late = 0;
    for tick in 0..400_u32 {
        let x = if tick % 2 == 0 { -2e-3 } else { 2e-3 };
        let probe = vec3(x, 0.0, (3e-3 + 2e-5 * tick as f32).min(7e-3));
        body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
        let is_above = state.witness.surface.point.z > 5e-3;
        // By more than the two roofs differ.
        late += u32::from(probe.z > 5.5e-3 && !is_above);
    }
    let pass = body.audit_ticks();
    println!("late by {late} ticks; a pass is {pass} at most");
    assert!(state.witness.surface.point.z > 5e-3 && late <= 2 * pass, "late by {late} ticks");
}

#[test]
fn the_state_of_a_body_is_small() {
    measured("RAM of the state of a tracked body", size_of::<BodyWitness>());
    assert!(size_of::<BodyWitness>() <= 256);
}
