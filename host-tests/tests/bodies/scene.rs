//! A model with its tables, and probes around it.

use glam::DVec3;
use palpate::body::{Body, Feature, Side};
use palpate::math::Vec3;
use palpate_host::bake::topology::bounding_box;
use palpate_host::bake::{BakedBody, Model, NurbsPatch};
use palpate_host::bodies::{BodyOracle, Truth};
use palpate_host::generate::Random;
use std::path::Path;

pub struct Scene {
    pub patches: Vec<NurbsPatch>,
    pub body: Body,
    pub low: DVec3,
    pub high: DVec3,
}

/// Probes a test: `PALPATE_PROBES` for long runs.
pub fn probes() -> u32 {
    std::env::var("PALPATE_PROBES").ok().and_then(|count| count.parse().ok()).unwrap_or(5_000)
}

impl Scene {
    pub fn load(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(format!("{name}.toml"));
        let model = Model::read(&path).unwrap();
        let baked = BakedBody::new(&model, name).unwrap();
        let options = baked.locator_options();
        let (baked, report) = baked.located(&options, &|_, _| ()).unwrap();
        println!("{name}: {report}");
        let patches: Vec<_> = baked.faces.iter().map(|face| face.surface.clone()).collect();
        let (low, high) = bounding_box(&patches);
        Self { patches, body: baked.to_body().unwrap(), low, high }
    }

    pub fn oracle(&self) -> BodyOracle<'_> {
        BodyOracle::new(&self.patches)
    }

    /// Seeded probes in a box around the body, half its size larger on every side.
    pub fn around(&self, count: u32, seed: u64) -> impl Iterator<Item = Vec3> {
        let mut random = Random::new(seed);
        let margin = 0.5 * (self.high - self.low).max_element();
        let (low, span) = (self.low - margin, self.high - self.low + 2.0 * margin);
        std::iter::repeat_with(move || {
            low + span * DVec3::from_array(std::array::from_fn(|_| random.between(0.0, 1.0)))
        })
        .map(|probe| probe.as_vec3())
        .take(count as usize)
    }

    /// Those of a closed convex body that are outside.
    pub fn outside(&self, count: u32, seed: u64) -> impl Iterator<Item = Vec3> {
        let oracle = self.oracle();
        let all = self.around(u32::MAX, seed).filter(move |probe| !oracle.closest(probe.as_dvec3()).is_inside_convex());
        all.take(count as usize)
    }

    /// The features on which the closest point lies: one, or more where it is within `end` of a border.
    pub fn owner(&self, truth: &Truth, end: f64) -> Vec<Feature> {
        let mut owners = Vec::new();
        let least = truth.distance();
        for (index, foot) in truth.feet.iter().enumerate() {
            if foot.distance - least > end * f64::from(self.body.size()) {
                continue;
            }
            let [u, v] = foot.parameters;
            let sides = self.body.faces()[index].sides;
            let at = [u <= end, u >= 1.0 - end, v <= end, v >= 1.0 - end];
            if at == [false; 4] {
                owners.push(Feature::Face(index as u16));
            }
            for (side, _) in sides.iter().zip(at).filter(|(_, at)| *at) {
                match side {
                    Side::Pole { vertex } => owners.push(Feature::Vertex(*vertex)),
                    Side::Edge { edge, .. } => {
                        owners.push(Feature::Edge(*edge));
                        owners.extend(self.body.edges()[usize::from(*edge)].ends.map(Feature::Vertex));
                    }
                }
            }
        }
        owners
    }
}
