//! A closed way around a body, a little in front of its surface.

use glam::DVec3;
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::generate::Random;
use std::f64::consts::TAU;

/// Directions from the centre.
const NODES: u32 = 720;
/// Every ray begins this far out, metres.
const FAR: f64 = 1.0;
/// Steps towards the surface: where the ray grazes it they shrink.
const STEPS: u32 = 200;

/// The way, as a polygon.
pub struct Ring(Vec<DVec3>);

impl Ring {
    /// In a plane through a centre, which is inside: from far out along each ray until the surface is as near as the
    /// gap, metres.
    pub fn around(oracle: &BodyOracle<'_>, centre: DVec3, seed: u64, gap: f64) -> Self {
        let [across, along, _] = Random::new(seed).axes();
        let node = |index: u32| {
            let (sine, cosine) = (TAU * f64::from(index) / f64::from(NODES)).sin_cos();
            let ray = across * cosine + along * sine;
            let mut reach = FAR;
            for _ in 0..STEPS {
                let left = oracle.nearest(centre + ray * reach, 0.0)[0].1.distance - gap;
                reach -= left;
                // A hundredth of a row's step.
                if left < 1e-7 || reach <= 0.0 {
                    break;
                }
            }
            centre + ray * reach.max(0.0)
        };
        Self((0..NODES).map(node).collect())
    }

    /// Points this far apart along the way, metres, once round.
    pub fn rows(&self, stride: f64) -> impl Iterator<Item = DVec3> {
        let next = |index: usize| self.0[(index + 1) % self.0.len()];
        let mut rows = Vec::new();
        let mut ahead = 0.0;
        for (index, from) in self.0.iter().enumerate() {
            let (to, length) = (next(index), from.distance(next(index)));
            while ahead < length {
                rows.push(from.lerp(to, ahead / length));
                ahead += stride;
            }
            ahead -= length;
        }
        rows.into_iter()
    }
}
