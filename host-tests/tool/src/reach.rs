//! Tables for queries: those that ship, and others for queries beyond their reach.

use glam::DVec3;
use palpate::body::{Body, Effort};
use palpate::math::Vec3;
use palpate_bake::BakedBody;
use palpate_bake::body::TableFault;
use palpate_bake::locator::LocatorOptions;
use palpate_truth::closest::Solver;

/// A body's tables, and what the firmware has of them.
#[derive(Debug)]
struct Tables {
    baked: BakedBody,
    body: Body<'static>,
}

impl Tables {
    fn new(baked: BakedBody) -> Result<Self, TableFault> {
        Ok(Self { body: baked.to_body()?, baked })
    }

    fn solver(&self) -> Solver<'_> {
        Solver::new(&self.body, &self.baked)
    }
}

/// The tables that ship, and where some queries lie beyond their reach, others that reach so far.
#[derive(Debug)]
pub struct Reach {
    shipped: Tables,
    far: Option<Tables>,
    /// Queries beyond the reach of the tables that ship.
    pub queries_beyond: usize,
    /// The margin that reaches all queries, in sizes: `bake --margin`.
    pub margin: f64,
}

impl Reach {
    /// For these probes, metres. `shipped` has its locator; `bake_far` bakes one by other options that is good for the
    /// probes it is given.
    ///
    /// # Errors
    /// Tables that would not fit their indices.
    pub fn new(
        shipped: BakedBody,
        probes: &[Vec3],
        bake_far: impl FnOnce(BakedBody, &LocatorOptions, &[DVec3]) -> anyhow::Result<BakedBody>,
    ) -> anyhow::Result<Self> {
        let shipped = Tables::new(shipped)?;
        let probes: Vec<DVec3> = probes.iter().map(|probe| probe.as_dvec3()).collect();
        let is_far = |probe: &DVec3| !shipped.body.locator().holds(probe.as_vec3());
        let queries_beyond = probes.iter().filter(|probe| is_far(probe)).count();
        let margin = shipped.baked.sizes_beyond(&probes);
        let far = if queries_beyond > 0 {
            let options = shipped.baked.locator_options().reaching(margin);
            Some(Tables::new(bake_far(shipped.baked.clone(), &options, &probes)?)?)
        } else {
            None
        };
        Ok(Self { shipped, far, queries_beyond, margin })
    }

    /// The same at another effort in a tick.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        for tables in self.far.iter_mut().chain([&mut self.shipped]) {
            tables.body = tables.body.with_effort(effort);
        }
        self
    }

    /// The solvers of the queries.
    pub fn solvers(&self) -> Solvers<'_> {
        let far = self.far.as_ref().map(Tables::solver);
        Solvers { reach: self, shipped: self.shipped.solver(), far }
    }
}

/// Solvers of queries.
#[derive(Debug)]
pub struct Solvers<'a> {
    reach: &'a Reach,
    shipped: Solver<'a>,
    far: Option<Solver<'a>>,
}

impl<'a> Solvers<'a> {
    /// For a probe by itself, metres: the tables that ship, unless it lies beyond their reach.
    pub fn of(&self, probe: Vec3) -> &Solver<'a> {
        let far = self.far.as_ref().filter(|_| !self.reach.shipped.body.locator().holds(probe));
        far.unwrap_or(&self.shipped)
    }

    /// For a track: the same all the way.
    pub fn of_all(&self) -> &Solver<'a> {
        self.far.as_ref().unwrap_or(&self.shipped)
    }
}
