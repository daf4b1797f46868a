//! Tools above the flat ends of a cylinder that are fans of faces about a pole, as many exporters write a disc. The
//! truth: both bodies are convex and their nearest points to a point are in closed form, so projecting in turn finds
//! the pair, and the plane between its points proves the distance.

use crate::tools::{core, direction, placement};
use glam::{DQuat, DVec2, DVec3};
use palpate::pair::{Tool, ToolStatus};
use palpate_bake::{BakedBody, Model};
use palpate_truth::generate::Random;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::fmt::Write;

const RADIUS: f64 = 0.02;
const HALF_HEIGHT: f64 = 0.015;

/// Four walls, and at each end four faces whose side v = 0 is the middle.
fn cylinder() -> String {
    let mut text = "name = \"cylinder\"\nunit = \"m\"\n".to_owned();
    for quarter in 0..4 {
        let [from, to] = [0, 1].map(|end| DVec2::from_angle(FRAC_PI_2 * f64::from(quarter + end)) * RADIUS);
        let ring = [(from, 1.0), (from + to, FRAC_1_SQRT_2), (to, 1.0)];
        let mut face = |flip: bool, ends: [(f64, f64); 2]| {
            let row = |(at, weight): (DVec2, f64)| ends.map(|(share, z)| [at.x * share, at.y * share, z, weight]);
            let points = ring.map(row);
            write!(text, "[[patch]]\ndegree = [2, 1]\nflip = {flip}\npoints = {points:?}\n").expect("a string grows");
        };
        face(false, [(1.0, -HALF_HEIGHT), (1.0, HALF_HEIGHT)]);
        face(true, [(0.0, HALF_HEIGHT), (1.0, HALF_HEIGHT)]);
        face(false, [(0.0, -HALF_HEIGHT), (1.0, -HALF_HEIGHT)]);
    }
    text
}

fn nearest_of_cylinder(point: DVec3) -> DVec3 {
    let beside = point.truncate().clamp_length_max(RADIUS);
    beside.extend(point.z.clamp(-HALF_HEIGHT, HALF_HEIGHT))
}

fn farthest_of_cylinder(along: DVec3) -> f64 {
    RADIUS * along.truncate().length() + HALF_HEIGHT * along.z.abs()
}

/// Distance of cylinder and solid, between bounds that are 1e-10 m apart at most; `None` where they are not parted.
fn distance(half: DVec3, turn: DQuat, origin: DVec3) -> Option<f64> {
    let mut of_solid = origin;
    for _ in 0..100_000 {
        let of_body = nearest_of_cylinder(of_solid);
        of_solid = origin + turn * (turn.inverse() * (of_body - origin)).clamp(-half, half);
        let between = of_solid - of_body;
        let away = between.try_normalize()?;
        let proved = away.dot(origin) - half.dot((turn.inverse() * away).abs()) - farthest_of_cylinder(away);
        if between.length() - proved <= 1e-10 {
            return Some(between.length());
        }
    }
    None
}

#[test]
fn a_tool_above_a_pole_is_outside_at_its_true_distance() {
    let model = Model::parse(&cylinder(), "cylinder.toml").expect("a model");
    let baked = BakedBody::new(&model, "cylinder").expect("a body");
    let options = baked.locator_options();
    let located = baked.located(&options, &|_, _| ()).expect("a locator").0;
    let body = located.to_body().expect("its tables fit");
    let mut random = Random::new(39);
    let (mut worst, mut asked, mut at_pole) = (0.0_f64, 0, 0);
    for round in 0..1_500 {
        let half = [DVec3::ZERO, DVec3::new(0.0, 0.0, 0.009), DVec3::new(0.01, 0.01, 0.004)][round % 3];
        // A third upright, so that flats are parallel and the nearest point of a flat may be the pole; a third nearly.
        let lean = [0.0, 1e-3, 1.5][round / 3 % 3];
        let turn = DQuat::from_axis_angle(direction(&mut random), random.between(-lean, lean));
        let sideways = direction(&mut random) * random.scale(1e-9, 0.03) * f64::from(round % 4 != 0);
        let end = if round % 2 == 0 { 1.0 } else { -1.0 };
        let origin = DVec3::new(sideways.x, sideways.y, end * random.between(0.02, 0.05));
        let Some(known) = distance(half, turn, origin).filter(|known| *known > 1e-5) else { continue };
        let tool = Tool::new(core(half), 0.0).expect("a tool");
        let (_, found) = body.locate_tool(&tool, &placement(turn, origin - model.centre));
        assert_ne!(found.status, ToolStatus::Inside, "{half} {turn} {origin}: {known} {found:?}");
        worst = worst.max((f64::from(found.distance) - known).abs() / f64::from(body.size()));
        asked += 1;
        at_pole += u32::from((found.body.as_dvec3() + model.centre).truncate().length() < 1e-6);
    }
    println!("{asked} poses, {at_pole} at a pole: {worst:.1e} of the size");
    // So much a cold pair may be off, on any body.
    assert!(worst <= 2e-6, "{worst}");
    assert!(asked > 1_300 && at_pole > 200, "{asked} {at_pole}");
}
