//! palpate: the library as the firmware has it. To enter another cold start, change [`cold`].

use crate::contestant::{Answer, Contestant, Probe};
use crate::scene::Scene;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::track::{self, Controller, Witness};

/// The host tool's solver, the very file.
#[path = "../../src/closest.rs"]
#[allow(dead_code)]
mod closest;

/// Every query by itself.
pub fn cold(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Cold { patches: [scene.patch] }))
}

/// One step of the certified controller a query, as in a servo tick; the start is cold.
pub fn track(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Track { patch: scene.patch, witness: start(scene) }))
}

/// The closest point of the first probe: all that track start there.
pub fn start(scene: &Scene) -> Witness {
    let first = scene.probes.first().map_or(Vec3::ZERO, |probe| Vec3::from_array(probe.single));
    let found = closest::Solver::new(&[scene.patch]).cold(first);
    found.map_or_else(|| Witness::at(&scene.patch, 0.5, 0.5), |found| found.witness)
}

struct Cold {
    patches: [SplinePatch; 1],
}

impl Contestant for Cold {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let found = closest::Solver::new(&self.patches).cold(Vec3::from_array(probe.single));
        found.map_or(Answer::Nothing, |found| point(&found.witness))
    }
}

struct Track {
    patch: SplinePatch,
    witness: Witness,
}

impl Contestant for Track {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let probe = track::Probe::at(Vec3::from_array(probe.single));
        // The gain is certified, not a rate: the period does not matter.
        Controller::CERTIFIED.step(&self.patch, &mut self.witness, probe, 1.0);
        point(&self.witness)
    }
}

fn point(witness: &Witness) -> Answer {
    Answer::Point(witness.surface.point.to_array().map(f64::from))
}
