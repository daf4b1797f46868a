//! The path of the race: over a whole body, in front of it, with the true answers.

use glam::DVec3;
use palpate::math::Vec3;
use palpate_bake::{NurbsPatch, Random};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::oracle::OraclePoint;

/// Distance of the probe from the body, metres.
pub const AHEAD: f64 = 4e-4;
/// Way of a tick: 0.3 m/s at 4 kHz, metres.
const STEP: f64 = 0.3 / 4_000.0;
/// Ticks after which the path makes for another place, reached or not.
const PATIENCE: usize = 700;
/// Part of the heading that turns towards that place in a tick.
const TURN: f64 = 0.02;
/// Patches whose distances differ by less than this part of it hold the same point.
const SAME: f64 = 1e-9;
/// Difference of distances that single precision does not tell, metres.
const TIE: f64 = 2e-8;
const SEED: u64 = 36;

/// A probe and the true answer.
#[derive(Clone, Debug)]
pub struct Row {
    /// As the target gets it, metres.
    pub probe: Vec3,
    /// Unit vectors from the closest points to the probe: along a valley there are two.
    pub normals: Vec<DVec3>,
    /// Distance, metres.
    pub gap: f64,
    /// The patch that holds the closest point.
    pub patch: usize,
}

/// Signed distance of a point by the oracle: that of the nearest patch, by its normal.
pub fn signed_distance(patches: &[NurbsPatch], oracle: &BodyOracle<'_>, at: DVec3) -> f64 {
    let (distance, height) = nearest(patches, oracle, at);
    if height < 0.0 { -distance } else { distance }
}

/// The distance, and the most that any of the patches with the closest point is below the point, relative to it.
fn nearest(patches: &[NurbsPatch], oracle: &BodyOracle<'_>, at: DVec3) -> (f64, f64) {
    let feet = oracle.nearest(at, SAME);
    let height = feet.iter().map(|(patch, foot)| {
        let inside = foot.parameters.map(|parameter| parameter + 1e-4 * (0.5 - parameter));
        let normal = OraclePoint::evaluate(&patches[*patch], inside[0], inside[1]).normal(patches[*patch].flip);
        (at - foot.point).normalize_or_zero().dot(normal)
    });
    (feet.first().map_or(0.0, |(_, foot)| foot.distance), height.fold(-1.0, f64::max))
}

/// A walk over the surface of constant distance, towards one random place of a patch after the other.
pub fn path(patches: &[NurbsPatch], oracle: &BodyOracle<'_>, ticks: usize) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let mut target = |index: usize| {
        // Each patch in turn, far ones after another.
        let patch = &patches[(index * 5 + index / patches.len()) % patches.len()];
        OraclePoint::evaluate(patch, random.between(0.1, 0.9), random.between(0.1, 0.9)).point
    };
    let start = OraclePoint::evaluate(&patches[0], 0.43, 0.47);
    let mut at = start.point + AHEAD * start.normal(patches[0].flip);
    let (mut towards, mut heading) = (target(1), start.tangent_u.normalize());
    let (mut count, mut since) = (1, 0);
    let mut rows = Vec::with_capacity(ticks);
    while rows.len() < ticks {
        let probe = at.as_vec3();
        let feet = oracle.nearest(probe.as_dvec3(), TIE);
        let Some((patch, foot)) = feet.first() else { break };
        let away = probe.as_dvec3() - foot.point;
        rows.push(Row {
            probe,
            normals: feet.iter().map(|(_, foot)| (probe.as_dvec3() - foot.point).normalize()).collect(),
            gap: away.length(),
            patch: *patch,
        });
        since += 1;
        if since > PATIENCE || at.distance(towards) < 10.0 * AHEAD {
            count += 1;
            (towards, since) = (target(count), 0);
        }
        let up = away.normalize();
        let along = |way: DVec3| (way - up * way.dot(up)).normalize_or_zero();
        heading = along(along(heading) + TURN * along(towards - at));
        let asked = at + STEP * heading;
        let foot = oracle.nearest(asked, 0.0).into_iter().next();
        let next = foot.map(|(_, foot)| foot.point + AHEAD * (asked - foot.point).normalize());
        // Round the rim of an open body lies its back: the path turns there.
        match next.filter(|next| nearest(patches, oracle, *next).1 > -1e-3) {
            Some(next) => at = next,
            None => {
                heading = -heading;
                count += 1;
                (towards, since) = (target(count), 0);
            }
        }
    }
    rows
}
