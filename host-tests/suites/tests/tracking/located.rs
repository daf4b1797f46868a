//! The location of a tool in the loop, on bodies that are not convex: it ends at every place, with the closest pair by a
//! proved bound in double precision. Above a dished top, whose four patches meet in a pole, a whole ring is as near.

use crate::golden_pairs::bake;
use glam::DVec3;
use palpate::math::vec3;
use palpate::pair::{Core, Tool, ToolSurface};
use palpate::servo::{Settings, Surface as _, Tracked as _};
use palpate::track::{Contact, Controller, Probe};
use palpate_bake::BakedBody;
use palpate_suites::repository;
use palpate_truth::generate::Random;
use palpate_truth::lower_bound::lower_bound;

const RADIUS_M: f64 = 0.003;
/// Half of the cores, metres.
const HALVES: [(&str, DVec3); 3] =
    [("ball", DVec3::ZERO), ("capsule", DVec3::new(0.0, 0.0, 0.009)), ("box", DVec3::new(0.009, 0.006, 0.003))];
/// Ticks in which it ends.
const MOST: u32 = 450;

/// Between the steps of the lattice on a core, metres.
const STEP_M: f64 = 0.003;

/// The least distance of the body from a lattice on the core's surface, and how far a point of it is from the lattice.
fn least(body: &BakedBody, half: DVec3, at: DVec3) -> (f64, f64) {
    let steps = half.to_array().map(|half| (half / STEP_M).round() as i32);
    let mut least = f64::INFINITY;
    for i in -steps[0]..=steps[0] {
        for k in -steps[1]..=steps[1] {
            for m in -steps[2]..=steps[2] {
                let at_border = [i, k, m].iter().zip(steps).any(|(step, most)| step.abs() == most && most > 0);
                if at_border || half == DVec3::ZERO || steps[0] == 0 {
                    let on_core = DVec3::new(f64::from(i), f64::from(k), f64::from(m)) * STEP_M;
                    least = least.min(lower_bound(body, at + on_core));
                }
            }
        }
    }
    let spanned = steps.iter().filter(|steps| **steps > 0).count().min(2);
    (least, 0.5 * STEP_M * (spanned as f64).sqrt())
}

#[test]
fn the_location_ends_everywhere_with_the_closest_pair() {
    for (name, above) in [("suites/data/cad_pit", Some(0.025)), ("models/teapot", None)] {
        let (baked, centre) = bake(&repository("host-tests").join(name).with_extension("toml"));
        let body = baked.to_body().expect("its tables fit");
        let size = f64::from(body.size());
        let mut random = Random::new(37);
        let mut places: Vec<DVec3> = Vec::new();
        if let Some(top) = above {
            for (away, height) in [(0.0, 0.03), (0.0, 0.018), (0.000_2, 0.03), (0.001, 0.02), (0.004, 0.03)] {
                places.push(DVec3::new(away, 0.0, top + height) - centre);
            }
        }
        while places.len() < 10 {
            let mut coordinate = || random.between(-1.0, 1.0) * size;
            let place = DVec3::new(coordinate(), coordinate(), coordinate());
            if (0.014..0.06).contains(&lower_bound(&baked, place)) {
                places.push(place);
            }
        }
        for (tool_name, half) in HALVES {
            let core = match half.as_vec3() {
                half if half.z <= 0.0 => Core::Point,
                half if half.x <= 0.0 => Core::Segment { half: half.z },
                half => Core::Box { half: half.to_array() },
            };
            let tool = Tool::new(core, RADIUS_M as f32).expect("a tool");
            let settings = Settings { rate_hz: 4_000.0, ..Settings::DEFAULT };
            let surface = ToolSurface::new(&body, tool, &settings).expect("a thick tool");
            let (mut ticks, mut worst) = (0, 0.0_f64);
            for place in &places {
                let at = place.as_vec3();
                let mut held = surface.rest();
                let located = (1..=MOST).find(|_| {
                    surface.orient(&mut held, [0.0, 0.0, 0.0, 1.0]);
                    surface.follow(&Controller::SecondOrder, &mut held, Probe::at(at), 2.5e-4);
                    held.contact() != Contact::Behind
                });
                let tick = located.unwrap_or_else(|| panic!("{name}, {tool_name} at {place}: not within {MOST} ticks"));
                ticks = ticks.max(tick);
                let (least, reach) = least(&baked, half, *place);
                let above = f64::from(held.gap()) + RADIUS_M - least;
                assert!(above <= 2e-6 * size, "{name}, {tool_name} at {place}: {above:e} m above a point of the core");
                assert!(above >= -reach - 2e-6 * size, "{name}, {tool_name} at {place}: {above:e} m below any");
                worst = worst.max(above);
            }
            println!("{name}, {tool_name}: within {ticks} ticks, up to {worst:.1e} m above the lattice's least");
        }
    }
}

/// The audit of a box over the teapot: some of its descents are handed to and fro between two faces.
#[test]
fn the_audit_goes_on_where_a_descent_never_rests() {
    let (baked, _) = bake(&repository("host-tests/models/teapot.toml"));
    let body = baked.to_body().expect("its tables fit");
    let tool = Tool::new(Core::Box { half: [0.009, 0.006, 0.003] }, RADIUS_M as f32).expect("a tool");
    let surface = ToolSurface::new(&body, tool, &Settings { rate_hz: 4_000.0, ..Settings::DEFAULT }).expect("thick");
    let mut held = surface.rest();
    let (mut cell, mut since, mut longest) = (String::new(), 0, 0);
    for tick in 0..1_500 {
        surface.orient(&mut held, [0.0, 0.0, 0.0, 1.0]);
        let at = vec3(0.002_552_312, -0.019_418_41, 0.038_400_82);
        surface.follow(&Controller::SecondOrder, &mut held, Probe::at(at), 2.5e-4);
        if held.proxy().is_holding() {
            let state = format!("{:?}", held.proxy().tracker());
            let now = state.split("cells: ").nth(1).and_then(|rest| rest.split('}').next()).expect("its cell");
            if now != cell {
                (cell, since) = (now.to_owned(), tick);
            }
            longest = longest.max(tick - since);
        }
    }
    println!("at most {longest} ticks on a cell");
    assert!(!cell.is_empty() && longest < 20, "{longest} ticks on a cell");
}
