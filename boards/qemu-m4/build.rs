//! Lays the linker's files where it finds them and says which body and settings go into the image.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let board = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let boards = board.parent().expect("the board lies in boards/");

    let memory = boards.join("../memory.x");
    fs::copy(&memory, out.join("memory.x")).expect("memory.x lies at the root of the repository");
    println!("cargo::rerun-if-changed={}", memory.display());
    // cortex-m-rt wants the names of the chip's interrupt handlers; those that nobody defines go to the default one.
    fs::write(out.join("device.x"), "PROVIDE(TIMER0 = DefaultHandler);\n").expect("OUT_DIR can be written");
    println!("cargo::rustc-link-search={}", out.display());

    choose("PALPATE_BODY", &boards.join("bodies/table1c.rs"));
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
