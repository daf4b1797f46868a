//! `palpate c-library`: the library for C as a folder that the Arduino builder and PlatformIO take.

use crate::firmware::Progress;
use crate::in_c::{self, Core};
use crate::repository;
use anyhow::{Context as _, bail};
use clap::Args;
use palpate_bake::file::BakedFile;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes palpate as a C library for Arduino and PlatformIO: header, precompiled libraries, examples.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Output folder; must not exist
    #[arg(long)]
    out: PathBuf,
    /// Body of the example, a `.palp`; default: the capped box
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let Arguments { out, model } = arguments;
    if out.exists() {
        bail!("{}: already exists; choose another folder", out.display());
    }
    let root = repository::root()?;
    let model = model.clone().unwrap_or_else(|| root.join("boards/bodies/capped_box.palp"));
    let part = part(&model)?;
    let progress = Progress::new();
    let libraries = [Core::M4, Core::M33].map(|core| in_c::library(core, &progress).map(|library| (core, library)));

    let from = in_c::folder()?;
    copy(&from.join("include/palpate.h"), &out.join("src/palpate.h"))?;
    for file in ["library.properties", "library.json", "link.py", "examples/Feel/Feel.ino"] {
        copy(&from.join("arduino").join(file), &out.join(file))?;
    }
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root.join(licence), &out.join(licence))?;
    }
    let part_to = out.join("examples/Feel/part.h");
    fs::write(&part_to, part).with_context(|| part_to.display().to_string())?;
    for library in libraries {
        let (core, library) = library?;
        for folder in core.arduino() {
            copy(&library, &out.join("src").join(folder).join("libpalpate.a"))?;
        }
    }
    println!("palpate c-library: {}", out.display());
    Ok(ExitCode::SUCCESS)
}

fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(to.parent().unwrap_or(to)).with_context(|| to.display().to_string())?;
    fs::copy(from, to).map(drop).with_context(|| format!("{} to {}", from.display(), to.display()))
}

/// A body's file as an array of C.
fn part(file: &Path) -> anyhow::Result<String> {
    let bytes = fs::read(file).with_context(|| file.display().to_string())?;
    let read = BakedFile::read(&bytes)
        .with_context(|| format!("{}: `palpate bake MODEL --out FILE.palp` writes such a file", file.display()))?;
    let mut text = format!(
        "// A body's file as `palpate bake` wrote it.\n#pragma once\n#include <stdint.h>\n\n\
         #define PART_FACES {}\n#define PART_EDGES {}\n\n\
         static const uint8_t part_palp[] __attribute__((aligned(4))) = {{\n",
        read.body.faces.len(),
        read.body.edges.len()
    );
    for row in bytes.chunks(20) {
        text.push_str("   ");
        for byte in row {
            let _ = write!(text, " {byte},");
        }
        text.push('\n');
    }
    text.push_str("};\n");
    Ok(text)
}
