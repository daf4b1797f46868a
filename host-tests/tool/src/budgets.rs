//! Budgets of counted instructions, one file a core in `host-tests/budgets/`.

use crate::firmware::{Board, Choice, Pace, Program, Progress, SetUpError};
use crate::repository::{self, NoRepository};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Allowed growth of a figure, percent: covers variations between compilers, but not another call.
pub const ALLOWANCE: u32 = 3;

fn budget_file(board: Board) -> Result<PathBuf, NoRepository> {
    Ok(repository::root()?.join("host-tests/budgets").join(board.name()).with_extension("toml"))
}

/// Counted instructions by name, in the order of measurement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figures(pub Vec<(String, u32)>);

impl Figures {
    /// The count of this name.
    pub fn of(&self, name: &str) -> Option<u32> {
        self.0.iter().find(|(other, _)| other == name).map(|(_, count)| *count)
    }
}

/// Recorded limits of the figures.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    instructions: BTreeMap<String, u32>,
}

/// Why figures and budget cannot be compared.
#[derive(Debug, Error)]
pub enum BudgetError {
    /// The program did not run to its end.
    #[error("the program that counts did not run: {0}")]
    Run(#[from] SetUpError),
    /// There is no budget file outside of the repository.
    #[error(transparent)]
    NoRepository(#[from] NoRepository),
    /// It pressed a tool into a body that it cannot count on.
    #[error("{0}")]
    Stopped(String),
    /// It said something else than figures.
    #[error("not a figure: {0:?}")]
    Line(String),
    /// The budget file.
    #[error("{path}: {reason}")]
    File {
        /// Which.
        path: PathBuf,
        /// The reason why it is refused.
        reason: String,
    },
}

/// A figure beside its budget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Its name.
    pub name: String,
    /// The counted number; `None` if it is missing.
    pub found: Option<u32>,
    /// The recorded number; `None` if it is new.
    pub allowed: Option<u32>,
}

impl Verdict {
    /// Whether this is a failure: worse by more than [`ALLOWANCE`], missing or new.
    pub fn fails(&self) -> bool {
        match (self.found, self.allowed) {
            (Some(found), Some(allowed)) => 100 * found > (100 + ALLOWANCE) * allowed,
            _ => true,
        }
    }

    /// A remark for the table; empty if the figure is as recorded.
    pub fn remark(&self) -> String {
        match (self.found, self.allowed) {
            (Some(found), Some(allowed)) if found != allowed => {
                let change = 100.0 * (f64::from(found) / f64::from(allowed) - 1.0);
                let verdict = if self.fails() { "  over budget" } else { "" };
                format!("{change:+.1} %{verdict}")
            }
            (Some(_), Some(_)) => String::new(),
            (Some(_), None) => "not in the budget".to_owned(),
            (None, _) => "not counted".to_owned(),
        }
    }
}

/// The image of a board whose body is the foam box; how many of its modes move is a feature of the program.
///
/// # Errors
/// If this is not the repository.
pub fn soft_choice(board: Board) -> Result<Choice, BudgetError> {
    let body = repository::root()?.join("boards/emulated/soft.rs");
    Ok(Choice { board, body: Some(body), ..Choice::default() })
}

/// Which images are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Images {
    /// All but those between two others: of scenes one body, at rest and on a path, and sixteen; of modes eight.
    Few,
    /// All.
    All,
}

/// Start of the names of figures whose images are not among the few.
const BETWEEN: [&str; 5] = [
    "servo tick, a scene of one free body",
    "servo tick, a scene of two bodies",
    "servo tick, a scene of 4 bodies",
    "servo tick, a soft body of 1 mode",
    "servo tick, a soft body of 4 modes",
];

/// Builds the counting programs and runs them on an emulated board.
///
/// # Errors
/// If one does not run to its end, or says something else than figures.
pub fn measure(board: Board, images: Images, progress: &Progress) -> Result<Figures, BudgetError> {
    let is_all = images == Images::All;
    let mut all = figures(&Program::prepare(board, "budget", &[], progress)?.run(Pace::Counting)?)?;
    // Of a core without floats, its plain loop alone.
    if !board.has_floats() {
        return Ok(all);
    }
    // Each other loop is an image of its own: two loops in one would share code that each alone has for itself.
    let other = |feature, name: &str| -> Result<Vec<(String, u32)>, BudgetError> {
        let counted = figures(&Program::prepare(board, "budget", &[feature], progress)?.run(Pace::Counting)?)?;
        Ok(counted.0.into_iter().filter(|(of, _)| of.contains(name)).collect())
    };
    let (protected, smooth) = (other("counted", "tick, protected")?, other("smooth", "tick, smooth")?);
    let folded = other("folded", "tick, folded back")?;
    let knob = figures(&Program::prepare(board, "knob_budget", &["knob"], progress)?.run(Pace::Counting)?)?;
    let file = figures(&Program::prepare(board, "file_budget", &[], progress)?.run(Pace::Counting)?)?;
    all.0.extend(knob.0);
    all.0.extend(file.0);
    let between: &[_] = if is_all { &["scene-free", "scene-two", "scene-four"] } else { &[] };
    for &scene in ["scene", "scene-path"].iter().chain(between).chain(&["scene-sixteen"]) {
        all.0.extend(figures(&Program::prepare(board, "scene_budget", &[scene], progress)?.run(Pace::Counting)?)?.0);
    }
    // The foam's modes move the body of these images; one core alone, for they take minutes to build.
    if board == Board::M4 {
        let soft = soft_choice(board)?;
        let between: &[_] = if is_all { &["soft", "soft-four"] } else { &[] };
        for &modes in between.iter().chain(&["soft-eight"]) {
            all.0.extend(figures(&Program::prepare_with(&soft, "budget", &[modes], progress)?.run(Pace::Counting)?)?.0);
        }
    }
    all.0.extend(protected);
    all.0.extend(folded);
    all.0.extend(smooth);
    Ok(all)
}

/// Counts on the body of a file: queries without history (`cold`), or ticks of tools with a shape (`tool`).
///
/// # Errors
/// If the program does not run to its end, or says something else than figures.
pub fn on_file(board: Board, file: &Path, feature: &str, progress: &Progress) -> Result<Figures, BudgetError> {
    let choice = Choice { board, cold: Some(file.to_path_buf()), ..Choice::default() };
    let said = Program::prepare_with(&choice, "budget", &[feature], progress)?.run(Pace::Counting);
    if let Err(SetUpError::Failed { output, .. }) = &said
        && let Some(reason) = output.lines().find_map(|line| line.strip_prefix("stopped: "))
    {
        return Err(BudgetError::Stopped(reason.to_owned()));
    }
    figures(&said?)
}

/// The lines `"name" = count`.
fn figures(said: &str) -> Result<Figures, BudgetError> {
    let figure = |line: &str| {
        let (name, count) = line.rsplit_once(" = ")?;
        Some((name.strip_prefix('"')?.strip_suffix('"')?.to_owned(), count.parse().ok()?))
    };
    let lines = said.lines().map(|line| figure(line).ok_or_else(|| BudgetError::Line(line.to_owned())));
    Ok(Figures(lines.collect::<Result<_, _>>()?))
}

impl Budget {
    /// The committed budget of a core.
    ///
    /// # Errors
    /// If there is none, or it is not in order.
    pub fn load(board: Board) -> Result<Self, BudgetError> {
        let path = budget_file(board)?;
        let text = fs::read_to_string(&path).map_err(|error| refused(&path, &error))?;
        toml::from_str(&text).map_err(|error| refused(&path, &error))
    }

    /// The recorded limit of a figure.
    pub fn of(&self, name: &str) -> Option<u32> {
        self.instructions.get(name).copied()
    }

    /// Writes these figures as the budget of a core.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn record(board: Board, figures: &Figures) -> Result<PathBuf, BudgetError> {
        let path = budget_file(board)?;
        let mut text = format!(
            "# Counted instructions of the hot path on the emulated {}: cargo palpate budgets --board {} --record\n\n[instructions]\n",
            board.core(),
            board.name()
        );
        for (name, count) in &figures.0 {
            text.push_str(&format!("\"{name}\" = {count}\n"));
        }
        fs::write(&path, text).map_err(|error| refused(&path, &error))?;
        Ok(path)
    }

    /// Every figure of these images beside its budget: those counted in their order, then those missing.
    pub fn compare(&self, found: &Figures, images: Images) -> Vec<Verdict> {
        let counted = found.0.iter().map(|(name, count)| Verdict {
            name: name.clone(),
            found: Some(*count),
            allowed: self.instructions.get(name).copied(),
        });
        let is_left_out = |name: &str| images == Images::Few && BETWEEN.iter().any(|start| name.starts_with(start));
        let missing = self.instructions.iter().filter(|(name, _)| found.of(name).is_none() && !is_left_out(name));
        let missing =
            missing.map(|(name, allowed)| Verdict { name: name.clone(), found: None, allowed: Some(*allowed) });
        counted.chain(missing).collect()
    }
}

fn refused(path: &std::path::Path, reason: &dyn std::fmt::Display) -> BudgetError {
    BudgetError::File { path: path.to_path_buf(), reason: reason.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_percent_worse_is_borne_and_more_is_not() {
        let budget = Budget { instructions: [("a".to_owned(), 100), ("b".to_owned(), 100)].into() };
        let fails =
            |text: &str| budget.compare(&figures(text).unwrap(), Images::Few).iter().filter(|v| v.fails()).count();
        assert_eq!(fails("\"a\" = 103\n\"b\" = 90\n"), 0);
        assert_eq!(fails("\"a\" = 104\n\"b\" = 104\n"), 2);
        assert_eq!(figures("\"held at u = 0\" = 7\n").unwrap().of("held at u = 0"), Some(7));
        assert_eq!(fails("\"a\" = 100\n"), 1, "a figure that is gone");
        assert_eq!(fails("\"a\" = 100\n\"b\" = 100\n\"c\" = 1\n"), 1, "a figure nobody recorded");
    }

    #[test]
    fn what_is_not_a_figure_is_refused() {
        for line in ["panicked", "\"a\" = -1", "a = 1", "\"a\" = 1.5"] {
            assert!(matches!(figures(line), Err(BudgetError::Line(_))), "{line}");
        }
    }
}
