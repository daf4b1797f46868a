//! The source of a body: a file of any kind, a model that ships, or patches from Python.

use crate::refusal::Refusal;
use palpate_bake::file::BakedFile;
use palpate_bake::{BakedBody, Model};
use palpate_cad::Options;
use sha2::{Digest as _, Sha256};
use std::borrow::Cow;
use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

/// The models that ship, as text, by name.
const SHIPPED: &[(&str, &str)] = &include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// The source of a body, read.
pub enum Source {
    /// The text of a model file, and what messages call it.
    Text(Cow<'static, str>, String),
    /// Tables with their locator.
    Tables(Box<BakedFile>, Vec<u8>),
}

/// A body's tables with all that is known of it.
pub struct Made {
    /// The model, as far as it is known.
    pub model: Model,
    /// Its tables.
    pub baked: BakedBody,
    /// Its file.
    pub bytes: Vec<u8>,
}

/// Reads a model file, a STEP part (made into patches within `tolerance`, m), a body's file, or where there is no file
/// of this name a model that ships.
///
/// # Errors
/// No such file, or a fault of it.
pub fn of_file(path: &Path, tolerance: f64) -> Result<Source, Refusal> {
    let label = path.display().to_string();
    if let Some((_, text)) = SHIPPED.iter().find(|(name, _)| path.as_os_str() == *name)
        && !path.is_file()
    {
        return Ok(Source::Text(Cow::Borrowed(text), label));
    }
    let is =
        |known: &[&str]| path.extension().is_some_and(|is| known.iter().any(|known| is.eq_ignore_ascii_case(known)));
    if is(&["palp"]) {
        return of_baked(path);
    }
    // Opened first: what the operating system refuses is its own kind of error.
    let bytes = fs::read(path).map_err(|cause| Refusal::Path(label.clone(), cause))?;
    if is(&["step", "stp"]) {
        return Ok(Source::Text(Cow::Owned(of_part(path, tolerance)?), label));
    }
    let text = String::from_utf8(bytes).map_err(|_| Refusal::Model(format!("{label}: is not text in UTF-8")))?;
    Ok(Source::Text(Cow::Owned(text), label))
}

/// Reads a body's file, with everything in it checked.
///
/// # Errors
/// No such file, or a fault of it.
pub fn of_baked(path: &Path) -> Result<Source, Refusal> {
    let label = path.display().to_string();
    let bytes = fs::read(path).map_err(|cause| Refusal::Path(label.clone(), cause))?;
    let file = BakedFile::read(&bytes).map_err(|fault| Refusal::File(format!("{label}: {fault}")))?;
    Ok(Source::Tables(Box::new(file), bytes))
}

/// The text of a model file made of a part.
fn of_part(path: &Path, tolerance: f64) -> Result<String, Refusal> {
    if !(1e-9..=1.0).contains(&tolerance) {
        return Err(Refusal::Model(format!("a tolerance of {tolerance} m is not between 1e-9 and 1 m")));
    }
    let options = Options { tolerance: tolerance * 1e3, ..Options::default() };
    // What a file makes the reader do wrong is its fault, not Python's.
    match catch_unwind(|| palpate_cad::import(path, &options)) {
        Ok(Ok(imported)) => Ok(imported.model),
        Ok(Err(error)) => Err(Refusal::Model(error.to_string())),
        Err(_) => Err(Refusal::Model(format!("{}: the importer failed on this part", path.display()))),
    }
}

impl Source {
    /// Bakes it, if it is not baked already, with a locator that reaches `margin` sizes beyond the bounding box, 0 for its
    /// own choice; `progress` hears cells of space that are done, and all.
    ///
    /// # Errors
    /// A fault of its patches, or between them; a margin out of range, or of tables.
    pub fn made(self, margin: f64, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Made, Refusal> {
        if !(0.0..=30.0).contains(&margin) {
            return Err(Refusal::Settings(format!("margin is {margin}: give 0 to 30, in sizes of the body")));
        }
        let (text, label) = match self {
            Self::Tables(..) if margin > 0.0 => {
                let says = "a .palp file has its locator already: bake its model with this margin";
                return Err(Refusal::Settings(format!("margin is {margin}: {says}")));
            }
            Self::Tables(file, bytes) => return Ok(Made { model: file.model, baked: file.body, bytes }),
            Self::Text(text, label) => (text, label),
        };
        let model = Model::parse(&text, &label).map_err(|error| Refusal::Model(error.to_string()))?;
        let baked = BakedBody::new(&model, &label).map_err(|error| Refusal::Model(error.to_string()))?;
        let options = baked.locator_options().reaching(margin);
        let refused = |error: &dyn std::fmt::Display| Refusal::Model(format!("{label}: {error}"));
        let (baked, _) = baked.located(&options, progress).map_err(|error| refused(&error))?;
        let digest = Sha256::digest(text.as_bytes()).into();
        let bytes = palpate_bake::file::write(digest, &model, &baked).map_err(|fault| refused(&fault))?;
        Ok(Made { model, baked, bytes })
    }
}
