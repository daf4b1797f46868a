//! Two patches: the closest pair of moving bodies and the common normal of intersecting ones, against pairs that are
//! known because they are built that way.
//!
//! Body B is placed so that a point of its patch faces a point of A's patch along a common normal, at a chosen
//! distance. Both bodies are convex, so the two tangent planes separate them and that distance is the least; at a
//! negative one it is the pair of the common normal, whatever the shapes.
//!
//! `PALPATE_PAIRS=10000 cargo test --release --test tracking pairs -- --nocapture` is the long mode; without the
//! variable 1,000 pairs are drawn.

use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate::track::{CommonNormalTracker, Outcome, PairTracker, PairWitness, Placement};
use palpate_bake::BakedPatch;
use palpate_truth::generate::{ConvexPatch, Kind, Random, fit};
use palpate_truth::measured::{grouped, measured};
use palpate_truth::oracle::OraclePoint;

/// How many pairs to draw.
fn pairs() -> u64 {
    std::env::var("PALPATE_PAIRS").map_or(1_000, |pairs| pairs.parse().expect("PALPATE_PAIRS is a number"))
}

const TOLERANCE: f64 = 1e-5;

struct Body {
    drawn: ConvexPatch,
    patch: SplinePatch<'static>,
    curvature: f64,
}

impl Body {
    fn draw(kind: Kind, random: &mut Random) -> Self {
        let drawn = ConvexPatch::draw(kind, random);
        let patch = BakedPatch::without_shape(&drawn.surface).expect("it bakes").to_patch().expect("its table is good");
        let grid = || (0..=8).map(|index| f64::from(index) / 8.0);
        let curvature = grid().flat_map(|u| grid().map(move |v| (u, v))).map(|(u, v)| greatest_curvature(&drawn, u, v));
        // A grid misses the very greatest; smooth shapes of this kind by less than a tenth.
        let curvature = 1.1 * curvature.fold(0.0, f64::max);
        Self { drawn, patch, curvature }
    }
}

/// The greater principal curvature, 1/m, from both fundamental forms.
fn greatest_curvature(patch: &ConvexPatch, u: f64, v: f64) -> f64 {
    let at = OraclePoint::evaluate(&patch.surface, u, v);
    let normal = patch.point_and_normal(u, v).1;
    let [e, f, g] = [at.tangent_u.dot(at.tangent_u), at.tangent_u.dot(at.tangent_v), at.tangent_v.dot(at.tangent_v)];
    let [l, m, n] = [at.second_uu, at.second_uv, at.second_vv].map(|second| -second.dot(normal));
    let determinant = e * g - f * f;
    let (mean, gauss) = (0.5 * (e * n - 2.0 * f * m + g * l) / determinant, (l * n - m * m) / determinant);
    mean + (mean * mean - gauss).max(0.0).sqrt()
}

/// Points of both patches that face each other, with the distance between them and the spin about their normal.
#[derive(Clone, Copy)]
struct Facing {
    a: [f64; 2],
    b: [f64; 2],
    distance: f64,
    spin: f64,
}

impl Facing {
    fn draw(random: &mut Random, distance: f64) -> Self {
        let mut inside = || [(); 2].map(|()| random.between(0.1, 0.9));
        let (a, b) = (inside(), inside());
        Self { a, b, distance, spin: random.between(0.0, 6.0) }
    }

    fn between(self, other: Self, share: f64) -> Self {
        let blend = |x: f64, y: f64| x + (y - x) * share;
        Self {
            a: [blend(self.a[0], other.a[0]), blend(self.a[1], other.a[1])],
            b: [blend(self.b[0], other.b[0]), blend(self.b[1], other.b[1])],
            distance: blend(self.distance, other.distance),
            spin: blend(self.spin, other.spin),
        }
    }

    /// Where B has to stand, in A's frame.
    fn placement(&self, a: &Body, b: &Body) -> Placement {
        let (point_a, normal_a) = a.drawn.point_and_normal(self.a[0], self.a[1]);
        let (point_b, normal_b) = b.drawn.point_and_normal(self.b[0], self.b[1]);
        // B's normal onto the opposite of A's; the spin about it is free.
        let frame = |normal: DVec3, turn: f64| {
            let side = normal.any_orthonormal_vector();
            let side = side * turn.cos() + normal.cross(side) * turn.sin();
            [side, normal.cross(side), normal]
        };
        let (from, to) = (frame(normal_b, 0.0), frame(-normal_a, self.spin));
        let turned = |v: DVec3| to[0] * v.dot(from[0]) + to[1] * v.dot(from[1]) + to[2] * v.dot(from[2]);
        let origin = point_a + normal_a * self.distance - turned(point_b);
        Placement {
            axes: [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turned(axis).as_vec3()),
            origin: origin.as_vec3(),
            ..Placement::IDENTITY
        }
    }
}

fn bodies(seed: u64, random: &mut Random) -> (Body, Body) {
    // Theorem 2 wants one of the two strictly convex.
    let strict = [Kind::Ellipsoid, Kind::Paraboloid, Kind::Quartic][seed as usize % 3];
    (Body::draw(strict, random), Body::draw(Kind::ALL[seed as usize % 5], random))
}

fn start(random: &mut Random) -> [f32; 2] {
    [(); 2].map(|()| random.between(0.0, 1.0) as f32)
}

#[test]
fn the_closest_pair_of_moving_bodies_is_found() {
    /// Ticks of motion from one placement to the next, then at rest.
    const MOVING: u32 = 200;
    /// Bodies nearly touching converge by `1/((1 + d κ_A)(1 + d κ_B))` a tick.
    const RESTING: u32 = 4_000;
    let (mut worst, mut rejected, mut most_ticks, mut rise) = (0.0_f64, 0_u64, 0, 0.0_f64);
    for seed in 0..pairs() {
        let mut random = Random::new(seed);
        let (a, b) = bodies(seed, &mut random);
        let size = f64::from(a.patch.size().max(b.patch.size()));
        let [first, second] = [(); 2].map(|()| {
            let distance = size * random.scale(0.02, 1.0);
            Facing::draw(&mut random, distance)
        });
        let mut witness = PairWitness::at(&a.patch, &b.patch, start(&mut random), start(&mut random));
        let tracker = PairTracker::default();
        let mut before = f64::INFINITY;
        for tick in 0..MOVING + RESTING {
            let share = f64::from(tick.min(MOVING)) / f64::from(MOVING);
            let placement = first.between(second, share).placement(&a, &b);
            let step = tracker.step(&a.patch, &b.patch, &placement, &mut witness, 1.0);
            rejected += u64::from(step.a.outcome == Outcome::Rejected) + u64::from(step.b.outcome == Outcome::Rejected);
            let now = f64::from(step.difference.length());
            if tick > MOVING {
                rise = rise.max((now - before) / size);
                most_ticks = most_ticks.max(tick - MOVING);
                if step.a.residual().max(step.b.residual()) < 2e-6 * size as f32 {
                    break;
                }
            }
            before = now;
        }
        let placement = second.placement(&a, &b);
        let difference = witness.a.surface.point - placement.point_to_a(witness.b.surface.point);
        let error = (f64::from(difference.length()) - second.distance).abs() / size;
        assert!(error <= TOLERANCE, "pair {seed}: off by {error:e} of the size at distance {}", second.distance);
        worst = worst.max(error);
    }
    println!(
        "{} moving pairs: distance off by {worst:.1e} of the size at most, at most {most_ticks} ticks at rest, \
         V up by {rise:.1e} of the size at most, {rejected} rejected steps",
        pairs()
    );
    // Rounding of both points and of the placement, some 30 units in the last place.
    assert!(rise < 4e-6, "V rose by {rise:e} of the size");
    assert_eq!(rejected, 0);
    measured(&format!("{} moving pairs of patches: maximum error", grouped(pairs())), format!("{worst:.1e}"));
}

#[test]
fn the_common_normal_is_found_from_apart_through_contact_into_penetration() {
    const TICKS: u32 = 3_000;
    let (mut worst, mut worst_depth) = (0.0_f64, 0.0_f64);
    for seed in 0..pairs() {
        let mut random = Random::new(seed);
        let (a, b) = bodies(seed, &mut random);
        let size = f64::from(a.patch.size().max(b.patch.size()));
        // From a gap to a depth of a fifth of what keeps the pair unique and the law stable.
        let reach = (0.2 / (a.curvature + b.curvature)).min(0.5 * size);
        let depth = random.between(-reach, reach);
        let facing = Facing::draw(&mut random, -depth);
        let placement = facing.placement(&a, &b);
        let near = |[u, v]: [f64; 2], random: &mut Random| {
            [u, v].map(|parameter| (parameter + random.between(-0.1, 0.1)).clamp(0.0, 1.0) as f32)
        };
        let mut witness = PairWitness::at(&a.patch, &b.patch, near(facing.a, &mut random), near(facing.b, &mut random));
        let tracker = CommonNormalTracker::new(a.curvature as f32, b.curvature as f32);
        let mut last = None;
        for _ in 0..TICKS {
            last = tracker.step(&a.patch, &b.patch, &placement, &mut witness);
        }
        let found = last.expect("the patches are regular");
        let error = (f64::from(found.depth) - depth).abs() / size;
        assert!(error <= TOLERANCE, "pair {seed}: depth {depth}, found {found:?}, off by {error:e} of the size");
        worst = worst.max(error);
        worst_depth = worst_depth.max(depth / size);
    }
    println!("to a depth of {worst_depth:.2} sizes");
    measured(&format!("{} common normals: maximum error of the depth", grouped(pairs())), format!("{worst:.1e}"));
}

/// A cap of the sphere of a radius about the origin, around the direction +z.
fn sphere_cap(radius: f64) -> SplinePatch<'static> {
    let surface = fit([2, 2], false, |u, v| {
        let (s, t) = (u - 0.5, v - 0.5);
        let square = s * s + t * t;
        (DVec3::new(2.0 * s, 2.0 * t, 1.0 - square) * radius).extend(1.0 + square)
    });
    BakedPatch::without_shape(&surface).expect("it bakes").to_patch().expect("its table is good")
}

#[test]
fn two_spheres_have_the_pair_of_their_centres_line() {
    let (radius_a, radius_b) = (0.05_f64, 0.03_f64);
    let (a, b) = (sphere_cap(radius_a), sphere_cap(radius_b));
    // B hangs head down over A, a little to the side; from 10 mm apart to 10 mm deep.
    for gap in [0.01, 0.001, -0.001, -0.005, -0.01] {
        let towards = DVec3::new(0.2, -0.1, 1.0).normalize();
        let placement = Placement {
            axes: [Vec3::X, -Vec3::Y, -Vec3::Z],
            origin: (towards * (radius_a + radius_b + gap)).as_vec3(),
            ..Placement::IDENTITY
        };
        let mut witness = PairWitness::at(&a, &b, [0.3, 0.7], [0.6, 0.4]);
        let tracker = CommonNormalTracker::new(1.0 / radius_a as f32, 1.0 / radius_b as f32);
        for _ in 0..200 {
            tracker.step(&a, &b, &placement, &mut witness);
        }
        let expected = [towards * radius_a, towards * (radius_a + gap)];
        let found = [witness.a.surface.point, placement.point_to_a(witness.b.surface.point)].map(Vec3::as_dvec3);
        for (found, expected) in found.into_iter().zip(expected) {
            // 1e-5 of the size, and the points, not only their distance.
            assert!(found.distance(expected) < TOLERANCE * radius_a, "gap {gap}: {found}, not {expected}");
        }
        if gap > 0.0 {
            let mut witness = PairWitness::at(&a, &b, [0.0, 1.0], [1.0, 0.2]);
            for _ in 0..4_000 {
                PairTracker::default().step(&a, &b, &placement, &mut witness, 1.0);
            }
            let difference = witness.a.surface.point - placement.point_to_a(witness.b.surface.point);
            let error = (f64::from(difference.length()) - gap).abs();
            assert!(error < TOLERANCE * radius_a, "gap {gap}: off by {error:e} m");
        }
    }
}
