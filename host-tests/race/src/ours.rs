//! palpate: the library as the firmware has it. To enter another cold start, change [`cold`].

use crate::contestant::{Answer, Contestant, Probe};
use crate::scene::Scene;
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::track::{self, Controller, Witness};

/// Every query by itself.
pub fn cold(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Cold { body: scene.body }))
}

/// One step of the certified controller a query, as in a servo tick; the start is cold.
pub fn track(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    Ok(Box::new(Track { patch: scene.patch, witness: start(scene) }))
}

/// The closest point of the first probe: all that track start there.
pub fn start(scene: &Scene) -> Witness {
    let first = scene.probes.first().map_or(Vec3::ZERO, |probe| Vec3::from_array(probe.single));
    let [u, v] = scene.body.locate(first).parameters;
    Witness::at(&scene.patch, u, v)
}

struct Cold {
    body: Body,
}

impl Contestant for Cold {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let located = self.body.locate(Vec3::from_array(probe.single));
        let Some(face) = self.body.faces().get(usize::from(located.face)) else { return Answer::Nothing };
        let [u, v] = located.parameters;
        point(&Witness::at(&face.patch, u, v))
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
