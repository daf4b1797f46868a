//! The models that ship, by name, as the wheel carries them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../models");
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut files: Vec<PathBuf> =
        fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort_unstable();
    let mut rows = String::new();
    for file in &files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        writeln!(rows, "    ({name:?}, include_str!({:?})),", file.display().to_string())?;
    }
    let out = Path::new(&env::var("OUT_DIR")?).join("shipped.rs");
    fs::write(out, format!("[\n{rows}]\n"))?;
    Ok(())
}
