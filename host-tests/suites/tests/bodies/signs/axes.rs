//! On the axis of bodies of revolution, and within a micrometre of it: above and below domes, cones, pits and tips that
//! meet, from a standing start and on the way through the surface. The profile tells inside from outside: of bodies
//! that are drawn here, of the shipped ones, and of parts that the importer made.

use super::shapes::{patch, row};
use super::{ON_SURFACE, from_environment};
use glam::{DVec2, DVec3};
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::track::{Contact, Controller, Probe};
use palpate_bake::locator::LocatorOptions;
use palpate_bake::{BakedBody, Model};
use palpate_truth::closest::Solver;
use palpate_truth::generate::Random;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_SQRT_2;

/// Probes of a body in a long run: 10⁵ for all.
const MOST_PROBES: usize = 12_000;
/// Distance from the axis, mm.
const BESIDE: f64 = 1e-3;
/// Probes within this of the surface, in sizes, are on it as far as the firmware can tell: twice [`ON_SURFACE`], for the
/// tangents of a needle's tip are rounding.
const ON_FIRMWARES_SURFACE: f64 = 2.0 * ON_SURFACE;
/// A gap of the wrong sign is nowhere larger, in sizes: that distance, and what the rounding of a probe adds.
const HIDDEN: f64 = 3.0 * ON_SURFACE;

/// Bézier curves of (radius, height), mm, upwards on the outside; `stretch` scales x, y and z of the body.
struct Profile {
    name: &'static str,
    pieces: Vec<Vec<[f64; 3]>>,
    stretch: DVec3,
    /// The model, if it is not drawn by the profile.
    file: Option<&'static str>,
}

/// A model file and the profile that it should have. The importer keeps the part's vertices, so that within a micrometre
/// of the axis what it made is nearer to the profile than a probe can tell.
macro_rules! of_file {
    ($file:literal, $profile:expr) => {
        Profile { name: $file, file: Some(include_str!(concat!("../../../", $file))), ..$profile }
    };
}

/// A circle's arc from one angle to the other, by less than half a turn.
fn arc([x, z]: [f64; 2], radius: f64, [from, to]: [f64; 2]) -> Vec<[f64; 3]> {
    let weight = (0.5 * (to - from)).cos();
    let at = |angle: f64, far: f64, weight: f64| [x + far * angle.cos(), z + far * angle.sin(), weight];
    vec![at(from, radius, 1.0), at(0.5 * (from + to), radius / weight, weight), at(to, radius, 1.0)]
}

/// A disc, a wall to a rim, and an arc from the rim over its centre to the axis.
fn turned(rim: [f64; 2], centre: [f64; 2]) -> Profile {
    let radius = (rim[0] - centre[0]).hypot(rim[1] - centre[1]);
    let tip = (-centre[0] / radius).acos();
    let mut pieces = profile("", &[&[[0.0, 0.0], [rim[0], 0.0]], &[[rim[0], 0.0], rim]]).pieces;
    let mut over = arc(centre, radius, [(rim[1] - centre[1]).atan2(rim[0] - centre[0]), tip]);
    over[2][0] = 0.0;
    pieces.push(over);
    Profile { name: "", pieces, stretch: DVec3::ONE, file: None }
}

fn profile(name: &'static str, pieces: &[&[[f64; 2]]]) -> Profile {
    let pieces = pieces.iter().map(|piece| piece.iter().map(|[x, z]| [*x, *z, 1.0]).collect()).collect();
    Profile { name, pieces, stretch: DVec3::ONE, file: None }
}

fn profiles() -> Vec<Profile> {
    let quarters = |stretch| Profile {
        name: "ellipsoid",
        pieces: vec![
            vec![[0.0, -1.0, 1.0], [1.0, -1.0, FRAC_1_SQRT_2], [1.0, 0.0, 1.0]],
            vec![[1.0, 0.0, 1.0], [1.0, 1.0, FRAC_1_SQRT_2], [0.0, 1.0, 1.0]],
        ],
        stretch,
        file: None,
    };
    vec![
        of_file!("../models/sphere_body.toml", quarters(DVec3::splat(50.0))),
        of_file!("../models/ellipsoid_body.toml", quarters(DVec3::new(50.0, 35.0, 25.0))),
        of_file!("../models/ellipsoid_poles.toml", quarters(DVec3::new(50.0, 35.0, 25.0))),
        of_file!("data/ellipsoid_tip.toml", quarters(DVec3::new(8.0, 8.0, 30.0))),
        of_file!(
            "../models/rounded_cylinder.toml",
            profile(
                "",
                &[&[[0.0, -25.0], [22.0, -25.0]], &[[22.0, -25.0], [22.0, 25.0]], &[[22.0, 25.0], [0.0, 25.0]]]
            )
        ),
        of_file!("data/cad_crown.toml", turned([10.0, 5.0], [-2.0, 5.0 - 756_f64.sqrt()])),
        of_file!("data/cad_steep_crown.toml", turned([10.0, 5.0], [-9.0, -1.244_997_998_398])),
        of_file!("data/cad_pit.toml", turned([14.0, 14.0], [3.574_675_324_675, 14.204_545_454_545])),
        of_file!(
            "data/cad_dome.toml",
            Profile {
                pieces: vec![
                    vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]],
                    vec![[1.0, 0.0, 1.0], [1.0, 1.0, FRAC_1_SQRT_2], [0.0, 1.0, 1.0]],
                ],
                ..quarters(DVec3::new(12.0, 12.0, 7.0))
            }
        ),
        profile("cone on a disc", &[&[[0.0, 0.0], [15.0, 0.0]], &[[15.0, 0.0], [0.0, 20.0]]]),
        profile("needle", &[&[[0.0, 0.0], [1.5, 0.0]], &[[1.5, 0.0], [0.0, 30.0]]]),
        profile("spline knob", &[&[[0.0, 0.0], [8.0, 0.0]], &[[8.0, 0.0], [16.0, 8.0], [4.0, 20.0], [0.0, 20.0]]]),
        profile("pit", &[&[[0.0, 0.0], [12.0, 0.0]], &[[12.0, 0.0], [12.0, 18.0]], &[[12.0, 18.0], [0.0, 7.0]]]),
        profile("lemon", &[&[[0.0, -15.0], [12.0, -5.0], [12.0, 5.0], [0.0, 15.0]]]),
        profile("apple", &[&[[0.0, -6.0], [14.0, -16.0], [26.0, 0.0], [14.0, 16.0], [0.0, 6.0]]]),
        profile("two dimples that nearly meet", &[&[[0.0, -0.05], [30.0, -20.0], [30.0, 20.0], [0.0, 0.05]]]),
        profile(
            "two cones tip to tip",
            &[
                &[[0.0, -12.0], [9.0, -12.0]],
                &[[9.0, -12.0], [0.0, 0.0]],
                &[[0.0, 0.0], [9.0, 12.0]],
                &[[9.0, 12.0], [0.0, 12.0]],
            ],
        ),
    ]
}

impl Profile {
    fn model(&self) -> String {
        if let Some(text) = self.file {
            return text.to_owned();
        }
        let mut text = "name = \"axis\"\nunit = \"mm\"\n".to_owned();
        for piece in &self.pieces {
            for [x, y] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
                let arc = [(x, y, 1.0), (x - y, y + x, FRAC_1_SQRT_2), (-y, x, 1.0)];
                let along = |(x, y, weight): (f64, f64, f64)| {
                    let point = |[r, z, w]: &[f64; 3]| row(DVec3::new(r * x, r * y, *z) * self.stretch, w * weight);
                    piece.iter().map(point).collect::<Vec<_>>()
                };
                patch(&mut text, [2, piece.len() - 1], &arc.map(along), false);
            }
        }
        text
    }

    /// Where a parallel to the axis, close to it, goes through the surface, mm.
    fn heights(&self, at: DVec2) -> Vec<f64> {
        let radius = (at / self.stretch.truncate()).length();
        let mut heights = Vec::new();
        for piece in &self.pieces {
            for reversed in [false, true] {
                let mut net = piece.clone();
                if reversed {
                    net.reverse();
                }
                if net[0][0] == 0.0 {
                    // The radius rises over the first tenth of every curve.
                    let (mut low, mut high) = (0.0, 0.1);
                    for _ in 0..80 {
                        let middle = 0.5 * (low + high);
                        if on_curve(&net, middle).x < radius { low = middle } else { high = middle }
                    }
                    heights.push(on_curve(&net, low).y * self.stretch.z);
                }
            }
        }
        heights
    }

    /// Whether a point close to the axis is inside; `None` within `margin` of the surface.
    fn is_inside(&self, at: DVec3, margin: f64) -> Option<bool> {
        let inside = |at: DVec3| self.heights(at.truncate()).iter().filter(|height| **height > at.z).count() % 2 == 1;
        let is = inside(at);
        let outwards = at.truncate().normalize_or(DVec2::X).extend(0.0);
        let around = [DVec3::Z, -DVec3::Z, outwards, -outwards];
        around.iter().all(|way| inside(at + *way * margin) == is).then_some(is)
    }

    /// Where the surface meets the axis, mm.
    fn poles(&self) -> Vec<f64> {
        self.heights(DVec2::ZERO)
    }
}

/// A point of a rational Bézier curve.
fn on_curve(net: &[[f64; 3]], t: f64) -> DVec2 {
    let mut points: Vec<_> = net.iter().map(|[x, z, w]| DVec3::new(x * w, z * w, *w)).collect();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    points[0].truncate() / points[0].z
}

/// Signs of cold queries, and of a standing probe in the firmware: how many are wrong.
fn wrong_cold(profile: &Profile, body: &Body, solver: &Solver, centre: DVec3, random: &mut Random) -> usize {
    let size = 1e3 * f64::from(body.size());
    let (mut wrong, hidden) = (0, 1e-3 * HIDDEN * size);
    for _ in 0..from_environment("PALPATE_PROBES", 100).min(MOST_PROBES) {
        let pole = profile.poles()[random.below(profile.poles().len())];
        let up = if random.happens(0.5) { 1.0 } else { -1.0 };
        let beside = if random.happens(0.3) { DVec3::ZERO } else { random.direction() * random.scale(1e-6, BESIDE) };
        // Beside a tip the side of its normal says nothing: a part of the probes is that near.
        let farthest = if random.happens(0.4) { BESIDE } else { 0.6 * size };
        let given = beside.truncate().extend(pole + up * random.scale(1e-5, farthest));
        let probe = (1e-3 * given - centre).as_vec3();
        let at = 1e3 * (probe.as_dvec3() + centre);
        let (found, mut state) = solver.cold(probe);
        for _ in 0..64 {
            body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 1.0);
        }
        let small = f64::from(state.gap.abs()) <= hidden;
        let Some(is_inside) = profile.is_inside(at, ON_SURFACE * size) else {
            // A tracker may rest on a pit's pole, a tenth of a micrometre off: the side is right.
            let to_the_pole = 1e-3 * at.distance(DVec3::Z * pole);
            let is_right = profile.is_inside(at, 0.0) == Some(state.gap < 0.0);
            if !small && (!is_right || f64::from(state.gap.abs()) > to_the_pole + hidden) {
                println!("{}: {at:?} on the surface: {state:?}", profile.name);
                wrong += 1;
            }
            continue;
        };
        let is_sure = profile.is_inside(at, ON_FIRMWARES_SURFACE * size).is_some();
        if found.is_inside != is_inside || (is_sure || !small) && (state.gap < 0.0) != is_inside {
            println!("{}: {at:?} inside {is_inside}: cold {}, {state:?}", profile.name, found.is_inside);
            wrong += 1;
        }
    }
    wrong
}

/// Signs on the way from outside through a pole and back: how many are wrong.
fn wrong_tracked(profile: &Profile, body: &Body, centre: DVec3, random: &mut Random) -> usize {
    let size = 1e3 * f64::from(body.size());
    let mut wrong = 0;
    for pole in profile.poles() {
        // The side of the pole that is outside, and the depth on the other side to which this pole is the nearest.
        let (above, below): (Vec<_>, Vec<_>) =
            profile.poles().into_iter().filter(|other| *other != pole).partition(|other| *other > pole);
        let is_under = above.len() % 2 == 1;
        let up = if is_under { -1.0 } else { 1.0 };
        let opposite = if is_under { above } else { below };
        let thickness = opposite.iter().map(|other| (other - pole).abs()).fold(f64::INFINITY, f64::min);
        let beside = if random.happens(0.3) { DVec3::ZERO } else { random.direction() * random.scale(1e-6, BESIDE) };
        let mut state = body.start();
        // 4 kHz at 0.1 m/s.
        let rows = 120;
        let mut was_inside = false;
        for row in -rows..=rows {
            let height = (f64::from(i32::abs(row)) * 0.025 - 1.5).max(-0.45 * thickness);
            let given = beside.truncate().extend(pole + up * height);
            let probe: Vec3 = (1e-3 * given - centre).as_vec3();
            let at = 1e3 * (probe.as_dvec3() + centre);
            body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 2.5e-4);
            while !state.is_located {
                body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 2.5e-4);
            }
            let Some(is_inside) = profile.is_inside(at, ON_FIRMWARES_SURFACE * size) else { continue };
            // The tick that crosses the surface may end on an edge, whose faces decide in the next.
            let crosses = std::mem::replace(&mut was_inside, is_inside) != is_inside;
            let is_negative = state.gap < 0.0 || state.contact == Contact::Touching;
            if row > 3 - rows && !crosses && is_negative != is_inside {
                println!("{}: {at:?}, {height} mm above the pole, inside {is_inside}: {state:?}", profile.name);
                wrong += 1;
            }
        }
    }
    wrong
}

#[test]
fn the_axis_of_a_body_has_an_inside() {
    let wrong = |profile: &Profile| {
        let mut random = Random::new(5);
        let text = profile.model();
        let model = Model::parse(&text, profile.name).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let baked = BakedBody::new(&model, profile.name).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let axis: Vec<_> = (-1000..=1000).map(|step| 1e-3 * DVec3::Z * f64::from(step) * 0.1 - model.centre).collect();
        // Fewer samples than a bake that ships: a list that lost the nearest point would show here as well.
        let options = LocatorOptions { samples: 64, ..baked.locator_options() };
        let baked = baked.located_for(&axis, &options, &|_, _| ()).unwrap();
        let body = baked.to_body().unwrap();
        let solver = Solver::new(&body, &baked);
        let cold = wrong_cold(profile, &body, &solver, model.centre, &mut random);
        let tracked = wrong_tracked(profile, &body, model.centre, &mut random);
        println!("{}: {cold} cold and {tracked} tracked signs are wrong", profile.name);
        cold + tracked
    };
    assert_eq!(profiles().par_iter().map(wrong).sum::<usize>(), 0);
}
