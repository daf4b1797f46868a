//! Scenes of the race: a patch and its queries, with the right answers.

use super::path;
use crate::{models, repository};
use anyhow::{Context as _, bail};
use glam::DVec3;
use palpate_bake::locator::PackedLists;
use palpate_bake::{BakedBody, BakedCoefficients, BakedPatch, LocatorTable, Model, NurbsPatch};
use palpate_truth::oracle::Oracle;
use palpate_truth::oracle::golden::{self, ClosestRow};
use std::fmt::{Display, Write as _};
use std::path::Path;

/// How queries hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Every query by itself.
    Cold,
    /// Successive servo ticks of one probe.
    Track,
}

impl Task {
    /// As the contestants' program calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cold => "cold",
            Self::Track => "track",
        }
    }
}

/// Minimum number of queries to count, where there are that many: enough for the 99th percentile, and counting one
/// takes milliseconds.
const COUNTED: usize = 2_000;

/// A query and its true distance, metres.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// `Q`.
    pub probe: DVec3,
    /// The distance to the closest point of the whole patch.
    pub distance: f64,
}

/// A patch with queries.
#[derive(Debug)]
pub struct Scene {
    /// The model's name.
    pub model: String,
    /// The task.
    pub task: Task,
    /// The patch, in double precision.
    pub patch: NurbsPatch,
    /// The queries, in order.
    pub queries: Vec<Query>,
    baked: BakedPatch,
    locator: LocatorTable,
}

impl Scene {
    /// All scenes of the race: cold and track, on Table I and on its convex companion.
    ///
    /// # Errors
    /// A file of the project that is missing or spoilt.
    ///
    /// The path has `rows` rows: the fewer, the faster the probe.
    pub fn all(rows: usize) -> anyhow::Result<Vec<Self>> {
        Ok(vec![
            Self::golden("table1", Task::Cold, "table1_near.csv")?,
            Self::golden("table1c", Task::Cold, "table1c_near.csv")?,
            Self::along_path("table1", rows)?,
            Self::golden("table1c", Task::Track, "table1c_track.csv")?,
        ])
    }

    /// Step between counted queries.
    pub fn stride(&self) -> usize {
        (self.queries.len() / COUNTED).max(1)
    }

    /// Title in tables: `table1 cold`.
    pub fn title(&self) -> String {
        format!("{} {}", self.model, self.task.name())
    }

    /// Queries and answers from a golden file of the tests; the model has the name of the file's first part.
    ///
    /// # Errors
    /// A file of the project that is missing or spoilt.
    pub fn golden(name: &str, task: Task, file: &str) -> anyhow::Result<Self> {
        let (model, patch, baked, locator) = read(name)?;
        let per_metre = model.unit.per_metre();
        let rows: Vec<ClosestRow> = golden::read(&repository::root()?.join("host-tests/truth/golden").join(file))?;
        let query = |row: &ClosestRow| Query { probe: row.query() / per_metre, distance: row.distance / per_metre };
        Ok(Self { model: name.to_owned(), task, patch, queries: rows.iter().map(query).collect(), baked, locator })
    }

    /// A smooth path, judged by the oracle.
    fn along_path(name: &str, rows: usize) -> anyhow::Result<Self> {
        let (_, patch, baked, locator) = read(name)?;
        let oracle = Oracle::new(&patch);
        let query = |probe| Query { probe, distance: oracle.closest(probe).distance };
        let queries = path::probes(&patch, rows).map(query).collect();
        Ok(Self { model: name.to_owned(), task: Task::Track, patch, queries, baked, locator })
    }

    /// The scene as the contestants' program reads it.
    ///
    /// # Errors
    /// A rational patch: Newton's method is written for polynomials here.
    pub fn to_text(&self) -> anyhow::Result<String> {
        let BakedCoefficients::Polynomial(coefficients) = &self.baked.coefficients else {
            bail!("{}: the race is for polynomial patches", self.model);
        };
        let second = self.baked.shape.second_derivatives;
        let third = self.baked.shape.third_derivatives;
        let mut text = String::new();
        let mut line = |key: &str, values: String| writeln!(text, "{key} {values}");
        line("degree", words(self.patch.degree))?;
        line("knots_u", words(&self.patch.knots[0]))?;
        line("knots_v", words(&self.patch.knots[1]))?;
        line("columns", self.patch.counts[1].to_string())?;
        line("points", words(self.patch.points.iter().flat_map(|point| point.to_array())))?;
        line("breaks_u", words(&self.baked.breaks[0]))?;
        line("breaks_v", words(&self.baked.breaks[1]))?;
        line("coefficients", words(coefficients.iter().flatten()))?;
        line("second_derivatives", words([second.uu, second.uv, second.vv]))?;
        line("third_derivatives", words([third.uuu, third.uuv, third.uvv, third.vvv]))?;
        line("jumps", words([third.jump_uu, third.jump_vv]))?;
        line("size", self.baked.size.to_string())?;
        line("cube", words(self.locator.corner.to_array().into_iter().chain([self.locator.side])))?;
        line("nodes", words(self.locator.nodes.iter().flatten()))?;
        let lists = PackedLists::of(&self.locator.entries);
        line("entries", lists.entries.to_string())?;
        line("bits", words([lists.entry_bits, lists.face_bits]))?;
        line("rectangles", words(&lists.rectangles))?;
        line("candidates", words(&lists.candidates))?;
        line("stride", self.stride().to_string())?;
        line("probes", words(self.queries.iter().flat_map(|query| query.probe.to_array())))?;
        Ok(text)
    }
}

fn read(name: &str) -> anyhow::Result<(Model, NurbsPatch, BakedPatch, LocatorTable)> {
    let model = models::read(Path::new(name))?;
    let patch = model.patches.first().with_context(|| format!("{name}: no patch"))?.clone();
    let baked = BakedPatch::without_shape(&patch).with_context(|| name.to_owned())?;
    let body = BakedBody::new(&model, name)?;
    let options = body.locator_options();
    let (body, _) = body.located(&options, &|_, _| ())?;
    Ok((model, patch, baked, body.locator))
}

/// Rust prints numbers with the fewest digits that give the same bits again.
fn words<T: Display>(values: impl IntoIterator<Item = T>) -> String {
    values.into_iter().map(|value| value.to_string()).collect::<Vec<_>>().join(" ")
}
