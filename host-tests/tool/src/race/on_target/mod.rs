//! The race on the target: palpate and what a firmware engineer would write instead, on whole bodies, counted
//! instruction by instruction on an emulated core.

mod grid;
mod judge;
mod mesh;
mod path;

pub use grid::Samples;
pub use judge::{MISS, STIFFNESS, Score};
pub use mesh::Triangles;
pub use path::{AHEAD, Row};
use path::{path, signed_distance};

use super::table::grouped;
use crate::cycles::{Core, Root, estimate};
use crate::firmware::{Board, Pace, Program, Progress};
use crate::models::ModelFile;
use crate::spread::Spread;
use anyhow::Context as _;
use glam::DVec3;
use palpate::body::Body;
use palpate_bake::body::BodyBytes;
use palpate_bake::{BakedBody, Model};
use palpate_rivals::Contestant;
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::generate::bodies;
use palpate_truth::oracle::OraclePoint;
use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Flash that a grid or a mesh is comfortable in, bytes.
const COMFORTABLE: usize = 512 * 1024;
/// Ticks of the program in which palpate finds its start.
const SETTLING: usize = 500;
/// Ticks whose cycles are modelled.
const FOLLOWED: usize = 1_000;
/// Places along each parameter of a patch for the box around the body.
const PLACES: usize = 65;
/// Around the body, metres: the probe, and a little.
const AROUND: f64 = 1.5 * AHEAD;

/// A body of the race.
#[derive(Debug)]
pub struct Course {
    /// Its name.
    pub name: String,
    model: Model,
    body: BakedBody,
    file: Vec<u8>,
    /// Bytes of its tables in flash.
    pub flash: usize,
}

/// A contestant and its table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its kind.
    pub contestant: Contestant,
    /// Its words in flash.
    pub table: Vec<u32>,
    /// Bytes of these that it needs.
    pub flash: usize,
}

/// The names of the bodies: smooth, sharp, and not convex.
pub const COURSES: [&str; 6] = ["ellipsoid_body", "rounded_cylinder", "capped_box", "knob", "pocket", "teapot"];

impl Course {
    /// A model that ships, or one of the drawn bodies.
    ///
    /// # Errors
    /// A name that is neither.
    pub fn new(name: &str, progress: &Progress) -> anyhow::Result<Self> {
        let drawn = bodies::ten().into_iter().find(|body| body.name == name);
        let file = match drawn {
            Some(drawn) => ModelFile::imported(Path::new(name), drawn.text),
            None => ModelFile::read(Path::new(name))?,
        };
        let model = file.model()?;
        let body = file.body(&model)?;
        let options = body.locator_options();
        let body = progress.during(&format!("baking {name}"), || file.located(body, &options, None, &|_, _| ()))?;
        let bytes = palpate_bake::file::write(file.digest(), &model, &body)?;
        let flash = BodyBytes::of(&body).total();
        Ok(Self { name: name.to_owned(), model, body, file: bytes, flash })
    }

    /// The oracle.
    pub fn oracle(&self) -> BodyOracle<'_> {
        BodyOracle::new(&self.model.patches)
    }

    /// The path with its truth.
    pub fn path(&self, ticks: usize) -> Vec<Row> {
        path(&self.model.patches, &self.oracle(), ticks)
    }

    /// The size that errors are relative to, metres.
    pub fn size(&self) -> f64 {
        f64::from(self.body.size)
    }

    /// The tables that palpate and Newton's method run on.
    ///
    /// # Errors
    /// Faulty tables.
    pub fn tables(&self) -> anyhow::Result<Body<'static>> {
        Ok(self.body.to_body()?)
    }

    /// Samples of the distance that these bytes hold.
    pub fn samples(&self, flash: usize) -> Samples {
        let places = |patch| {
            (0..PLACES * PLACES).map(move |index| {
                let [u, v] = [index / PLACES, index % PLACES].map(|place| place as f64 / (PLACES - 1) as f64);
                OraclePoint::evaluate(patch, u, v).point
            })
        };
        let points = || self.model.patches.iter().flat_map(places);
        let low = points().fold(DVec3::INFINITY, DVec3::min);
        let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let oracle = self.oracle();
        Samples::new(flash, [low - AROUND, high + AROUND], |at| signed_distance(&self.model.patches, &oracle, at))
    }

    /// The triangles that these bytes hold.
    pub fn triangles(&self, flash: usize, shaded: bool) -> Triangles {
        Triangles::new(&self.body, flash, shaded)
    }

    /// palpate and Newton's method.
    pub fn own(&self) -> Vec<Entry> {
        let table: Vec<u32> = self.file.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        [Contestant::Palpate, Contestant::PalpateOne, Contestant::Newton]
            .map(|contestant| Entry { contestant, table: table.clone(), flash: self.flash })
            .into()
    }

    /// The others, with this much flash.
    pub fn rivals(&self, flash: usize) -> Vec<Entry> {
        let samples = self.samples(flash);
        [
            (Contestant::Tricubic, samples.cubic()),
            (Contestant::Trilinear, samples.linear()),
            (Contestant::Facets, self.triangles(flash, false).words()),
            (Contestant::Shaded, self.triangles(flash, true).words()),
        ]
        .map(|(contestant, table)| Entry { contestant, flash: 4 * table.len(), table })
        .into()
    }
}

/// The program of the race on an emulated board.
#[derive(Debug)]
pub struct Target(Program);

impl Target {
    /// Builds it.
    ///
    /// # Errors
    /// Missing tools or an error of the compiler.
    pub fn build(board: Board, progress: &Progress) -> anyhow::Result<Self> {
        Ok(Self(Program::prepare(board, "race", &["race"], progress)?))
    }

    /// Runs a contestant over a path.
    ///
    /// # Errors
    /// The program's output, if it failed.
    pub fn run(&self, course: &Course, rows: &[Row], entry: &Entry) -> anyhow::Result<Score> {
        let head = [entry.contestant as u32, rows.len() as u32, entry.table.len() as u32];
        let probes = rows.iter().flat_map(|row| row.probe.to_array()).map(f32::to_bits);
        let words = head.into_iter().chain(entry.table.iter().copied()).chain(probes);
        let folder = self.0.folder();
        fs::write(folder.join("race.in"), words.flat_map(u32::to_le_bytes).collect::<Vec<u8>>())?;
        self.0.run(Pace::Counting)?;
        let answers = judge::read(&fs::read(folder.join("race.out"))?);
        judge::score(rows, &answers, course.size()).with_context(|| format!("{:?}", entry.contestant))
    }

    /// Modelled cycles of the first ticks that [`Self::run`] has run last, at the lower and the upper end of the range.
    ///
    /// # Errors
    /// A program that cannot be followed.
    pub fn cycles(&self, entry: &Entry) -> anyhow::Result<[Vec<u32>; 2]> {
        let (function, skip) = match entry.contestant {
            Contestant::Palpate | Contestant::PalpateOne => ("palpate_emulated::race::palpate", SETTLING),
            Contestant::Newton => ("palpate_emulated::race::newton", 0),
            Contestant::Tricubic => ("palpate_emulated::race::tricubic", 0),
            Contestant::Trilinear => ("palpate_emulated::race::trilinear", 0),
            Contestant::Facets => ("palpate_emulated::race::facets", 0),
            Contestant::Shaded => ("palpate_emulated::race::shaded", 0),
        };
        let root = Root { function, title: "", skip, take: FOLLOWED };
        let found = estimate(&self.0, Core::M4, &[root])?;
        Ok(found.into_iter().next().map(|(_, calls)| calls.cycles).unwrap_or_default())
    }
}

/// Races all on a body, as a table.
///
/// # Errors
/// The program's output, if it failed.
pub fn race(target: &Target, name: &str, ticks: usize, progress: &Progress) -> anyhow::Result<String> {
    let course = Course::new(name, progress)?;
    let mut entries = course.own();
    for flash in [course.flash, COMFORTABLE] {
        let what = format!("sampling {} KB of {name}", flash / 1024);
        entries.extend(progress.during(&what, || course.rivals(flash)));
    }
    let rows = progress.during(&format!("the path over {name}"), || course.path(ticks));
    let met = rows.iter().map(|row| row.patch).collect::<HashSet<usize>>().len();
    let patches = course.model.patches.len();
    let mut text = format!("{name}, {} ticks, {met} of {patches} patches\n", grouped(rows.len() as u64));
    let _ = writeln!(
        text,
        "  {:<28}{:>8}{:>8}{:>7}{:>8}{:>9}{:>9}{:>8}{:>8}{:>8}",
        "", "flash", "instr.", "worst", "cycles", "error", "99 %", "misses", "normal", "step"
    );
    for entry in &entries {
        let what = format!("{name}: {}", described(entry.contestant));
        let (score, [_, cycles]) = progress
            .during(&what, || anyhow::Ok((target.run(&course, &rows, entry)?, target.cycles(entry)?)))
            .with_context(|| what.clone())?;
        let _ = writeln!(
            text,
            "  {:<28}{:>8}{:>8}{:>7}{:>8}{:>9.1e}{:>9.1e}{:>8}{:>8}{:>8}",
            described(entry.contestant),
            grouped(entry.flash as u64),
            grouped(score.instructions.median.into()),
            grouped(score.instructions.worst.into()),
            grouped(Spread::of(&cycles).map_or(0, |cycles| cycles.median).into()),
            score.distance.worst,
            score.distance.most,
            score.misses,
            short(score.normal),
            short(1e3 * score.false_step),
        );
    }
    Ok(text)
}

fn described(contestant: Contestant) -> &'static str {
    match contestant {
        Contestant::Palpate => "palpate, default effort",
        Contestant::PalpateOne => "palpate, effort 1,1",
        Contestant::Newton => "Newton, two steps",
        Contestant::Tricubic => "tricubic distance grid",
        Contestant::Trilinear => "trilinear distance grid",
        Contestant::Facets => "triangle walk, facets",
        Contestant::Shaded => "triangle walk, force shading",
    }
}

/// Two digits that count.
fn short(value: f64) -> String {
    if value >= 10.0 {
        format!("{value:.0}")
    } else if value >= 1.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.3}")
    }
}
