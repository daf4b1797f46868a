//! Files that several suites read.

use palpate_bake::{BakedBody, Model};
use std::fs;
use std::path::{Path, PathBuf};

/// A path below the top of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// The file of a model that ships.
pub fn model_file(name: &str) -> PathBuf {
    repository("host-tests/models").join(name).with_extension("toml")
}

/// A model that ships.
///
/// # Panics
/// If there is none of this name.
pub fn model(name: &str) -> Model {
    Model::read(&model_file(name)).expect("a model that ships")
}

/// The body of a model that ships, without its locator.
///
/// # Panics
/// If there is none of this name.
pub fn body(name: &str) -> BakedBody {
    BakedBody::new(&model(name), name).expect("a body that ships")
}

/// The names of all models that ship.
///
/// # Panics
/// If their folder cannot be read.
pub fn models() -> Vec<&'static str> {
    let files = fs::read_dir(repository("host-tests/models")).expect("the folder of models");
    let mut names: Vec<_> = files
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| &*Box::leak(path.file_stem().expect("a name").to_string_lossy().into_owned().into_boxed_str()))
        .collect();
    names.sort_unstable();
    names
}

/// A part from CAD or another model that does not ship.
pub fn data(name: &str) -> PathBuf {
    repository("host-tests/suites/data").join(name)
}
