//! Rides of a probe beside a body: latency of the tracker's nearest point, compared with a search from scratch in every
//! tick.
//!
//! A ride starts above a random point of a random face and follows a curve beside the body, over any neighbouring
//! faces. It ends at contact, where the witness point becomes the god-object, and far from the body.

use palpate::body::{Body, BodyWitness};
use palpate::math::Vec3;
use palpate::track::{Contact, Controller, Probe, Witness};
use palpate_bake::Random;
use rayon::prelude::*;

/// Settings of the rides.
#[derive(Clone, Copy, Debug)]
pub struct Rides {
    /// Number of rides.
    pub count: u32,
    /// Servo rate, Hz.
    pub rate: f32,
    /// Speed of the probe, m/s.
    pub speed: f32,
    /// Distance of the probe from the surface at the start, metres.
    pub distance: f32,
}

/// Result of the rides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lateness {
    /// Number of ticks.
    pub ticks: u64,
    /// Maximum number of consecutive ticks whose witness point was not the nearest.
    pub most: u32,
    /// Maximum excess of the distance, metres.
    pub excess: f32,
}

/// A witness point is not the nearest if its distance is this part too long, half of what the audit lets pass in
/// squares twice over, or by rounding of the size.
const TOO_LONG: f32 = 1.0e-3;
const ROUNDING: f32 = 1.0e-5;
/// A ride goes so far, and so far off, in sizes of the body.
const LENGTH: f32 = 0.5;
const FAR: f32 = 0.1;
/// Ticks until the probe is located and looked around: those of a whole search twice over.
const SETTLING: u32 = 2_500;
/// The seed of the rides.
const SEED: u64 = 57;

impl Rides {
    /// Rides along a body.
    pub fn along(&self, body: &Body) -> Lateness {
        (0..self.count).into_par_iter().map(|index| self.ride(body, index)).reduce(Lateness::default, |a, b| Lateness {
            ticks: a.ticks + b.ticks,
            most: a.most.max(b.most),
            excess: a.excess.max(b.excess),
        })
    }

    fn ride(&self, body: &Body, index: u32) -> Lateness {
        let mut random = Random::new(SEED ^ u64::from(index) << 8);
        let mut found = Lateness::default();
        let face = &body.faces()[random.below(body.faces().len())].patch;
        let [u, v] = [0, 1].map(|_| random.between(0.0, 1.0) as f32);
        let witness = Witness::at(face, u, v);
        let Some(normal) = witness.normal(face) else { return found };
        let (way, axis) = (random.direction().as_vec3(), random.direction().as_vec3());
        let along = (way - normal * way.dot(normal)).normalize_or_zero();
        // A curve of a quarter of the size at least.
        let step = self.speed / self.rate;
        let turn = axis * (random.between(0.0, 4.0) as f32 * step / body.size());
        let mut position = witness.surface.point + normal * self.distance;
        let mut state = body.start();
        for _ in 0..SETTLING {
            self.step(body, &mut state, position);
        }
        let (mut heading, mut late) = (along * step, 0);
        for _ in 0..(LENGTH * body.size() / step) as u32 {
            if state.contact != Contact::InFront {
                break;
            }
            position += heading;
            heading = (heading + turn.cross(heading)).normalize_or_zero() * step;
            self.step(body, &mut state, position);
            let nearest = body.locate(position).distance();
            if nearest > FAR * body.size() + self.distance {
                break;
            }
            let excess = state.witness.surface.point.distance(position) - nearest;
            late = if excess > TOO_LONG * nearest + ROUNDING * body.size() { late + 1 } else { 0 };
            if late > 0 {
                found.excess = found.excess.max(excess);
            }
            found.ticks += 1;
            found.most = found.most.max(late);
        }
        found
    }

    fn step(&self, body: &Body, state: &mut BodyWitness, position: Vec3) {
        body.step(&Controller::SecondOrder, state, Probe::at(position), 1.0 / self.rate);
    }
}
