//! Tables from a build script: the model lies beside `Cargo.toml`, and the firmware always has the tables of its
//! present state.

use crate::body::{BakedBody, TableFault};
use crate::error::ModelError;
use crate::flaws;
use crate::locator::LocatorError;
use crate::model::Model;
use crate::source::{self, Origin, SourceError};
use palpate::body::{TickLimit, TickWork};
use std::path::{Path, PathBuf};
use std::{fmt, fs, io};
use thiserror::Error;

/// Bakes one model file in a `build.rs`.
///
/// ```no_run
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     palpate_bake::Bake::new("part.toml").write_to(std::env::var("OUT_DIR")?)?;
///     Ok(())
/// }
/// ```
///
/// The firmware takes the tables as a module, `part.rs` being named after `part.toml`:
///
/// ```ignore
/// mod part {
///     include!(concat!(env!("OUT_DIR"), "/part.rs"));
/// }
/// ```
///
/// `part::SURFACE` is what a `Servo` takes, and `part::CENTRE` says where its frame lies in the model. `palpate check
/// part.toml` says what is proved of it.
#[derive(Clone, Debug)]
pub struct Bake {
    model: PathBuf,
    margin: f64,
    tick_limit: TickLimit,
}

/// Why there are no tables. Says the same in debug form, which is how a `main` that returns it prints it.
#[derive(Error)]
pub enum BakeError {
    /// The model is refused.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A tick on the body may take more than the limit.
    #[error(
        "{file}: a tick may take {evaluations} evaluations and {cycles} modelled cycles, the limits are {} and {}: \
         merge faces that meet at a vertex, or lower the degree of the patches",
        limit.evaluations, limit.cycles
    )]
    Tick {
        /// The model file.
        file: String,
        /// Evaluations of the worst tick.
        evaluations: u32,
        /// Its modelled cycles.
        cycles: u32,
        /// The limit.
        limit: TickLimit,
    },
    /// The library refuses the tables.
    #[error("{file}: {cause}")]
    Tables {
        /// The model file.
        file: String,
        /// Why.
        cause: TableFault,
    },
    /// The locator does not come out.
    #[error("{file}: {cause}")]
    Locator {
        /// The model file.
        file: String,
        /// Why.
        cause: LocatorError,
    },
    /// A bug of the baker.
    #[error("{file}: {cause}")]
    Source {
        /// The model file.
        file: String,
        /// What it is.
        cause: SourceError,
    },
    /// The tables cannot be written.
    #[error("{file}: cannot be written: {cause}")]
    Write {
        /// The file.
        file: String,
        /// Why.
        cause: io::Error,
    },
}

impl fmt::Debug for BakeError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

impl Bake {
    /// Bakes this model file, whose path starts from the package's folder. Of a CAD part `palpate import` makes one.
    pub fn new(model: impl Into<PathBuf>) -> Self {
        Self { model: model.into(), margin: 0.0, tick_limit: TickLimit::BENCH }
    }

    /// How far beyond the bounding box of a body its locator reaches at least, in sizes of the body, 0 to 30; without
    /// this, as it suits the body.
    #[must_use]
    pub const fn reaching(mut self, sizes: f64) -> Self {
        self.margin = sizes.clamp(0.0, 30.0);
        self
    }

    /// The limit of a tick on the body; without this, that of the bench boards.
    #[must_use]
    pub const fn tick_limit(mut self, limit: TickLimit) -> Self {
        self.tick_limit = limit;
        self
    }

    /// Writes the tables as Rust source into a folder, under the model file's name with the ending `.rs`, and says
    /// where. Tells cargo to watch the model.
    ///
    /// # Errors
    /// What is wrong with the model, by file, patch and entry, as `palpate check` says it; or with the folder.
    pub fn write_to(&self, folder: impl AsRef<Path>) -> Result<PathBuf, BakeError> {
        // Also where it is refused: mended, it is to be tried again.
        println!("cargo::rerun-if-changed={}", self.model.display());
        let file = self.model.display().to_string();
        let read = |cause| ModelError::Read { file: file.clone(), cause };
        let text = fs::read_to_string(&self.model).map_err(read)?;
        let model = Model::parse(&text, &file)?;
        let mut body = BakedBody::new(&model, &file)?;
        let surfaces: Vec<_> = body.faces.iter().map(|face| face.surface.clone()).collect();
        let labels = body.labels(&model);
        for flaw in flaws::find(&surfaces, &body.topology) {
            let words = flaw.describe(&|index| labels[index].clone(), model.centre, model.unit);
            println!("cargo::warning={file}: {words}");
        }
        if body.faces.len() > 1 {
            let options = body.locator_options().reaching(self.margin);
            let located = body.located(&options, &|_, _| ());
            (body, _) = located.map_err(|cause| BakeError::Locator { file: file.clone(), cause })?;
        }
        let tables = body.to_body().map_err(|cause| BakeError::Tables { file: file.clone(), cause })?;
        let limit = self.tick_limit;
        let tables = tables.fitted(limit);
        if !tables.fits(limit) {
            let (evaluations, cycles) = (tables.worst_tick(TickWork::EACH).cost, tables.worst_cycles());
            return Err(BakeError::Tick { file, evaluations, cycles, limit });
        }
        let name = self.model.file_name().unwrap_or(self.model.as_os_str());
        let out = folder.as_ref().join(name).with_extension("rs");
        let out_file = Path::new(name).with_extension("rs");
        let origin = Origin {
            model_file: &name.to_string_lossy(),
            out_file: &out_file.to_string_lossy(),
            model: text.as_bytes(),
            centre: model.centre,
            limit,
        };
        let source = source::source(&origin, &model, &body).map_err(|cause| BakeError::Source { file, cause })?;
        fs::write(&out, source).map_err(|cause| BakeError::Write { file: out.display().to_string(), cause })?;
        Ok(out)
    }
}
