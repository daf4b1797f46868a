//! Instruction budgets of palpate's queries: counts that must not grow.

use super::program::Counted;
use super::scene::{Scene, Task};
use crate::spread::Spread;
use anyhow::Context as _;
use serde::Deserialize;

/// Growth that is let pass.
const MARGIN: f64 = 1.03;

/// The maximum numbers of instructions of a contestant's query on a scene.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// The model.
    pub model: String,
    /// `cold` or `track`.
    pub task: String,
    /// The contestant.
    pub contestant: String,
    /// Instructions of the median query.
    pub median: u64,
    /// Instructions of the dearest query.
    pub worst: u64,
}

/// A budget that is passed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{contestant} on {scene}: {spent} instructions in the {which} query, over 3 % more than the budget's {budget}")]
pub struct Excess {
    /// The contestant.
    pub contestant: String,
    /// The scene.
    pub scene: String,
    /// `median` or `dearest`.
    pub which: &'static str,
    /// The counted instructions.
    pub spent: u64,
    /// The allowed instructions.
    pub budget: u64,
}

impl Budget {
    /// The committed budgets.
    ///
    /// # Errors
    /// If the file is missing or not as expected.
    pub fn all() -> anyhow::Result<Vec<Self>> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            budget: Vec<Budget>,
        }
        let path = crate::repository::root()?.join("host-tests/budgets/race.toml");
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let file: File = toml::from_str(&text).with_context(|| path.display().to_string())?;
        Ok(file.budget)
    }

    fn task(&self) -> Option<Task> {
        [Task::Cold, Task::Track].into_iter().find(|task| task.name() == self.task)
    }

    /// Whether it is for this scene.
    pub fn is_for(&self, scene: &Scene) -> bool {
        self.model == scene.model && self.task() == Some(scene.task)
    }
}

/// The figures that exceed their budget by more than 3 %.
pub fn excesses(budget: &Budget, scene: &Scene, counted: &Counted) -> Vec<Excess> {
    let Some(Spread { median, worst, .. }) = Spread::of(&counted.instructions) else { return Vec::new() };
    [("median", median, budget.median), ("dearest", worst, budget.worst)]
        .into_iter()
        .filter(|&(_, spent, allowed)| spent as f64 > MARGIN * allowed as f64)
        .map(|(which, spent, allowed)| Excess {
            contestant: counted.contestant.clone(),
            scene: scene.title(),
            which,
            spent,
            budget: allowed,
        })
        .collect()
}
