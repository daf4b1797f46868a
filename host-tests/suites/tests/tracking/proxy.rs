//! The proxy of a tool in six degrees of freedom (theory §14), against the exact distance of two polytopes or of a ball,
//! in double precision: it stays outside, its wrench does not jump, and it gives out no energy.

use crate::tools::{body, core, direction, from_ball, radius};
use glam::{DQuat, DVec3};
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::pair::{Proxy, ProxyError, Tool, ToolCoupling};
use palpate::scene::BodyPose;
use palpate_suites::between_boxes;
use palpate_truth::generate::Random;

const RATE_HZ: f32 = 4_000.0;
const PERIOD_S: f64 = 1.0 / RATE_HZ as f64;
const TICKS: u32 = 12_000;
const RADIUS_M: f64 = 0.003;
/// N/m and N·m/rad.
const STIFFNESS: [f64; 2] = [1000.0, 0.1];

/// A pose of the tool in the model's frame.
#[derive(Clone, Copy)]
struct Pose {
    turn: DQuat,
    origin: DVec3,
}

impl Pose {
    fn of(pose: &BodyPose, centre: DVec3) -> Self {
        let [x, y, z, w] = pose.orientation.map(f64::from);
        let origin = Vec3::from_array(pose.position).as_dvec3() + centre;
        Self { turn: DQuat::from_xyzw(x, y, z, w).normalize(), origin }
    }

    fn to_body(self, centre: DVec3) -> BodyPose {
        let position = (self.origin - centre).as_vec3().to_array();
        BodyPose { position, orientation: self.turn.to_array().map(|number| number as f32) }
    }
}

fn coupling_at(rate_hz: f32) -> ToolCoupling {
    ToolCoupling::new(STIFFNESS[0] as f32, STIFFNESS[1] as f32, rate_hz).expect("three positive numbers")
}

/// What the hand went through.
#[derive(Default)]
struct Felt {
    /// Smallest true gap of the proxy, metres.
    gap: f64,
    /// Largest changes of the wrench in a tick beyond what the spring makes of the hand's own motion, N and N·m.
    jumps: [f64; 2],
    /// Largest changes of the wrench in a tick.
    steps: [f64; 2],
    /// Most energy that came out, less what a damper of `k h/2` takes, J.
    out: f64,
    force: f64,
    torque: f64,
    touched: u32,
    /// Evaluations of each tick.
    work: Vec<u32>,
}

/// A hand presses the tool into the body along `inward`, strokes it and rocks at `rad_per_s`.
fn press(
    body: &Body,
    tool: &Tool,
    centre: DVec3,
    (start, inward, depth): (DVec3, DVec3, f64),
    rad_per_s: f64,
    distance: impl Fn(&Pose) -> f64,
) -> Felt {
    let (along, across) = inward.any_orthonormal_pair();
    let hand = |tick: u32| {
        let time = f64::from(tick) * PERIOD_S;
        let depth = depth * (std::f64::consts::PI * time / (f64::from(TICKS) * PERIOD_S)).sin().powi(2);
        let stroke = along * (0.005 * (42.0 * time).sin()) + across * (0.004 * (29.0 * time).cos());
        let rock = DQuat::from_axis_angle(along, 0.3 * (rad_per_s / 0.3 / 1.5 * time).sin());
        let turn = rock * DQuat::from_axis_angle(across, 0.2 * (rad_per_s / 0.2 / 2.5 * time).sin());
        Pose { turn: turn * DQuat::from_axis_angle(inward, 0.4 * time), origin: start + inward * depth + stroke }
    };
    let coupling = coupling_at(RATE_HZ);
    let mut proxy = Proxy::start(body, tool, &hand(0).to_body(centre)).expect("it starts outside");
    let mut felt = Felt { gap: f64::INFINITY, ..Felt::default() };
    let (mut before, mut energy) = ([DVec3::ZERO; 2], 0.0_f64);
    for tick in 0..TICKS {
        let (now, next) = (hand(tick), hand(tick + 1));
        let wrench = proxy.tick(body, tool, &coupling, &now.to_body(centre), 0);
        assert_eq!(proxy.given_up(), None, "tick {tick}");
        let gap = distance(&Pose::of(proxy.pose(), centre)) - RADIUS_M;
        felt.gap = felt.gap.min(gap);
        let wrench = [wrench.force.as_dvec3(), wrench.torque.as_dvec3()];
        let turned = (next.turn * now.turn.inverse()).to_scaled_axis();
        let moved = [next.origin - now.origin, turned];
        for axis in 0..2 {
            let step = (wrench[axis] - before[axis]).length();
            felt.steps[axis] = felt.steps[axis].max(step);
            felt.jumps[axis] = felt.jumps[axis].max(step - STIFFNESS[axis] * moved[axis].length());
            energy += wrench[axis].dot(moved[axis]) - 0.5 * STIFFNESS[axis] * moved[axis].length_squared();
        }
        felt.out = felt.out.max(energy);
        (felt.force, felt.torque) = (felt.force.max(wrench[0].length()), felt.torque.max(wrench[1].length()));
        felt.touched += u32::from(!proxy.contacts().is_empty());
        felt.work.push(proxy.evaluations());
        before = wrench;
    }
    felt.work.sort_unstable();
    felt
}

#[test]
fn a_tool_in_a_hand_stays_outside_convex_bodies_and_its_wrench_does_not_jump() {
    let (base, base_centre) = body("capped_box");
    let (ball, ball_centre) = body("sphere_body");
    let ball_radius = radius(&ball);
    // The box below the dome; far from its top that is the body.
    let (low, high) = (DVec3::ZERO, DVec3::new(0.06, 0.04, 0.02));
    let off = DVec3::new(1.0, 1.0, 1.0).normalize();
    for (name, half) in
        [("box", DVec3::new(0.012, 0.007, 0.004)), ("capsule", DVec3::new(0.0, 0.0, 0.012)), ("ball", DVec3::ZERO)]
    {
        let tool = Tool::new(core(half), RADIUS_M as f32).expect("a tool");
        for (scene, from, inward) in [
            ("flat", DVec3::new(0.03, 0.02, 0.0), DVec3::Z),
            ("over the rim", DVec3::new(0.03, 0.0, 0.0), DVec3::new(0.0, 1.0, 1.0).normalize()),
            ("on the corner", DVec3::ZERO, off),
            ("on the ball", DVec3::ZERO, off),
        ] {
            let is_ball = scene == "on the ball";
            let (body, centre) = if is_ball { (&ball, ball_centre) } else { (&base, base_centre) };
            for rad_per_s in [2.5, 6.0] {
                let surface = if is_ball { ball_centre - inward * ball_radius } else { from };
                let start = surface - inward * (half.length() + 0.004);
                // 5 mm into the body, but for the rocking.
                let depth = 0.006 + half.length() - half.dot(inward.abs());
                let apart = |pose: &Pose| {
                    if is_ball {
                        from_ball(ball_radius, half, pose.turn, pose.origin - ball_centre)
                    } else {
                        between_boxes(low, high, half, pose.turn, pose.origin)
                    }
                };
                let Felt { gap, jumps, steps, out, force, torque, touched, work } =
                    press(body, &tool, centre, (start, inward, depth), rad_per_s, apart);
                println!(
                    "{name} {scene}, {rad_per_s} rad/s: gap {:.2} µm, {:.0} mN beyond the hand's ({:.0}), {:.3} mN·m \
                     ({:.3}), {:.2} µJ out, up to {force:.1} N and {:.0} mN·m, {touched} ticks; {} \
                     evaluations, at most {}",
                    gap * 1e6,
                    jumps[0] * 1e3,
                    steps[0] * 1e3,
                    jumps[1] * 1e3,
                    steps[1] * 1e3,
                    out * 1e6,
                    torque * 1e3,
                    work[work.len() / 2],
                    work[work.len() - 1]
                );
                assert!(gap >= -1e-6, "{name} {scene}: {gap:e}");
                // The steps that a hand does not feel at contact, beyond what its own motion makes.
                assert!(jumps[0] <= 0.05 && jumps[1] <= 2e-4, "{name} {scene}: {jumps:?}");
                assert!(out <= 1e-6, "{name} {scene}: {out:e} J");
                assert!(force > 0.8 && touched > TICKS / 20, "{name} {scene}: {force} N, {touched} ticks");
            }
        }
    }
}

/// `PALPATE_TICKS` sets the number of ticks.
#[test]
fn a_hand_that_jumps_at_random_pushes_no_proxy_in() {
    let ticks = std::env::var("PALPATE_TICKS").map_or(120_000, |ticks| ticks.parse::<u32>().expect("a number"));
    let (base, centre) = body("capped_box");
    let (low, high) = (DVec3::ZERO, DVec3::new(0.06, 0.04, 0.02));
    let coupling = coupling_at(RATE_HZ);
    let mut random = Random::new(41);
    let mut gaps = [f64::INFINITY; 3];
    let mut touched = 0;
    for (half, gap) in
        [DVec3::new(0.012, 0.007, 0.004), DVec3::new(0.0, 0.0, 0.012), DVec3::ZERO].into_iter().zip(&mut gaps)
    {
        let tool = Tool::new(core(half), RADIUS_M as f32).expect("a tool");
        let mut pose = Pose { turn: DQuat::IDENTITY, origin: DVec3::new(0.03, 0.02, -0.03) };
        let mut proxy = Proxy::start(&base, &tool, &pose.to_body(centre)).expect("it starts outside");
        for tick in 0..ticks / 3 {
            // Anywhere around the lower half of the box and in it, eight times a second.
            if tick % 500 == 0 {
                let mut at = |low: f64, high: f64| random.between(low, high);
                pose.origin = DVec3::new(at(-0.02, 0.08), at(-0.02, 0.06), at(-0.03, 0.005));
                pose.turn = DQuat::from_axis_angle(direction(&mut random), random.between(0.0, 0.6));
            }
            proxy.tick(&base, &tool, &coupling, &pose.to_body(centre), 0);
            assert_eq!(proxy.given_up(), None, "{half} at tick {tick}");
            touched += u32::from(!proxy.contacts().is_empty());
            let drawn = Pose::of(proxy.pose(), centre);
            // Higher up the dome is nearer than the box.
            if drawn.origin.z + half.length() < 0.012 {
                *gap = gap.min(between_boxes(low, high, half, drawn.turn, drawn.origin) - RADIUS_M);
            }
        }
    }
    println!("{ticks} ticks of hands that jump, {touched} in contact: least gaps {:.2?} µm", gaps.map(|gap| gap * 1e6));
    assert!(touched > ticks / 8, "{touched}");
    // No bound is proved for places that are not tracked: 53 µm were seen in a million ticks, taken back in some. Contact
    // is given up at 1.5 mm.
    assert!(gaps.iter().all(|gap| *gap >= -100e-6), "{gaps:?}");
}

#[test]
fn a_proxy_is_refused_or_given_up_by_name() {
    let (base, centre) = body("capped_box");
    let tool = |radius| Tool::new(core(DVec3::new(0.012, 0.007, 0.004)), radius).expect("a tool");
    let at = |z: f64| Pose { turn: DQuat::IDENTITY, origin: DVec3::new(0.03, 0.02, z) }.to_body(centre);
    let refused = |tool: &Tool, hand: &BodyPose| Proxy::start(&base, tool, hand).err();
    assert_eq!(refused(&tool(0.0001), &at(-0.02)), Some(ProxyError::Thin));
    assert_eq!(refused(&tool(0.003), &at(-0.005)), Some(ProxyError::Intersects));
    assert_eq!(refused(&tool(0.003), &at(f64::NAN)), Some(ProxyError::Pose));
    let skewed = BodyPose { orientation: [0.5, 0.0, 0.0, 0.0], ..at(-0.02) };
    assert_eq!(refused(&tool(0.003), &skewed), Some(ProxyError::Pose));
    for [way, turn, rate] in [[f32::NAN, 1.0, RATE_HZ], [1000.0, 0.0, RATE_HZ], [1000.0, 0.1, f32::INFINITY]] {
        assert_eq!(ToolCoupling::new(way, turn, rate), None);
    }
    let coupling = coupling_at(RATE_HZ);
    let mut proxy = Proxy::start(&base, &tool(0.003), &at(-0.02)).expect("it starts outside");
    let pulled = proxy.tick(&base, &tool(0.003), &coupling, &at(-0.01), 0);
    assert!(pulled.force.z < -5.0, "{pulled:?}");
    // A pose that is none ends contact: the force fades evenly within 5 ms, and there is none later.
    let mut last = pulled.force;
    for tick in 1..=40 {
        let hand = if tick == 1 { at(f64::NAN) } else { at(-0.01) };
        let wrench = proxy.tick(&base, &tool(0.003), &coupling, &hand, 0);
        let fallen = (last - wrench.force).length() / pulled.force.length();
        assert!(fallen <= 1.001 / (0.005 * RATE_HZ), "tick {tick}: {wrench:?}");
        assert!(tick < 21 || (wrench.force, wrench.torque) == (Vec3::ZERO, Vec3::ZERO), "tick {tick}: {wrench:?}");
        assert_eq!(proxy.given_up(), Some(ProxyError::Pose));
        last = wrench.force;
    }
}

/// A hand that jumps by 18 mm in free air: the spring's 18 N go at 160 N/s, at any rate from 4 kHz on.
#[test]
fn a_proxy_follows_as_fast_at_any_rate() {
    let (base, centre) = body("capped_box");
    let tool = Tool::new(core(DVec3::new(0.012, 0.007, 0.004)), RADIUS_M as f32).expect("a tool");
    let at = |z: f64| Pose { turn: DQuat::IDENTITY, origin: DVec3::new(0.03, 0.02, z) }.to_body(centre);
    for (rate_hz, seconds) in [(1_000.0, 0.45), (4_000.0, 0.1125), (20_000.0, 0.1125)] {
        let coupling = coupling_at(rate_hz);
        let mut proxy = Proxy::start(&base, &tool, &at(-0.02)).expect("it starts outside");
        let arrives = |_: &u32| proxy.tick(&base, &tool, &coupling, &at(-0.038), 0).force.length() < 1e-3;
        let ticks = (1..20_000).find(arrives).expect("it arrives");
        // The first tick may follow the hand by a whole step of 0.5 mm, a thirty-sixth of the way.
        let share = f64::from(ticks) / f64::from(rate_hz) / seconds;
        assert!((1.0 - 1.0 / 36.0 - 0.002..=1.002).contains(&share), "{rate_hz} Hz: {ticks} ticks, {share}");
    }
}
