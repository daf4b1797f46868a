//! Says which body and settings go into the image.

use std::env;
use std::path::{Path, PathBuf};

fn main() {
    let emulated = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let boards = emulated.parent().expect("it lies in boards/");
    choose("PALPATE_BODY", &boards.join("bodies/capped_box.rs"));
    choose("PALPATE_SETTINGS", &boards.join("settings/default.rs"));
    println!("cargo::rerun-if-changed=build.rs");
}

/// Passes on the file that the environment names, or the default, as an absolute path for `include!`.
fn choose(variable: &str, default: &Path) {
    println!("cargo::rerun-if-env-changed={variable}");
    let chosen = env::var_os(variable).map_or_else(|| default.to_path_buf(), PathBuf::from);
    let absolute = chosen.canonicalize().unwrap_or_else(|error| panic!("{variable}: {}: {error}", chosen.display()));
    println!("cargo::rerun-if-changed={}", absolute.display());
    println!("cargo::rustc-env={variable}_FILE={}", absolute.display());
}
