//! The way to a compiler.

use std::fs;
use std::path::{Path, PathBuf};

/// The way to a compiler.
#[derive(Clone, Debug)]
pub(super) enum Way {
    /// The Rust at hand has the target's library.
    Installed,
    /// Debian's Rust with a library for the target, built here.
    Debian {
        /// Where the library lies.
        sysroot: PathBuf,
        /// The linker.
        linker: PathBuf,
    },
}

/// Whether a folder holds a compiled `core`.
pub(super) fn has_core(folder: &Path) -> bool {
    fs::read_dir(folder)
        .is_ok_and(|entries| entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore-")))
}
