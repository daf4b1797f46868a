//! A tool with a shape (theory §14) against bodies on which the closest pair is known in closed form: a ball, and the
//! flat sides of a box. Bodies with their locators are those that boards have.

use glam::{DMat3, DQuat, DVec3};
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::pair::{Core, Tool, ToolStatus};
use palpate::track::Placement;
use palpate_bake::file::BakedFile;
use palpate_suites::repository;
use palpate_truth::generate::Random;

/// A body of the boards' folder, and its middle in the model's frame.
pub fn body(name: &str) -> (Body<'static>, DVec3) {
    let bytes = std::fs::read(repository("boards/bodies").join(name).with_extension("palp")).expect("it is there");
    let file = BakedFile::read(&bytes).expect("it is a body");
    (file.body.to_body().expect("its tables fit"), file.model.centre)
}

/// A pose of the tool in the frame of a body's tables.
pub fn placement(turn: DQuat, origin: DVec3) -> Placement {
    let axes = DMat3::from_quat(turn);
    Placement {
        axes: [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.as_vec3()),
        origin: origin.as_vec3(),
        ..Placement::IDENTITY
    }
}

/// Whether the tracker asks for a location.
pub fn located_again(status: ToolStatus) -> bool {
    matches!(status, ToolStatus::Behind | ToolStatus::Jumped)
}

pub fn direction(random: &mut Random) -> DVec3 {
    let mut coordinate = || random.between(-1.0, 1.0);
    loop {
        let drawn = DVec3::new(coordinate(), coordinate(), coordinate());
        if (0.01..1.0).contains(&drawn.length_squared()) {
            return drawn.normalize();
        }
    }
}

fn turn(random: &mut Random) -> DQuat {
    DQuat::from_axis_angle(direction(random), random.between(0.0, 3.0))
}

/// Half lengths of solids: a point, a segment and a box, a third of the ball's radius long.
const HALVES: [[f64; 3]; 3] = [[0.0; 3], [0.0, 0.0, 0.4], [0.4, 0.25, 0.15]];

pub fn core(half: DVec3) -> Core<'static> {
    let half = half.as_vec3();
    match half {
        Vec3 { x: 0.0, y: 0.0, z: 0.0 } => Core::Point,
        Vec3 { x: 0.0, y: 0.0, z } => Core::Segment { half: z },
        _ => Core::Box { half: half.to_array() },
    }
}

/// The radius of the ball, by its own table.
pub fn radius(ball: &Body) -> f64 {
    0.5 * f64::from(ball.size())
}

/// From the centre of a ball to a box, less the radius: a closed form.
pub fn from_ball(ball: f64, half: DVec3, turn: DQuat, origin: DVec3) -> f64 {
    let centre = turn.inverse() * -origin;
    (centre - centre.clamp(-half, half)).length() - ball
}

#[test]
fn cold_pairs_of_a_ball_are_those_of_its_centre() {
    let (ball, _) = body("sphere_body");
    let (radius, size) = (radius(&ball), f64::from(ball.size()));
    let mut random = Random::new(37);
    let mut worst = 0.0_f64;
    for round in 0..600 {
        let half = DVec3::from_array(HALVES[round % 3]) * radius;
        let (turn, gap) = (turn(&mut random), size * random.scale(1e-4, 0.5));
        // Far enough for any solid to be outside, at first.
        let origin = direction(&mut random) * (radius + half.length() + gap);
        let expected = from_ball(radius, half, turn, origin);
        let tool = Tool::new(core(half), 0.001).expect("a tool");
        let (_, found) = ball.locate_tool(&tool, &placement(turn, origin));
        assert_eq!(found.status, ToolStatus::AtRest, "round {round}");
        worst = worst.max((f64::from(found.distance) + 0.001 - expected).abs() / size);
    }
    println!("600 cold pairs of a ball: off by {worst:.1e} of the size at most");
    assert!(worst <= 2e-6, "{worst:e}");
}

/// Every tick crosses edges and corners of the ball's six faces, whose borders are skewed there.
#[test]
fn a_tool_that_goes_round_a_ball_is_followed_in_one_tick_a_row() {
    let (ball, _) = body("sphere_body");
    let (radius, size) = (radius(&ball), f64::from(ball.size()));
    let mut random = Random::new(38);
    let mut errors = Vec::new();
    for round in 0..12 {
        let half = DVec3::from_array(HALVES[round % 3]) * radius;
        let (first, axis, spin) = (turn(&mut random), direction(&mut random), direction(&mut random));
        let start = axis.any_orthonormal_vector() * (radius + half.length() + 0.05 * size);
        let mut state = None;
        for tick in 0..3_000 {
            // Round the middle at 0.3 m/s and spinning by 2 rad/s, at 4 kHz.
            let time = f64::from(tick) / 4000.0;
            let about = DQuat::from_axis_angle(axis, 0.3 / start.length() * time);
            let turn = DQuat::from_axis_angle(spin, 2.0 * time) * first;
            let origin = about * start;
            let (tool, placement) = (Tool::new(core(half), 0.0).expect("a tool"), placement(turn, origin));
            let found = match &mut state {
                None => {
                    let (start, found) = ball.locate_tool(&tool, &placement);
                    state = Some(start);
                    found
                }
                Some(state) => ball.step_tool(&tool, state, &placement, 0),
            };
            errors.push((f64::from(found.distance) - from_ball(radius, half, turn, origin)).abs() / size);
        }
    }
    errors.sort_by(f64::total_cmp);
    let (late, worst) = (errors[errors.len() * 99 / 100], errors[errors.len() - 1]);
    println!("{} ticks round a ball: 99 % within {late:.1e} of the size, all within {worst:.1e}", errors.len());
    assert!(late <= 3e-7 && worst <= 1e-5, "{late:e} {worst:e}");
}

/// A box that rocks over a flat side: the pair jumps from corner to corner, and its distance is that of the lowest
/// corner in every tick.
#[test]
fn a_box_that_rocks_on_a_flat_side_keeps_its_distance() {
    let (base, centre) = body("capped_box");
    let size = f64::from(base.size());
    let half = DVec3::new(0.012, 0.007, 0.004);
    let tool = Tool::new(core(half), 0.003).expect("a tool");
    let mut worst = 0.0_f64;
    for rocking in [DVec3::Y, DVec3::new(0.3, 1.0, 0.0).normalize(), DVec3::X] {
        let mut state = None;
        for tick in 0..800 {
            let time = f64::from(tick) / 4000.0;
            // 3 degrees to either side at 20 Hz, under the bottom at z = 0 of a box of 60 mm by 40 mm.
            let turn = DQuat::from_axis_angle(rocking, 0.05 * (time * 125.0).sin());
            let origin = DVec3::new(0.03, 0.02, -0.006);
            let corners = (0..8).map(|signs| {
                let sign = |axis: i32| if signs >> axis & 1 == 1 { 1.0 } else { -1.0 };
                origin + turn * (half * DVec3::new(sign(0), sign(1), sign(2)))
            });
            let expected = -corners.map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max) - 0.003;
            let placement = placement(turn, origin - centre);
            let found = match &mut state {
                None => {
                    let (start, found) = base.locate_tool(&tool, &placement);
                    state = Some(start);
                    found
                }
                Some(state) => base.step_tool(&tool, state, &placement, 0),
            };
            worst = worst.max((f64::from(found.distance) - expected).abs() / size);
        }
    }
    println!("a rocking box: off by {worst:.1e} of the size at most");
    assert!(worst <= 3e-7, "{worst:e}");
}

/// A box under the flat bottom of a box with a dome: its far sides hold rests.
#[test]
fn every_start_on_convex_bodies_ends_at_the_closest_pair_or_is_named_behind() {
    let (base, centre) = body("capped_box");
    let size = f64::from(base.size());
    let half = DVec3::new(0.012, 0.007, 0.004);
    let tool = Tool::new(core(half), 0.0).expect("a tool");
    let mut random = Random::new(39);
    let (mut behind, mut global) = (0, 0);
    for round in 0..600 {
        let turn = turn(&mut random);
        let reach = (0..8).map(|signs| {
            let sign = |axis: i32| if signs >> axis & 1 == 1 { 1.0 } else { -1.0 };
            (turn * (half * DVec3::new(sign(0), sign(1), sign(2)))).z
        });
        let expected = size * random.scale(1e-3, 0.5);
        let origin = DVec3::new(0.03, 0.02, -expected - reach.fold(0.0, f64::max));
        let placement = placement(turn, origin - centre);
        let mut start = || (random.between(0.0, 5.999) as u16, [(); 2].map(|()| random.between(0.0, 1.0) as f32));
        let mut state = base.start_tool(&tool, &placement, start(), start());
        let mut found = base.step_tool(&tool, &mut state, &placement, 0);
        for _ in 0..200 {
            found = base.step_tool(&tool, &mut state, &placement, 0);
        }
        if found.status == ToolStatus::Behind {
            behind += 1;
        } else {
            let error = (f64::from(found.distance) - expected).abs() / size;
            assert!(error <= 2e-6, "round {round}: {found:?}, not {expected}: off by {error:e}");
            global += 1;
        }
    }
    println!("{global} starts ended at the closest pair, {behind} behind");
    assert!(global > 100 && behind > 20, "{global} {behind}");
}

#[test]
fn two_balls_that_intersect_have_the_depth_of_their_centres() {
    let (ball, _) = body("sphere_body");
    let (radius, size) = (radius(&ball), f64::from(ball.size()));
    let tool = Tool::new(Core::Body(&ball), 0.0).expect("a tool");
    let mut random = Random::new(40);
    let (mut worst, mut located) = (0.0_f64, 0);
    for _ in 0..6 {
        let (turn, towards) = (turn(&mut random), direction(&mut random));
        let mut state = None;
        // From 1 mm apart to a third of the radius deep.
        for tick in 0..200 {
            let depth = -0.001 + 0.35 * radius * f64::from(tick) / 200.0;
            let placement = placement(turn, towards * (2.0 * radius - depth));
            let mut followed = state.as_mut().map(|state| ball.step_tool(&tool, state, &placement, 0));
            // The tracker reports contact, and has the depth from the next location on.
            let is_lost = |found: palpate::pair::Closest| match found.status {
                ToolStatus::Inside => found.distance >= 0.0,
                status => status == ToolStatus::Behind,
            };
            if followed.is_none_or(is_lost) {
                let (start, found) = ball.locate_tool(&tool, &placement);
                (state, followed) = (Some(start), Some(found));
                located += 1;
            }
            let found = followed.expect("it was located");
            assert!((found.status == ToolStatus::Inside) == (depth > 0.0) || depth.abs() < 1e-5, "{depth}: {found:?}");
            worst = worst.max((f64::from(found.distance) + depth).abs() / size);
        }
    }
    assert!(located <= 2 * 6 + 6, "{located} locations");
    println!("two balls through contact: off by {worst:.1e} of the size at most");
    assert!(worst <= 1e-6, "{worst:e}");
}
