//! The scores as a table for the terminal and as CSV.

use super::judge::Score;
use super::scene::Task;
use crate::spread::Spread;
use std::fmt::Write as _;

/// palpate's name among the contestants.
pub(super) const OURS: &str = "palpate";
/// The contestant that answers nothing.
pub(super) const CALL: &str = "call";

/// Short description of a contestant.
pub(super) fn described(score: &Score) -> &'static str {
    match (score.contestant.as_str(), score.task) {
        (CALL, _) => "an empty call",
        (OURS, Task::Cold) => "palpate, cold",
        (OURS, Task::Track) => "palpate, second order, one step",
        ("palpate-settled", _) => "palpate, second order until settled",
        ("palpate-first-order", _) => "palpate, the paper's law, one step",
        ("newton", Task::Cold) => "Newton from the nearest of 64 cells",
        ("newton-safeguarded", Task::Cold) => "Newton safeguarded, all near cells",
        ("newton-one-step", _) => "Newton, one step",
        ("newton", Task::Track) => "Newton until settled",
        ("newton-safeguarded", Task::Track) => "Newton safeguarded until settled",
        ("truck", Task::Cold) => "truck, no hint",
        ("truck", Task::Track) => "truck, hint = its last",
        ("parry-mesh-256", _) => "parry, mesh 256 x 256",
        ("parry-mesh-128", _) => "parry, mesh 128 x 128",
        ("parry-mesh-32", _) => "parry, mesh 32 x 32",
        ("parry-hull", _) => "parry, convex hull of 33 x 33",
        _ => "?",
    }
}

/// The table of one scene.
pub fn text(scores: &[Score]) -> String {
    let Some(first) = scores.first() else { return String::new() };
    let ours = scores.iter().find(|score| score.contestant == OURS).map(|score| score.instructions.median);
    let mut text = format!("{} {}, {} queries\n", first.model, first.task.name(), first.queries);
    let _ = writeln!(
        text,
        "  {:<36}{:>11}{:>11}{:>11}{:>8}{:>11}{:>11}{:>10}{:>10}{:>9}",
        "", "instr.", "99 %", "most", "x ours", "ns", "99 %", "error", "worst", "misses"
    );
    for score in scores {
        let Spread { median, most, worst } = score.instructions;
        let ratio = ours.map_or(f64::NAN, |ours| median as f64 / ours as f64);
        let _ = write!(
            text,
            "  {:<36}{:>11}{:>11}{:>11}{:>8}{:>11}{:>11}",
            described(score),
            grouped(median),
            grouped(most),
            grouped(worst),
            if ratio < 10.0 { format!("{ratio:.2}") } else { format!("{ratio:.0}") },
            grouped(score.nanoseconds.median),
            grouped(score.nanoseconds.most),
        );
        if score.contestant == CALL {
            text.push('\n');
        } else {
            let misses = 100.0 * score.misses as f64 / score.queries as f64;
            let misses = if score.misses == 0 { "0".to_owned() } else { format!("{misses:.2} %") };
            let _ = writeln!(text, "{:>10.1e}{:>10.1e}{misses:>9}", score.error.median, score.error.worst);
        }
    }
    text
}

/// All scores.
///
/// # Errors
/// None that can happen in memory.
pub fn csv(scores: &[Score]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "model",
        "task",
        "contestant",
        "queries",
        "instructions_median",
        "instructions_99",
        "instructions_most",
        "nanoseconds_median",
        "nanoseconds_99",
        "nanoseconds_most",
        "error_median",
        "error_99",
        "error_most",
        "misses",
        "unanswered",
    ])?;
    for score in scores {
        let numbers = |spread: Spread<u64>| [spread.median, spread.most, spread.worst].map(|number| number.to_string());
        let errors = [score.error.median, score.error.most, score.error.worst].map(|error| format!("{error:.3e}"));
        let head =
            [score.model.clone(), score.task.name().to_owned(), score.contestant.clone(), score.queries.to_string()];
        let tail = [score.misses.to_string(), score.unanswered.to_string()];
        let record = head.into_iter().chain(numbers(score.instructions)).chain(numbers(score.nanoseconds));
        writer.write_record(record.chain(errors).chain(tail))?;
    }
    Ok(writer.into_inner()?)
}

/// `1,234,567`.
pub(super) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let lead = digits.len() % 3;
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && index % 3 == lead % 3 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn digits_are_grouped_by_thousands() {
        assert_eq!(
            [0, 999, 1_000, 12_345, 123_456, 1_234_567].map(grouped),
            ["0", "999", "1,000", "12,345", "123,456", "1,234,567"]
        );
    }
}
