//! A model with its tables, and probes around it.

use glam::DVec3;
use palpate::body::{Body, Feature, Side};
use palpate::math::Vec3;
use palpate_bake::body::{BodyBytes, LocatorTable};
use palpate_bake::locator::LocatorOptions;
use palpate_bake::topology::bounding_box;
use palpate_bake::{BakedBody, Model, NurbsPatch};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::generate::Random;
use palpate_truth::measured::{grouped, measured};
use palpate_truth::oracle::{ClosestPoint, OraclePoint};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

pub struct Scene {
    pub name: &'static str,
    pub patches: Vec<NurbsPatch>,
    pub body: Body<'static>,
    pub locator: LocatorTable,
    pub low: DVec3,
    pub high: DVec3,
    /// Of its tables in flash.
    bytes: usize,
}

/// Probes a test: `PALPATE_PROBES` for long runs.
pub fn probes() -> u32 {
    from_environment("PALPATE_PROBES", 5_000)
}

pub fn from_environment(name: &str, default: u32) -> u32 {
    std::env::var(name).ok().and_then(|count| count.parse().ok()).unwrap_or(default)
}

/// Probes that share a source of numbers: results do not hang on the number of cores.
const CHUNK: u32 = 500;

/// `work` so many times, on all cores; each is given the source of its chunk.
pub fn repeat<R: Send>(count: u32, seed: u64, work: impl Fn(&mut Random) -> R + Sync) -> Vec<R> {
    let chunk = |index: u32| {
        let mut random = Random::new((seed << 32) + u64::from(index));
        (0..CHUNK.min(count - index * CHUNK)).map(|_| work(&mut random)).collect::<Vec<_>>()
    };
    (0..count.div_ceil(CHUNK)).into_par_iter().flat_map_iter(chunk).collect()
}

impl Scene {
    /// The model with the locator that suits it, baked once for all tests.
    pub fn load(name: &'static str) -> &'static Self {
        static SCENES: Mutex<BTreeMap<&str, &OnceLock<Scene>>> = Mutex::new(BTreeMap::new());
        let scene: &'static OnceLock<Self> =
            SCENES.lock().unwrap().entry(name).or_insert_with(|| Box::leak(Box::new(OnceLock::new())));
        scene.get_or_init(|| {
            let scene = Self::located(name, BakedBody::locator_options);
            measured(&format!("flash of the tables of `{name}`"), grouped(scene.bytes as u64));
            scene
        })
    }

    pub fn located(name: &'static str, options: impl Fn(&BakedBody) -> LocatorOptions) -> Self {
        Self::of_model(name, &palpate_suites::model(name), options)
    }

    /// A model as text, with the locator that suits it.
    pub fn parsed(name: &'static str, text: &str) -> Self {
        Self::of_model(name, &Model::parse(text, name).unwrap(), BakedBody::locator_options)
    }

    fn of_model(name: &'static str, model: &Model, options: impl Fn(&BakedBody) -> LocatorOptions) -> Self {
        let baked = BakedBody::new(model, name).unwrap();
        let options = options(&baked);
        let (baked, report) = baked.located(&options, &|_, _| ()).unwrap();
        println!("{name}: {report}");
        Self::of(name, &baked)
    }

    /// A body that is baked.
    pub fn of(name: &'static str, baked: &BakedBody) -> Self {
        let patches: Vec<_> = baked.faces.iter().map(|face| face.surface.clone()).collect();
        let (low, high) = bounding_box(&patches);
        let bytes = BodyBytes::of(baked).total();
        Self { name, patches, body: baked.to_body().unwrap(), locator: baked.locator.clone(), low, high, bytes }
    }

    pub fn oracle(&self) -> BodyOracle<'_> {
        BodyOracle::new(&self.patches)
    }

    pub fn size(&self) -> f64 {
        f64::from(self.body.size())
    }

    /// A probe in a box around the body, half its size larger on every side.
    pub fn around(&self, random: &mut Random) -> Vec3 {
        let margin = 0.5 * (self.high - self.low).max_element();
        let (low, span) = (self.low - margin, self.high - self.low + 2.0 * margin);
        (low + span * DVec3::from_array(std::array::from_fn(|_| random.between(0.0, 1.0)))).as_vec3()
    }

    /// The first probe around a closed convex body that is outside, with the points of all patches that are nearest to
    /// `within` metres.
    pub fn outside(
        &self,
        oracle: &BodyOracle<'_>,
        random: &mut Random,
        within: f64,
    ) -> (Vec3, Vec<(usize, ClosestPoint)>) {
        loop {
            let probe = self.around(random);
            let nearest = oracle.nearest(probe.as_dvec3(), within);
            if !oracle.is_inside_convex(nearest[0].0, probe.as_dvec3()) {
                return (probe, nearest);
            }
        }
    }

    /// A probe anywhere inside a closed convex body.
    pub fn inside(&self, oracle: &BodyOracle<'_>, random: &mut Random) -> Vec3 {
        loop {
            let probe = self.around(random);
            if oracle.is_inside_convex(oracle.nearest(probe.as_dvec3(), 0.0)[0].0, probe.as_dvec3()) {
                return probe;
            }
        }
    }

    /// A probe up to a fifth of the size behind the surface, along the normal at a random place.
    pub fn behind(&self, random: &mut Random) -> Vec3 {
        let patch = &self.patches[random.below(self.patches.len())];
        let surface = OraclePoint::evaluate(patch, random.between(0.0, 1.0), random.between(0.0, 1.0));
        let normal = surface.normal(patch.flip);
        let depth = 0.2 * self.size() * random.between(0.0, 1.0);
        (surface.point - if normal.is_finite() { normal } else { DVec3::ZERO } * depth).as_vec3()
    }

    /// The features on which the nearest points lie: one, or a face and what is beside it where a point is within `end`
    /// of its border.
    pub fn owners(&self, nearest: &[(usize, ClosestPoint)], end: f64) -> Vec<Feature> {
        let mut owners = Vec::new();
        for (index, foot) in nearest {
            let [u, v] = foot.parameters;
            let sides = self.body.faces()[*index].sides;
            let at = [u <= end, u >= 1.0 - end, v <= end, v >= 1.0 - end];
            if foot.parameters.iter().all(|parameter| 0.0 < *parameter && *parameter < 1.0) {
                owners.push(Feature::Face(*index as u16));
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
