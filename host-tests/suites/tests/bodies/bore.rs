//! A round bore: near its axis all of its wall is as near, so the nearest point jumps and the audit's lists are longest.

use crate::scene::Scene;
use glam::DVec3;
use palpate::body::Effort;
use palpate::track::{Contact, Controller, Probe};
use palpate_truth::generate::Random;
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write as _;

/// A tube about z: inner and outer radius, half its height, mm.
const INNER: f64 = 6.0;
const OUTER: f64 = 15.0;
const HALF: f64 = 10.0;
const RATE: f64 = 4_000.0;

fn tube() -> String {
    let profile = [[INNER, HALF], [INNER, -HALF], [OUTER, -HALF], [OUTER, HALF]];
    let mut text = "name = \"tube\"\nunit = \"mm\"\n".to_owned();
    for (index, [from, to]) in (0..4).map(|side| (side, [profile[side], profile[(side + 1) % 4]])) {
        for quarter in 0..4 {
            let turned = |[x, y]: [f64; 2]| match quarter {
                0 => [x, y],
                1 => [-y, x],
                2 => [-x, -y],
                _ => [y, -x],
            };
            let row = |at: [f64; 2], weight: f64| {
                let [a, b] = [from, to].map(|[radius, z]| {
                    let [x, y] = turned(at.map(|part| part * radius));
                    format!("[{x:?}, {y:?}, {z:?}, {weight:?}]")
                });
                format!("[{a}, {b}]")
            };
            let rows = [row([1.0, 0.0], 1.0), row([1.0, 1.0], FRAC_1_SQRT_2), row([0.0, 1.0], 1.0)].join(", ");
            let _ = writeln!(text, "[[patch]]\nname = \"{index} {quarter}\"\ndegree = [2, 1]\npoints = [{rows}]");
        }
    }
    text
}

/// In closed form, metres.
fn distance(probe: DVec3) -> f64 {
    let (radius, z) = (1e3 * probe.truncate().length(), 1e3 * probe.z);
    let beyond = |x: f64, low: f64, high: f64| (low - x).max(x - high);
    let (across, along) = (beyond(radius, INNER, OUTER), beyond(z, -HALF, HALF));
    let outside = across.max(0.0).hypot(along.max(0.0));
    1e-3 * if outside > 0.0 { outside } else { -across.max(along) }
}

/// Near the axis, above the tube and in it.
fn near_the_axis(random: &mut Random) -> DVec3 {
    let off = 1e-3 * random.scale(1e-4, 2.0);
    let (angle, z) = (random.between(0.0, std::f64::consts::TAU), 1e-3 * random.between(-14.0, 14.0));
    DVec3::new(off * angle.cos(), off * angle.sin(), z)
}

/// Straight through the bore and across its axis, against the distance in closed form.
#[test]
fn a_ride_through_a_bore_is_late_by_less_than_is_proved() {
    let scene = Scene::parsed("tube", &tube());
    for effort in [Effort::BENCH, Effort { steps: 2, candidates: 2 }] {
        let body = scene.body.with_effort(effort);
        let mut random = Random::new(11);
        let (mut most, mut ticks) = (0, 0);
        for _ in 0..300 {
            let start = near_the_axis(&mut random);
            let step = random.direction() * (0.3 / RATE);
            let (mut state, mut late, mut probe) = (body.start(), 0, start);
            for tick in 0..1_000 {
                body.step(&Controller::SecondOrder, &mut state, Probe::at(probe.as_vec3()), 1.0 / RATE as f32);
                if tick < 500 {
                    continue;
                }
                if state.contact != Contact::InFront {
                    break;
                }
                let nearest = distance(probe.as_vec3().as_dvec3());
                let found = f64::from(state.witness.surface.point.distance(probe.as_vec3()));
                // Of what the audit lets pass in squares, twice over, and of rounding.
                let is_late = found > nearest * 1.001 + 1e-5 * scene.size();
                late = if is_late { late + 1 } else { 0 };
                (most, ticks) = (most.max(late), ticks + 1);
                probe += step;
            }
        }
        let Effort { steps, candidates } = effort;
        let proved = 2 * body.audit_ticks();
        println!("effort {steps},{candidates}: late by {most} ticks at most of {ticks}, {proved} proved");
        assert!(ticks > 20_000 && most <= proved, "{most} of {proved}, {ticks} ticks");
    }
}
