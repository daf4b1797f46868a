//! The size of baked tables in flash, and the properties of their locator.

use crate::firmware::{BenchBoard, Kind};
use palpate::body::{
    Body, Effort, MAX_EVALUATIONS, MAX_EVALUATIONS_CONVEX, MAX_EVALUATIONS_PER_CANDIDATE,
    MAX_EVALUATIONS_PER_CANDIDATE_CONVEX, TickLimit, TickWork,
};
use palpate_bake::body::{BakedBody, BodyBytes, room};
use palpate_bake::locator::{LeafCounts, LocatorReport};
use palpate_bake::survey::Survey;
use std::fmt::{Error, Write as _};

/// The report on a body.
pub(super) fn of_body(body: &BakedBody, locator: &LocatorReport) -> Result<String, Error> {
    let mut report = String::new();
    let bytes = BodyBytes::of(body);
    for (kind, bytes) in bytes.by_kind() {
        row(&mut report, kind, bytes, "")?;
    }
    row(&mut report, "all", bytes.total(), "bytes of flash on a 32-bit target")?;
    leaves(&mut report, locator)?;
    let (most, per_candidate) = if body.is_convex {
        (MAX_EVALUATIONS_CONVEX, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX)
    } else {
        (MAX_EVALUATIONS, MAX_EVALUATIONS_PER_CANDIDATE)
    };
    let (most, longest) = (usize::from(most), locator.longest * usize::from(per_candidate));
    let stopped = if longest > most { "; a search that is not done by then is stopped, and says so" } else { "" };
    row(
        &mut report,
        "cold start",
        longest.min(most),
        &format!("evaluations at most{stopped}; {} entries in the longest list", locator.longest),
    )?;
    Ok(report)
}

/// The report on patches without a body: there is neither feature nor locator.
pub(super) fn of_patches(surveys: &[Survey]) -> Result<String, Error> {
    let mut report = String::new();
    let sum = |kind: fn(&Survey) -> usize| surveys.iter().map(kind).sum::<usize>();
    row(&mut report, "coefficients", sum(|survey| survey.bytes.coefficients), "")?;
    row(&mut report, "borders", sum(|survey| survey.bytes.breaks), "")?;
    row(&mut report, "records", sum(|survey| survey.bytes.record), "")?;
    row(&mut report, "all", sum(|survey| survey.bytes.total()), "bytes of flash on a 32-bit target")?;
    Ok(report)
}

/// The proved worst case of a tick with the effort that fits the limit, and of a pass of the audit, which is longer
/// before the body has its locator.
pub(super) fn of_tick(body: &Body<'_>, limit: TickLimit, is_located: bool) -> Result<String, Error> {
    let mut report = String::new();
    let (worst, cycles, effort) = (body.worst_tick(TickWork::EACH), body.worst_cycles(), body.effort());
    let TickLimit { evaluations, cycles: granted } = limit;
    let meaning = format!(
        "evaluations at most of {evaluations}, {cycles} modelled cycles of a Cortex-M4F of {granted}, at effort {},{}",
        effort.steps, effort.candidates
    );
    row(&mut report, "worst tick", worst.cost as usize, &meaning)?;
    if !body.is_convex() {
        let alone = body.with_effort(Effort::ONE).audit_ticks();
        let over = if is_located {
            "a pass over a cell's candidates (proved)"
        } else {
            "a pass over all faces (proved, before a locator is baked; for a device see `palpate bake --table-report`)"
        };
        let meaning = format!(
            "ticks at most in {over}, {alone} at effort 1,1; two passes take a nearer point that six evaluations find"
        );
        row(&mut report, "audit", body.audit_ticks() as usize, &meaning)?;
    }
    Ok(report)
}

/// A tick over one patch by itself, which is no body.
pub(super) fn of_patch_tick() -> Result<String, Error> {
    let mut report = String::new();
    row(&mut report, "each tick", 1, "evaluation: one patch by itself has no neighbours, no search and no audit")?;
    Ok(report)
}

/// The size of the body as a file, and of the part that is built in RAM.
pub(super) fn as_file(bytes: usize, body: &BakedBody) -> Result<String, Error> {
    let mut report = String::new();
    row(&mut report, "as a file", bytes, "bytes (.palp), read where they lie")?;
    row(&mut report, "RAM for it", room(body), "bytes on a 32-bit target, for its faces and edges")?;
    Ok(report)
}

/// The names of the bench boards that hold tables of this size.
pub(super) fn fits(bytes: u64) -> String {
    let boards = BenchBoard::ALL.into_iter().filter(|board| board.place(Kind::Alone, bytes).is_some());
    let names: Vec<_> = boards.map(BenchBoard::name).collect();
    if names.is_empty() { "no bench board".to_owned() } else { names.join(", ") }
}

/// The place of tables of this size on each bench board.
pub(super) fn on_boards(bytes: u64) -> Result<String, Error> {
    let mut report = String::new();
    for board in BenchBoard::ALL {
        writeln!(report, "{:<16} {}", format!("on {}", board.name()), board.says(Kind::Alone, bytes))?;
    }
    Ok(report)
}

/// The properties of the locator's leaves. Each is a cell of space, with the list of faces that can own the closest
/// point of its probes.
fn leaves(report: &mut String, locator: &LocatorReport) -> Result<(), Error> {
    let LeafCounts { proved, convex, sampled, deep } = locator.leaves_by;
    let share = |count: usize| format!("{:5.1} %", 100.0 * count as f64 / locator.leaves as f64);
    row(
        report,
        "locator leaves",
        locator.leaves,
        "each list is proved to hold the closest point of every probe of its cell; the way to it:",
    )?;
    for (kind, count, meaning) in [
        ("proved", proved, "each of its rectangles has one minimum, or loses no more than the tolerance"),
        (
            "convex",
            convex,
            "sampled, and wholly outside a convex body: no point that faces the probe is nearest but the closest",
        ),
        ("sampled", sampled, "not proved; random probes found nothing wrong"),
        ("deep", deep, "the same, deeper inside than a fifth of the size"),
    ] {
        row(report, &format!("  {kind}"), count, &format!("{}  {meaning}", share(count)))?;
    }
    if locator.loosest > 0.0 {
        writeln!(
            report,
            "  at most {:.3} mm too far where a second minimum is possible and its loss bounded; sampled cells have no bound",
            1e3 * locator.loosest
        )?;
    }
    Ok(())
}

fn row(report: &mut String, kind: &str, number: usize, meaning: &str) -> std::fmt::Result {
    writeln!(report, "{}", format!("{kind:<16} {number:>8} {meaning}").trim_end())
}
