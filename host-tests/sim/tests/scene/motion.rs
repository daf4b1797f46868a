//! A body that moves under a probe, against a probe that moves over the body.

use crate::common::{BOX, LIMITS, MATERIAL, MIDDLE, PERIOD, RATE, Random, Ride, double, part, single};
use glam::DVec3;
use palpate::body::BodyWitness;
use palpate::math::{Vec3, vec3};
use palpate::patch::Patch as _;
use palpate::scene::{Motion, Path, Scene};
use palpate::servo::Surface;
use palpate::track::{
    Contact, Controller, FeedForward, FirstOrder, Gain, Integrator, PerformanceLimits, Placement, Probe,
};

/// The tracker alone, in the body's own frame.
struct Alone {
    state: BodyWitness,
}

impl Alone {
    fn follow(&mut self, ride: &Ride, probe: DVec3, controller: &Controller) {
        let relative = -(ride.velocity + ride.angular_velocity.cross(probe - ride.origin));
        let seen = Probe { position: single(ride.to_body(probe)), velocity: single(ride.axes.transpose() * relative) };
        Surface::follow(&BOX, controller, &mut self.state, seen, PERIOD);
    }
}

/// Metres. Coordinates of up to 0.1 m are rounded by 4e-9 m, some ten of them on either way.
const ROUNDED: f64 = 1e-7;

/// Random motions up to 10 rad/s and 1 m/s: distance and contact are those of the probe that moves, which is given in
/// double precision and never sees a placement.
#[test]
fn a_body_moved_under_a_probe_is_felt_as_a_probe_moved_over_the_body() {
    let mut random = Random::new(19);
    let (mut worst, mut touched, mut ticks, mut off, mut risen) = (0.0_f64, 0, 0, 0, f64::NEG_INFINITY);
    for _ in 0..200 {
        let start = random.vector(0.02) - MIDDLE;
        let mut ride = Ride::new(&mut random, start, 10.0, 1.0);
        // The origin such that the box's middle is near the probe.
        ride.origin = random.direction() * 0.04 - ride.axes * MIDDLE;
        let part = part(Motion::Resting(ride.placement()), MATERIAL);
        let scene = Scene::new(LIMITS, [part]);
        let mut state = scene.rest();
        let mut alone = Alone { state: BOX.start() };
        let mut last: Option<(f64, DVec3)> = None;
        for tick in 0..2_000 {
            if tick >= 200 {
                ride.advance();
            }
            scene.lead(&mut state, 0, ride.placement()).unwrap();
            let probe = DVec3::ZERO;
            scene.follow(&Controller::SecondOrder, &mut state, Probe::at(Vec3::ZERO), PERIOD);
            alone.follow(&ride, probe, &Controller::SecondOrder);
            if tick < 200 {
                continue;
            }
            ticks += 1;
            // V does not rise by more than the probe moved past the body.
            let part = state.part(0).unwrap();
            let seen = ride.to_body(probe);
            let distance = (double(part.witness().witness.surface.point) - seen).length();
            if let Some((before, from)) = last {
                risen = risen.max(distance - before - (seen - from).length());
            }
            last = Some((distance, seen));
            touched += usize::from(alone.state.contact == Contact::Touching);
            let found = state.part(0).unwrap();
            let difference = f64::from((found.gap() - alone.state.gap).abs());
            if found.contact() != alone.state.contact || difference >= ROUNDED {
                off += 1;
                continue;
            }
            worst = worst.max(difference);
        }
    }
    println!("{ticks} ticks, {touched} touched, {off} a tick late, else gaps apart by at most {worst:.1e} m");
    println!("the distance rose by at most {risen:.1e} m more than the motion explains");
    assert!(risen < 1e-7, "{risen}");
    assert!(touched > ticks / 20);
    // The tick at which the gap's sign changes, or a face is entered over an edge, may be another by rounding.
    assert!(off < ticks / 10_000, "{off} of {ticks}");
}

/// `‖P − P*‖` in the body's frame, with `P*` from where the tracker comes to rest.
fn lag(witness: &BodyWitness, probe: Vec3) -> f64 {
    let mut settled = *witness;
    for _ in 0..30 {
        BOX.step(&Controller::SecondOrder, &mut settled, Probe::at(probe), PERIOD);
    }
    (double(witness.witness.surface.point) - double(settled.witness.surface.point)).length()
}

/// The greatest lag is within the bound of theory §3 at the relative speed.
#[test]
fn the_lag_is_bounded_by_the_speed_of_body_and_probe_together() {
    let start = Placement { origin: vec3(-0.03, -0.02, 0.0), ..Placement::IDENTITY };
    let path = Path::new(start).turning(Vec3::Z, vec3(0.004, 0.003, 0.0), 3.0, RATE);
    let probe = vec3(0.005, -0.004, 0.036);
    let gain = 100.0;
    let [most, speed, gap] =
        greatest_lag(&Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Constant(gain))), path, probe);
    let shape = BOX.faces()[0].patch.shape();
    let limits = PerformanceLimits::new(&shape, Integrator::Euler, RATE, gap as f32);
    let bound = f64::from(limits.lag_bound(gain, speed as f32));
    let expected = f64::from(limits.lag(gain, speed as f32));
    println!("lag at most {most:.2e} m at {speed:.3} m/s; expected {expected:.2e} m, bound {bound:.2e} m");
    assert!(most <= bound && bound < 10.0 * most, "{most} {bound}");
    assert!(speed <= f64::from(path.max_speed(0.05)));
}

/// The greatest lag, relative speed and gap over the dome.
fn greatest_lag(controller: &Controller, path: Path, probe: Vec3) -> [f64; 3] {
    let scene = Scene::new(LIMITS, [part(Motion::Prescribed(path), MATERIAL)]);
    let mut state = scene.rest();
    let mut most = [0.0_f64; 3];
    for tick in 0..12_000 {
        scene.follow(controller, &mut state, Probe::at(probe), PERIOD);
        if tick < 4_000 {
            continue;
        }
        let part = state.part(0).unwrap();
        let seen = part.placement().point_to_b(probe);
        let speed = double(part.placement().velocity_at(probe)).length();
        let found = [lag(part.witness(), seen), speed, f64::from(part.gap())];
        most.iter_mut().zip(found).for_each(|(most, found)| *most = most.max(found));
    }
    most
}

/// The mean lag over the dome of a box that turns and sways under the probe.
fn mean_lag(controller: &Controller, path: Path, probe: Vec3) -> f64 {
    let scene = Scene::new(LIMITS, [part(Motion::Prescribed(path), MATERIAL)]);
    let mut state = scene.rest();
    let (mut sum, mut count) = (0.0, 0);
    for tick in 0..12_000 {
        scene.follow(controller, &mut state, Probe::at(probe), PERIOD);
        if tick < 4_000 {
            continue;
        }
        let part = state.part(0).unwrap();
        let seen = part.placement().point_to_b(probe);
        sum += lag(part.witness(), seen);
        count += 1;
    }
    sum / f64::from(count)
}

#[test]
fn motion_fed_forward_takes_the_lag_of_a_turning_body_away() {
    // The dome on top, z from 28 to 34 mm, turned about an upright axis beside its middle.
    let start = Placement { origin: vec3(-0.03, -0.02, 0.0), ..Placement::IDENTITY };
    let path = Path::new(start).turning(Vec3::Z, vec3(0.004, 0.003, 0.0), 3.0, RATE);
    let probe = vec3(0.005, -0.004, 0.036);
    let slow = |feed_forward| {
        Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Constant(100.0)).feed_forward(feed_forward))
    };
    let plain = mean_lag(&slow(FeedForward::None), path, probe);
    let fed = mean_lag(&slow(FeedForward::Full), path, probe);
    let certified = mean_lag(&Controller::FirstOrder(FirstOrder::CERTIFIED), path, probe);
    let certified_fed =
        mean_lag(&Controller::FirstOrder(FirstOrder::CERTIFIED.feed_forward(FeedForward::Full)), path, probe);
    let default = mean_lag(&Controller::SecondOrder, path, probe);
    println!("gain 100/s: {plain:.2e} m, fed forward {fed:.2e} m; certified {certified:.2e}, {certified_fed:.2e} m");
    println!("second order {default:.2e} m");
    assert!(fed * 10.0 < plain, "{fed} {plain}");
    // The certified law has next to no lag to take away: both are some ten roundings of the coordinates.
    assert!(certified_fed <= certified + 4e-9, "{certified_fed} {certified}");
    assert!(default <= certified, "{default} {certified}");
}

/// A body that a host leads into the tool from one tick to the next pushes nobody; one that comes there by and by does.
#[test]
fn a_body_that_jumps_into_the_tool_is_not_felt() {
    let at = |origin| Placement { origin, ..Placement::IDENTITY };
    // The side at x = 60 mm: the tool 1 mm in front of it, then 2 mm behind, which is no jump for the tracker.
    let (away, inside) = (DVec3::new(-0.061, -0.02, -0.01), DVec3::new(-0.058, -0.02, -0.01));
    for (steps, is_felt) in [(1_u16, false), (1_000, true)] {
        let scene = Scene::new(LIMITS, [part(Motion::Resting(at(away.as_vec3())), MATERIAL)]);
        let mut state = scene.rest();
        let tick = |state: &mut _| scene.follow(&Controller::SecondOrder, state, Probe::at(Vec3::ZERO), PERIOD);
        for _ in 0..200 {
            tick(&mut state);
        }
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            scene.lead(&mut state, 0, at(away.lerp(inside, share).as_vec3())).unwrap();
            tick(&mut state);
        }
        for _ in 0..200 {
            tick(&mut state);
        }
        assert_eq!(state.force() != Vec3::ZERO, is_felt, "in {steps} steps");
    }
}
