//! `palpate import`: a CAD part as a model file.

use crate::cad::{Importer, TOLERANCE, Wishes};
use crate::firmware::Progress;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// Makes a model file of a CAD part (STEP: AP203, AP214, AP242).
///
/// Faces become polynomial patches of degree 5 at most, each edge one curve that both its faces share, so that nothing
/// gapes. Faces with any outline and holes are divided into quads, without a side that ends on another's middle. The
/// result is compared with the part on dense points, both ways, and refused where it is farther off than the tolerance.
/// Patches go by the names of their faces, with a number where a face has more than one.
///
/// All solids and shells of the file, where the assembly places them, become one model. Exit status 2, a sentence and
/// no file if something is wrong.
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
    let wishes =
        Wishes { tolerance: arguments.tolerance, solid: arguments.solid.clone(), picture: arguments.picture.clone() };
    print!("{}", importer.import(&arguments.part, &arguments.out, &wishes)?);
    println!("{}", arguments.out.display());
    Ok(ExitCode::SUCCESS)
}
