//! `palpate import`: a CAD part as a model file.

use super::check::Loaded;
use super::output::write_whole;
use super::{bake, parts, progress, table_report};
use crate::cad::{Importer, TOLERANCE, Wishes};
use crate::figures::draw_shape;
use crate::firmware::Progress;
use crate::models::ModelFile;
use anyhow::anyhow;
use clap::Args;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Makes a model file of a CAD part (STEP: AP203, AP214, AP242).
///
/// Faces become polynomial patches of degree 5 at most; each edge is one curve that both its faces share, so the result
/// has no gaps. Faces with any outline and holes are divided into quads; no side ends in the middle of another. The
/// result is compared with the part on dense points, both ways, and refused beyond the tolerance. Patches are named
/// after their faces, with a number where a face has several.
///
/// All solids and shells become one model, placed as in the assembly. Bodies that cut themselves or another, lie in
/// another, or are open are imported and reported. Exit status 2 and no file if the part is refused: also where three
/// faces meet at an edge, as of solids that share a face.
///
/// The last line says whether the body is usable, and has the worst-case deviation, the flash it takes, and the boards it
/// fits. The first run compiles the reader, which takes minutes.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Part: a .step or .stp file
    #[arg(value_name = "PART.step")]
    part: PathBuf,
    /// Model file to write
    #[arg(long, value_name = "PART.toml")]
    out: PathBuf,
    /// Maximum deviation from the part, mm
    #[arg(long, value_name = "MM", default_value_t = TOLERANCE)]
    tolerance: f64,
    /// Only the solids of this name
    #[arg(long, value_name = "NAME")]
    solid: Option<String>,
    /// Picture of the patches and their borders
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

/// Patches up to which the flash is counted, by a locator that stays in the cache for `bake`: 25 processor seconds at most.
const COUNTED: usize = 128;
/// Bytes of flash for each patch of other bodies: parts take 1 to 3 KB.
const PER_PATCH: u64 = 2_000;

/// The last line: whether the body is usable, the deviation, its flash, and the boards for it.
fn outcome(mut loaded: Loaded, text: &str) -> anyhow::Result<String> {
    let deviation = parts::deviation(text).map_or_else(String::new, |mm| format!("{mm:.4} mm"));
    let faces = loaded.body.faces.len();
    if faces > COUNTED {
        let bytes = faces as u64 * PER_PATCH;
        let boards = table_report::fits(bytes);
        let flash = format!(
            "some {bytes} bytes of flash at {PER_PATCH} a patch (an estimate; `palpate bake --table-report` counts them)"
        );
        return Ok(format!("usable: worst-case deviation {deviation} (sampled), {flash}, fits {boards}"));
    }
    let tables = if faces > 1 {
        let (options, bar) = (loaded.body.locator_options(), progress::work());
        let progress = |done, all| bar.tell("cells of space", done, all);
        loaded.file.located(loaded.body.clone(), &options, None, &progress)
    } else {
        Ok(loaded.body.clone())
    };
    match tables {
        Ok(body) => loaded.body = body,
        Err(error) => return Ok(format!("not usable: {error:#}")),
    }
    let bytes = bake::bytes(&loaded);
    let boards = table_report::fits(bytes);
    Ok(format!("usable: worst-case deviation {deviation} (sampled), {bytes} bytes of flash, fits {boards}"))
}

/// A fault of several solids together, with the names by which each can be had alone.
fn one_by_one(fault: anyhow::Error, text: &str) -> anyhow::Error {
    let names = text.lines().next().and_then(|line| line.split_once("STEP file: ")?.1.rsplit_once(", within"));
    match names {
        Some((names, _)) if names.contains(", ") => {
            anyhow!("{fault:#}; the part has several solids: import one at a time (--solid NAME), of {names}")
        }
        _ => fault,
    }
}

/// Runs the command.
///
/// # Errors
/// A fault of the part, or an importer that does not build.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let importer = Importer::build(&Progress::new())?;
    // Nothing is written before all is right.
    let folder = tempfile::tempdir()?;
    let model = folder.path().join("model.toml");
    let wishes = Wishes { tolerance: arguments.tolerance, solid: arguments.solid.clone() };
    let said = importer.import(&arguments.part, &model, &wishes)?;
    let text = fs::read_to_string(&model)?;
    let loaded =
        Loaded::of(ModelFile::imported(&arguments.part, text.clone())).map_err(|fault| one_by_one(fault, &text))?;
    if let Some(picture) = &arguments.picture {
        write_whole(picture, draw_shape(&loaded.model, &loaded.file.label)?.as_bytes())?;
    }
    write_whole(&arguments.out, text.as_bytes())?;
    print!("{said}");
    for flaw in loaded.flaws() {
        println!("{}", loaded.describe(&flaw));
    }
    println!("{}", arguments.out.display());
    println!("{}", outcome(loaded, &text)?);
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_solids_that_do_not_go_together_can_be_had_one_by_one() {
        let of = |names| {
            one_by_one(anyhow!("one curve"), &format!("# imported from a STEP file: {names}, within 0.01 mm\n"))
        };
        assert_eq!(of("left").to_string(), "one curve");
        assert!(of("left, right").to_string().ends_with("one at a time (--solid NAME), of left, right"));
    }
}
