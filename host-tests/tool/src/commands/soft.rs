//! `palpate bake --soft`: modes of a body of a material.

use super::check::Loaded;
use anyhow::Context as _;
use palpate::body::{Soft, TickLimit, TickWork};
use palpate::field::{Modal, ModalStep, Mode};
use palpate::servo::SoftContact;
use palpate_bake::modes;
use palpate_bake::ritz::{Material, Modes};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The modes of a body.
pub(super) struct SoftBake {
    /// The modes file.
    pub file: String,
    /// For the terminal.
    pub report: String,
    /// As the library takes them.
    pub modes: Vec<(Mode, Modal)>,
}

/// Where the modes file goes: beside the output, else into the current directory.
pub(super) fn path(out: Option<&Path>, model: &Path) -> PathBuf {
    match out {
        Some(out) => out.with_extension("modes.toml"),
        None => PathBuf::from(model.file_stem().unwrap_or_default()).with_extension("modes.toml"),
    }
}

/// Computes the modes of a material, or checks modes that are given.
///
/// # Errors
/// The first thing wrong with the file, or why the body has no modes.
pub(super) fn modes(
    loaded: &Loaded,
    path: &Path,
    count: usize,
    held: &[String],
    limit: TickLimit,
) -> anyhow::Result<SoftBake> {
    let label = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("{label}: cannot be read"))?;
    let is_given = text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("mode"));
    let mut report = String::new();
    let file = if is_given {
        text
    } else {
        let material = Material::parse(&text, &label)?;
        let found = Modes::new(&loaded.model, &loaded.body, &material, count, held)?;
        writeln!(report, "mode  frequency Hz  modal mass kg  share held")?;
        for (index, mode) in found.held.iter().enumerate() {
            let (hz, kg, share) = (mode.frequency_hz, mode.mass_kg, 100.0 * mode.share);
            writeln!(report, "{index:<4}  {hz:>12.3}  {kg:>13.6}  {share:>8.1} %")?;
        }
        for [frequency, share] in &found.left_out {
            writeln!(report, "left out: {frequency:.3} Hz, of which a quadratic field holds {:.1} %", 100.0 * share)?;
        }
        if found.held.len() < count {
            writeln!(report, "only {} modes are held by a quadratic field", found.held.len())?;
        }
        writeln!(report, "mass {:.6} kg", found.mass_kg)?;
        found.file(&loaded.model, &loaded.file.name, &material)?
    };
    let modes = modes::parse_moving(&file, &label, &loaded.model)?;
    let stretch: f32 = modes.iter().map(|(mode, _)| mode.limit * mode.bounds.stretch).sum();
    anyhow::ensure!(
        stretch < 1.0,
        "{label}: at its budget the modes may fold space (sum of |q| Lip = {stretch:.3}, must be below 1): lower the budget"
    );
    let budget = modes.first().map_or(0.0, |(mode, _)| 1e3 * mode.limit);
    // All of it is f32, and as large on a 32-bit target.
    let flash = modes.len() * (size_of::<Mode>() + size_of::<ModalStep>());
    let ram = size_of::<SoftContact>();
    writeln!(
        report,
        "budget {budget:.3} mm of |q| each, stretch of space at most {stretch:.3}; flash {flash} bytes beside the \
         body's tables, RAM {ram} bytes"
    )?;
    let fields: Vec<Mode> = modes.iter().map(|(mode, _)| *mode).collect();
    let tables = loaded.body.to_body().with_context(|| loaded.file.label.clone())?;
    let soft = Soft::new(tables, &fields).with_context(|| label.clone())?.fitted(limit);
    let (cost, cycles, effort) = (soft.worst_tick(TickWork::EACH).cost, soft.worst_cycles(), soft.rest().effort());
    writeln!(
        report,
        "worst tick {cost} evaluations, {cycles} modelled cycles of a Cortex-M4F of {}, at effort {},{}",
        limit.cycles, effort.steps, effort.candidates
    )?;
    if cycles > limit.cycles {
        writeln!(report, "that bound is above the limit: count ticks (palpate cycles), or lower the rate")?;
    }
    Ok(SoftBake { file, report, modes })
}
