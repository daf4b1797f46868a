//! `palpate-cad PART.step OUT.toml TOLERANCE_MM [--solid NAME] [--progress]`: what `cargo
//! palpate import` runs, which has the help.

use palpate_cad::{Options, import};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

fn main() -> ExitCode {
    // What a file makes the reader do wrong is reported, and nothing else about it.
    std::panic::set_hook(Box::new(|_| {}));
    match std::panic::catch_unwind(run) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(message)) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
        Err(_) => {
            eprintln!("the importer failed on this part; nothing was written");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    let mut words = env::args().skip(1);
    let mut next = |what: &str| words.next().ok_or_else(|| format!("{what} is missing"));
    let part = PathBuf::from(next("the part")?);
    let out = PathBuf::from(next("the model file")?);
    let tolerance = next("the tolerance")?;
    let tolerance: f64 = tolerance.parse().map_err(|_| format!("the tolerance \"{tolerance}\" is not a number"))?;
    if !(1e-6..=1e3).contains(&tolerance) {
        return Err(format!("a tolerance of {tolerance} mm is not between 0.000001 and 1000 mm"));
    }
    let mut options = Options { tolerance, ..Options::default() };
    while let Some(word) = words.next() {
        if word == "--progress" {
            palpate_cad::show_progress();
            continue;
        }
        let value = words.next().ok_or_else(|| format!("{word} needs a value"))?;
        match word.as_str() {
            "--solid" => options.solid = Some(value),
            _ => return Err(format!("{word} is not known")),
        }
    }
    let imported = import(&part, &options).map_err(|error| error.to_string())?;
    write_whole(&out, &imported.model)?;
    imported.report.iter().for_each(|line| println!("{line}"));
    Ok(())
}

/// Writes beside the file and renames: what stands there is whole.
fn write_whole(path: &Path, text: &str) -> Result<(), String> {
    let cannot = |cause: std::io::Error| format!("cannot write {}: {cause}", path.display());
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    fs::write(&beside, text).map_err(cannot)?;
    fs::rename(&beside, path).map_err(cannot)
}
