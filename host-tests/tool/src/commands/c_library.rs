//! `palpate c-library`: the library for C as a package for CMake, pkg-config, Zephyr, Arduino and PlatformIO.

use super::bake;
use crate::firmware::Progress;
use crate::in_c::{self, Core};
use crate::repository;
use anyhow::{Context as _, bail, ensure};
use clap::Args;
use palpate_sim::devices::{DEVICES, c_preset};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Writes palpate as a C library for CMake, pkg-config, Zephyr, Arduino and PlatformIO.
///
/// Header, shipped devices, examples, and libraries for Cortex-M4F, M7, M33 and this machine, here a shared one too.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Output folder, or a file palpate.zip; must not exist
    #[arg(long)]
    out: PathBuf,
    /// Body of the examples: a model; default: the capped box
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let Arguments { out, model } = arguments;
    if out.exists() {
        bail!("{}: already exists; choose another name", out.display());
    }
    let model = model
        .clone()
        .map_or_else(|| Ok(repository::root()?.join("boards/bodies/capped_box.palp")), Ok::<_, anyhow::Error>)?;
    let part = bake::part_header(&model)?;
    if out.extension().is_some_and(|extension| extension == "zip") {
        let folder = tempfile::tempdir()?;
        let package = folder.path().join("palpate");
        write(&package, &part)?;
        zip(&package, out).with_context(|| out.display().to_string())?;
    } else {
        write(out, &part)?;
    }
    println!("palpate c-library: {}", out.display());
    Ok(ExitCode::SUCCESS)
}

fn write(out: &Path, part: &str) -> anyhow::Result<()> {
    let (root, progress) = (repository::root()?, Progress::new());
    let libraries = [Core::M4, Core::M33, Core::Host].map(|core| (core, in_c::library(core, &progress)));
    let from = in_c::folder()?;
    for file in files(&from.join("package"))? {
        copy(&file, &out.join(file.strip_prefix(from.join("package"))?))?;
    }
    copy(&from.join("include/palpate.h"), &out.join("src/palpate.h"))?;
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        copy(&root.join(licence), &out.join(licence))?;
    }
    for example in ["Feel", "Servo", "host"] {
        save(&out.join("examples").join(example).join("part.h"), part)?;
    }
    for device in &DEVICES {
        save(&out.join("src/palpate").join(format!("{}.h", device.name)), &c_preset(device))?;
    }
    let host = format!("{}-{}", std::env::consts::OS, std::env::consts::ARCH);
    let found = out.join("lib/pkgconfig/palpate.pc");
    save(&found, &fs::read_to_string(&found)?.replace("@HOST@", &host))?;
    for (core, library) in libraries {
        let library = library?;
        let mut folders: Vec<PathBuf> = core.arduino().iter().map(|folder| out.join("src").join(folder)).collect();
        if core == Core::Host {
            let folder = out.join("lib").join(&host);
            fs::create_dir_all(&folder)?;
            in_c::shared(&library, &folder.join("libpalpate.so"))?;
            folders.push(folder);
        }
        for folder in folders {
            copy(&library, &folder.join("libpalpate.a"))?;
            in_c::strip(core, &folder.join("libpalpate.a"))?;
        }
    }
    Ok(())
}

/// Every file below a folder, sorted.
fn files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() { all.extend(files(&path)?) } else { all.push(path) }
    }
    all.sort();
    Ok(all)
}

/// A folder as a zip file with that folder at its top, by Python's own library.
fn zip(folder: &Path, out: &Path) -> anyhow::Result<()> {
    let mut python = Command::new("python3");
    let ended =
        python.args(["-m", "zipfile", "-c"]).arg(out).arg(folder).status().context("python3 writes zip files")?;
    ensure!(ended.success(), "python3 could not write it: {ended}");
    Ok(())
}

fn save(file: &Path, text: &str) -> anyhow::Result<()> {
    fs::create_dir_all(file.parent().unwrap_or(file))?;
    fs::write(file, text).with_context(|| file.display().to_string())
}

fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(to.parent().unwrap_or(to)).with_context(|| to.display().to_string())?;
    fs::copy(from, to).map(drop).with_context(|| format!("{} to {}", from.display(), to.display()))
}
