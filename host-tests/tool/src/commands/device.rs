//! `palpate device`: the file of one's own device as the library's constants, in Rust or C; or the file of a shipped
//! device to start from.

use crate::devices;
use anyhow::{Context, bail};
use clap::Args;
use palpate_sim::devices::{OwnDevice, c_header, c_preset, source};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes the library's constants for a device file, or the file of a shipped device to start from.
///
/// The constants are checked here and again by the compiler.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Device file (my.toml), or the name of a shipped device
    device: PathBuf,
    /// Output: constants of Rust (device.rs) or C (device.h), or a device file (my.toml)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// The refused entry of the file; no output is written then.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let name = arguments.device.to_string_lossy();
    let is_c = arguments.out.extension().is_some_and(|extension| extension == "h");
    // One and two joints have no device file.
    if let (true, Some(shipped)) = (is_c, devices::named(&name).filter(|shipped| shipped.file().is_none())) {
        write(&arguments.out, &c_preset(shipped))?;
        println!("{name}: {} joints, written to {}", shipped.preset.feeds().len(), arguments.out.display());
        return Ok(ExitCode::SUCCESS);
    }
    let own = devices::own(&arguments.device)?;
    // A copy under another name would lose its remarks without a word.
    let [device, out] = [&arguments.device, &arguments.out].map(|path| path.canonicalize().ok());
    if device.is_some() && device == out {
        bail!("{name}: --out is the device file itself, which is not overwritten; give another name");
    }
    let text = match arguments.out.extension().and_then(|extension| extension.to_str()) {
        Some("rs") => source(&own, &name),
        Some("h") => c_header(&own, &name),
        Some("toml") => toml_of(&own, &format!("Written by `palpate device` from {name}."))?,
        _ => bail!("{}: --out must end in .rs, .h or .toml", arguments.out.display()),
    };
    write(&arguments.out, &text)?;
    println!("{}: {} joints, written to {}", own.file.name, own.file.joint.len(), arguments.out.display());
    Ok(ExitCode::SUCCESS)
}

/// A device file's text, with a line on top.
///
/// # Errors
/// None of a file that was read.
pub fn toml_of(own: &OwnDevice, head: &str) -> anyhow::Result<String> {
    Ok(format!("# {head} SI units; see docs/reference/device-format.md.\n\n{}", toml::to_string(&own.file)?))
}

fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
