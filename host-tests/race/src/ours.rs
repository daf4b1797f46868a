//! palpate: the library as the firmware has it. To enter another cold start, change [`cold`].
//!
//! It answers with parameters, as Newton's methods do, so that all are judged alike. The point and both tangents there,
//! which a force needs, are evaluated while tracking, and in the count.

use crate::contestant::{Answer, Contestant};
use crate::scene::{Probe, Scene};
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate::track::{self, Controller, Descent, FirstOrder, Outcome, ProjectionErrors, Witness};

/// Settled when a step to first order would lower the distance by no more than this, in sizes of the patch: a
/// twentieth of what single precision resolves.
const SETTLED: f32 = 3e-9;
/// Steps of one row of a track at most: as many as Newton's method has.
const STEPS: usize = 8;

/// Every query by itself.
pub fn cold(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Cold(Body<'static>);
    impl Contestant for Cold {
        fn answer(&mut self, probe: &Probe) -> Answer {
            parameters(self.0.locate(Vec3::from_array(probe.single)).parameters)
        }
    }
    Ok(Box::new(Cold(scene.body)))
}

/// One step of the default controller a query, as in a servo tick; the start is cold.
pub fn track(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Track(SplinePatch<'static>, Witness);
    impl Contestant for Track {
        fn answer(&mut self, probe: &Probe) -> Answer {
            // The gain is certified, not a rate: the period does not matter.
            Controller::SecondOrder.step(&self.0, &mut self.1, at(probe), 1.0);
            parameters(self.1.parameters)
        }
    }
    Ok(Box::new(Track(scene.patch, start(scene))))
}

/// The same until it has settled.
pub fn track_settled(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Track(SplinePatch<'static>, Witness);
    impl Contestant for Track {
        fn answer(&mut self, probe: &Probe) -> Answer {
            for _ in 0..STEPS {
                let step = Controller::SecondOrder.step(&self.0, &mut self.1, at(probe), 1.0);
                if step.outcome != Outcome::Moved || has_settled(&self.1, at(probe).position, self.0.size()) {
                    break;
                }
            }
            parameters(self.1.parameters)
        }
    }
    Ok(Box::new(Track(scene.patch, start(scene))))
}

/// One step of the paper's law a query.
pub fn track_to_first_order(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    struct Track(SplinePatch<'static>, Witness);
    impl Contestant for Track {
        fn answer(&mut self, probe: &Probe) -> Answer {
            Controller::FirstOrder(FirstOrder::CERTIFIED).step(&self.0, &mut self.1, at(probe), 1.0);
            parameters(self.1.parameters)
        }
    }
    Ok(Box::new(Track(scene.patch, start(scene))))
}

/// The closest point of the first probe: all that track start there.
pub fn start(scene: &Scene) -> Witness {
    let first = scene.probes.first().map_or(Vec3::ZERO, |probe| Vec3::from_array(probe.single));
    let [u, v] = scene.body.locate(first).parameters;
    Witness::at(&scene.patch, u, v)
}

/// With the slope `s` of what the law of first order would do, the distance `R` falls by about `s / 2R`.
#[inline]
fn has_settled(witness: &Witness, probe: Vec3, size: f32) -> bool {
    let errors = ProjectionErrors::new(&witness.surface, probe);
    let slope = Descent::of(&errors, witness).slope;
    let resolved = 2.0 * SETTLED * size;
    slope * slope <= resolved * resolved * errors.difference.length_squared()
}

fn at(probe: &Probe) -> track::Probe {
    track::Probe::at(Vec3::from_array(probe.single))
}

fn parameters(parameters: [f32; 2]) -> Answer {
    Answer::Parameters(parameters.map(f64::from))
}
