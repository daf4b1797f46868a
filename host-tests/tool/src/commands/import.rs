//! `palpate import`: a CAD part as a model file.

use super::check::Loaded;
use super::output::write_whole;
use crate::cad::{Importer, TOLERANCE, Wishes};
use crate::firmware::Progress;
use crate::models::ModelFile;
use clap::Args;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Makes a model file of a CAD part (STEP: AP203, AP214, AP242).
///
/// Faces become polynomial patches of degree 5 at most, each edge one curve that both its faces share, so that nothing
/// gapes. Faces with any outline and holes are divided into quads, without a side that ends on another's middle. The
/// result is compared with the part on dense points, both ways, and refused where it is farther off than the tolerance.
/// Patches go by the names of their faces, with a number where a face has more than one.
///
/// All solids and shells of the file, where the assembly places them, become one model. What cuts itself or another,
/// lies in another, or is open, is said to. Exit status 2, a sentence and no file if something is wrong: also where
/// three faces meet at an edge, as of solids that share a face.
///
/// The first run compiles the reader, which takes some minutes.
#[derive(Args, Debug)]
pub struct Arguments {
    /// The part: a .step or .stp file
    #[arg(value_name = "PART.step")]
    part: PathBuf,
    /// The model file to write
    #[arg(long, value_name = "PART.toml")]
    out: PathBuf,
    /// The largest deviation from the part that is allowed, millimetres
    #[arg(long, value_name = "MM", default_value_t = TOLERANCE)]
    tolerance: f64,
    /// Only the solids of this name
    #[arg(long, value_name = "NAME")]
    solid: Option<String>,
    /// Draws the patches, their seams and, by colour, their deviation
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// What is wrong with the part, or that the importer does not build.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let importer = Importer::build(&Progress::new())?;
    // Nothing is written before all is right.
    let folder = tempfile::tempdir()?;
    let (model, drawn) = (folder.path().join("model.toml"), folder.path().join("picture.svg"));
    let picture = arguments.picture.as_ref().map(|_| drawn.clone());
    let wishes = Wishes { tolerance: arguments.tolerance, solid: arguments.solid.clone(), picture };
    let said = importer.import(&arguments.part, &model, &wishes)?;
    let text = fs::read_to_string(&model)?;
    let loaded = Loaded::of(ModelFile::imported(&arguments.part, text.clone()))?;
    if let Some(picture) = &arguments.picture {
        write_whole(picture, &fs::read(&drawn)?)?;
    }
    write_whole(&arguments.out, text.as_bytes())?;
    print!("{said}");
    for flaw in loaded.flaws() {
        println!("{}", loaded.describe(&flaw));
    }
    println!("{}", arguments.out.display());
    Ok(ExitCode::SUCCESS)
}
