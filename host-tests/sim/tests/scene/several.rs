//! Several bodies, against one that looks at all of them at every tick.

use crate::common::{BOX, LIMITS, MATERIAL, PERIOD, RATE, Random, double, part, single};
use glam::DVec3;
use palpate::body::{Body, BodyWitness};
use palpate::math::{Vec3, vec3};
use palpate::scene::{Material, Motion, Path, Scene};
use palpate::servo::BakedTables;
use palpate::servo::{Surface, TableCheck};
use palpate::track::{Contact, Controller, Placement, Probe};

/// A tracker for each body, each stepped at every tick, in the placement that the body's path has then.
struct Oracle<const N: usize> {
    paths: [Path; N],
    states: [BodyWitness; N],
}

impl<const N: usize> Oracle<N> {
    fn follow(&mut self, tick: u32, probe: Probe) {
        for (path, state) in self.paths.iter().zip(&mut self.states) {
            let placement = path.at(tick);
            let seen = Probe {
                position: placement.point_to_b(probe.position),
                velocity: placement.direction_to_b(probe.velocity - placement.velocity_at(probe.position)),
            };
            BOX.step(&Controller::SecondOrder, state, seen, PERIOD);
        }
    }

    fn touches(&self, index: usize) -> bool {
        self.states[index].contact == Contact::Touching
    }
}

/// Boxes in a cloud, that turn and sway.
fn cloud<const N: usize>(random: &mut Random) -> [Path; N] {
    core::array::from_fn(|_| {
        let place = random.vector(if N > 1 { 0.1 } else { 0.01 });
        let origin = single(place - DVec3::new(0.03, 0.02, 0.015));
        let pivot = single(place);
        Path::new(Placement { origin, ..Placement::IDENTITY })
            .turning(single(random.direction()), pivot, random.between(-2.0, 2.0) as f32, RATE)
            .swaying(single(random.direction() * 0.005), random.between(1.0, 8.0) as f32, RATE)
    })
}

/// Ticks with one cloud.
const TICKS: u32 = 50_000;

#[derive(Default)]
struct Delays {
    contacts: u32,
    /// Contacts of a body while two others are touched: it is felt once one of these is let go of.
    crowded: u32,
    late: u32,
    greatest: u32,
    /// Not felt when the longest delay was over.
    missed: u32,
}

/// Strokes at `speed` through the cloud, each to a point near a box.
fn strokes<const N: usize>(seed: u64, speed: f64, ticks: u32) -> Delays {
    let mut random = Random::new(seed);
    let mut delays = Delays::default();
    let longest = delay::<N>();
    let mut tick = 0;
    while tick < ticks {
        let paths = cloud::<N>(&mut random);
        let scene = Scene::new(LIMITS, paths.map(|path| part(Motion::Prescribed(path), Material::new(600.0, 1.0))));
        let mut state = scene.rest();
        let mut oracle = Oracle { paths, states: [BOX.start(); N] };
        let mut since: [Option<u32>; N] = [None; N];
        let mut position = DVec3::new(0.25, 0.0, 0.0);
        let mut velocity = DVec3::ZERO;
        let mut goal = position;
        for now in 1..=TICKS {
            // All are found before the first stroke.
            if now > 3_000 {
                if (goal - position).length() < 2e-3 {
                    let path = &paths[random.below(N)];
                    let middle = path.at(now).point_to_a(vec3(0.03, 0.02, 0.015));
                    goal = double(middle) + random.vector(0.05);
                    velocity = (goal - position).normalize() * speed;
                }
                position += velocity * f64::from(PERIOD);
            }
            let probe = Probe { position: single(position), velocity: single(velocity) };
            oracle.follow(now, probe);
            scene.follow(&Controller::SecondOrder, &mut state, probe, PERIOD);
            let touched = (0..N).filter(|index| oracle.touches(*index)).count();
            for (index, since) in since.iter_mut().enumerate() {
                let felt =
                    state.tracked().contains(&index) && state.part(index).unwrap().contact() == Contact::Touching;
                delays.contacts += u32::from(oracle.touches(index) && since.is_none());
                if !oracle.touches(index) {
                    *since = None;
                } else if felt {
                    if let Some(begun) = since.filter(|begun| *begun != u32::MAX) {
                        delays.greatest = delays.greatest.max(now - begun);
                        delays.late += u32::from(now > begun);
                    }
                    *since = Some(u32::MAX);
                } else if touched > 2 && *since != Some(u32::MAX) {
                    delays.crowded += u32::from(since.is_none());
                    *since = Some(u32::MAX);
                } else if since.is_none() {
                    *since = Some(now);
                } else if *since == Some(now - longest - 1) {
                    delays.missed += 1;
                }
            }
        }
        tick += TICKS;
    }
    delays
}

/// The longest from the tick at which a body is touched to the one at which it is felt.
const fn delay<const N: usize>() -> u32 {
    if N > 2 { Scene::<Body, N>::LOOKS } else { 0 }
}

#[test]
fn no_contact_is_missed_and_none_is_later_than_stated() {
    for speed in [0.1, 1.0] {
        let found =
            [strokes::<1>(1, speed, 200_000), strokes::<4>(2, speed, 400_000), strokes::<16>(3, speed, 400_000)];
        for (delays, (count, longest)) in found.iter().zip([(1, delay::<1>()), (4, delay::<4>()), (16, delay::<16>())])
        {
            println!(
                "{count} bodies, {speed} m/s: {} contacts, {} felt later, by at most {} of {longest} ticks, {} missed; \
                 {} beside two others",
                delays.contacts, delays.late, delays.greatest, delays.missed, delays.crowded
            );
            assert_eq!(delays.missed, 0);
            assert!(delays.greatest <= longest);
            assert!(delays.contacts > 10, "{}", delays.contacts);
        }
    }
}

/// Two boxes side by side with a groove between them: pressed into it, both push.
#[test]
fn in_a_corner_between_two_bodies_both_push() {
    // The first is level, its dome 28 to 34 mm high; the second stands on it, turned: its dome looks to −x.
    let axes = [Vec3::Z, Vec3::Y, -Vec3::X];
    let upright = Placement { axes, origin: vec3(0.08, 0.0, 0.0), ..Placement::IDENTITY };
    let scene = Scene::new(
        LIMITS,
        [part(Motion::Resting(Placement::IDENTITY), MATERIAL), part(Motion::Resting(upright), MATERIAL)],
    );
    let mut state = scene.rest();
    let mut force = Vec3::ZERO;
    for tick in 0..8_000 {
        let down = (f64::from(tick) / 4_000.0).min(1.0);
        // From above the groove into it, along its middle.
        let probe = DVec3::new(0.032 + 0.016 * down, 0.02, 0.044 - 0.016 * down);
        scene.follow(&Controller::SecondOrder, &mut state, Probe::at(single(probe)), PERIOD);
        force = state.force();
    }
    let [level, wall] = [0, 1].map(|index| *state.part(index).unwrap());
    println!("{force}: {} and {}, gaps {} and {}", level.force(), wall.force(), level.gap(), wall.gap());
    assert!(level.contact() == Contact::Touching && wall.contact() == Contact::Touching);
    assert!(level.force().z > 0.5 && wall.force().x < -0.5);
    assert!((force - level.force() - wall.force()).length() < 1e-6);
    // Each pushes with what it would alone, at rest: stiffness times depth.
    for part in [level, wall] {
        assert!((f64::from(part.force().length()) + 600.0 * f64::from(part.gap())).abs() < 1e-4);
    }
    assert!(double(force).length() > 1.0);
}

#[test]
fn the_tables_of_all_bodies_are_checked() {
    let resting = part(Motion::Resting(Placement::IDENTITY), MATERIAL);
    let scene = Scene::new(LIMITS, [resting; 3]);
    let expected = scene.baked_crc().expect("a baked body has one");
    assert_eq!(TableCheck::read(&scene), expected);
    let mut check = TableCheck::default();
    assert!((0..200_000).all(|_| check.step(&scene, expected)) && check.passes > 0);
    // One that is not what was baked, wherever it stands.
    let spoilt = BOX.with_crc(!BOX.baked_crc().unwrap());
    for place in 0..3 {
        let mut parts = [resting; 3];
        parts[place].surface = &spoilt;
        let scene = Scene::new(LIMITS, parts);
        assert_ne!(TableCheck::read(&scene), scene.baked_crc().unwrap(), "{place}");
    }
}
