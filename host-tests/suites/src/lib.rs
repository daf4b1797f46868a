//! Files that several suites read, and the exact distance of two boxes.

use glam::{DQuat, DVec3};
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

/// The distance of a box from another that is turned, where they are apart: from a corner of either, or between two
/// edges. Half lengths may be zero.
pub fn between_boxes(low: DVec3, high: DVec3, half: DVec3, turn: DQuat, origin: DVec3) -> f64 {
    let fixed = corners(low, high);
    let turned = corners(-half, half).map(|corner| turn * corner + origin);
    let mut nearest = f64::INFINITY;
    for corner in turned {
        nearest = nearest.min((corner - corner.clamp(low, high)).length());
    }
    for corner in fixed {
        let inside = turn.inverse() * (corner - origin);
        nearest = nearest.min((inside - inside.clamp(-half, half)).length());
    }
    let edges = |corners: [DVec3; 8]| {
        let ends = move |from: usize| {
            (0..3).filter(move |axis| from >> axis & 1 == 0).map(move |axis| (from, from | 1 << axis))
        };
        (0..8).flat_map(ends).map(move |(from, to)| (corners[from], corners[to] - corners[from]))
    };
    for (a, u) in edges(fixed) {
        for (b, v) in edges(turned) {
            let (across, between) = (u.cross(v), b - a);
            if across.length() <= 1e-9 * u.length() * v.length() {
                continue;
            }
            let (s, t) = (between.cross(v).dot(across), between.cross(u).dot(across));
            let full = across.length_squared();
            if (0.0..=full).contains(&s) && (0.0..=full).contains(&t) {
                nearest = nearest.min((between.dot(across) / full.sqrt()).abs());
            }
        }
    }
    nearest
}

fn corners(low: DVec3, high: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|signs| {
        DVec3::from_array(std::array::from_fn(|axis| if signs >> axis & 1 == 1 { high[axis] } else { low[axis] }))
    })
}
