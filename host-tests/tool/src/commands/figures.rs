//! `palpate figures`: the paper's Figures 3 and 6 to 9, recomputed.

use super::output::write_whole;
use super::progress;
use crate::figures::tour::Touring;
use crate::figures::{Options, Stage, Subject, body_sheet, draw_shape, sheets};
use crate::models::{self, SHIPPED};
use anyhow::{Context as _, ensure};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Draws the paper's Figures 3 and 6 to 9, with their numbers.
///
/// For a model of several patches: Figure 3, slices through its Voronoi regions as the tables have them, and Figure 9,
/// a probe's path around it with u, v and the active feature. For a model of one patch:
///
/// Figure 6: a start whose witness point meets a border, follows it and leaves it; the clearest of a fixed grid of
/// probes and starts. Figure 7: the starts of 21 x 21 from which Newton's method, with and without saturation at the
/// borders, and the firmware's two laws find the closest point (to 1e-4 of the size), over seeded probes straight out
/// from the patch. Figure 8: following a moving probe with gains that are good, too high and too low, and the measured
/// limits of stability beside the predicted ones. Each also has the law of second order; not in the paper: how fast
/// both laws arrive and how far they lag.
///
/// The same arguments write the same bytes.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Model: a file, or the name of a shipped one; default: Table I, its convex companion, and the capped box
    #[arg(long)]
    model: Vec<PathBuf>,
    /// Draw only the shapes of the models, as line nets; default: all shipped models
    #[arg(long)]
    shapes: bool,
    /// Folder for the files
    #[arg(long, default_value = "palpate-report/figures")]
    out: PathBuf,
    /// Number of probes of Figure 7
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..))]
    probes: u16,
    /// Minimum distance of the probes from the patch, in patch sizes; the nearer, the larger Newton's basins
    #[arg(long, default_value_t = 0.1)]
    nearest: f64,
    /// Maximum distance of the probes from the patch, in patch sizes
    #[arg(long, default_value_t = 1.0)]
    farthest: f64,
    /// Seed of the probes
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let distances = [arguments.nearest, arguments.farthest];
    ensure!(
        0.0 < distances[0] && distances[0] <= distances[1] && distances[1] <= 100.0,
        "--nearest must be above 0 and not above --farthest, and that not above 100"
    );
    fs::create_dir_all(&arguments.out)
        .with_context(|| format!("cannot make the folder {}", arguments.out.display()))?;
    if arguments.shapes {
        return shapes(&chosen(&arguments.model, &SHIPPED.map(|(name, _)| name)), &arguments.out);
    }
    let models = chosen(&arguments.model, &["table1", "table1c", "capped_box"]);
    let subjects = models.iter().map(|model| Chosen::read(model)).collect::<anyhow::Result<Vec<_>>>()?;
    let options = Options { probes: arguments.probes.into(), distances, seed: arguments.seed };
    for subject in subjects {
        let bar = progress::work();
        let (title, computed) = match &subject {
            Chosen::Patch(subject) => {
                let computed = sheets(subject, options, |stage, done, all| bar.tell(name(stage), done, all))?;
                (&subject.name, computed)
            }
            Chosen::Body(touring) => (&touring.name, vec![body_sheet(touring)?]),
        };
        drop(bar);
        println!("{title}");
        for sheet in computed {
            for (name, value) in sheet.rows {
                println!("  {name:<28} {value}");
            }
            for (file, contents) in sheet.files {
                let path = arguments.out.join(file);
                write_whole(&path, contents.as_bytes())?;
                println!("    {}", path.display());
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn chosen(models: &[PathBuf], otherwise: &[&str]) -> Vec<PathBuf> {
    if !models.is_empty() {
        return models.to_vec();
    }
    otherwise.iter().map(PathBuf::from).collect()
}

fn shapes(models: &[PathBuf], out: &Path) -> anyhow::Result<ExitCode> {
    for path in models {
        let model = models::read(path)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let file = out.join(format!("{stem}-shape.svg"));
        write_whole(&file, draw_shape(&model, &path.display().to_string())?.as_bytes())?;
        println!("{}: {}", model.name, file.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// A model is a patch or a body.
enum Chosen {
    Patch(Box<Subject>),
    Body(Box<Touring>),
}

impl Chosen {
    fn read(path: &Path) -> anyhow::Result<Self> {
        if models::read(path)?.patches.len() > 1 {
            return Ok(Self::Body(Box::new(Touring::read(path)?)));
        }
        Ok(Self::Patch(Box::new(Subject::read(path)?)))
    }
}

const fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Passage => "probes of figure 6",
        Stage::Basins => "probes of figure 7",
    }
}
