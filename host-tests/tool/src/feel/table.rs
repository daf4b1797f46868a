//! Rows as text and as CSV, and a device on a line.

use super::rows::Row;
use crate::report::{Table, contacts_lost as contacts};
use palpate_sim::feel::{BANDS, Deed, ROUND};
use std::fmt::Write as _;
use std::path::Path;

/// Steps are held against their bound up to this speed, m/s.
pub const BOUND_SPEED: f64 = 0.3;

/// A level, dB, in words: a missing signal has none.
fn in_words(level: f64) -> String {
    if level > -60.0 { format!("{level:.1}") } else { "none".to_owned() }
}

fn or_dash(value: Option<String>) -> String {
    value.unwrap_or_else(|| "-".to_owned())
}

fn percent(share: f64) -> String {
    format!("{:.1}", share * 100.0)
}

/// Columns: heading, unit, and how wide it is in text.
const COLUMNS: [(&str, &str, usize); 14] = [
    ("hand", "", 22),
    ("contact", "mN", 8),
    ("release", "mN", 8),
    ("any", "mN", 8),
    ("ripple", "mN", 8),
    ("by bands", "mN", 24),
    ("dB", "", 8),
    ("at Hz", "", 8),
    ("force, N", "", 9),
    ("error %", "", 8),
    ("drag, N", "", 8),
    ("after", "ms", 7),
    ("turn mm", "", 8),
    ("finer", "", 7),
];

fn cells(Row { script, figures, force_error, turn, finer, .. }: &Row) -> [String; COLUMNS.len()] {
    // In free air there is no force: the vibration is the scripted hand's own, which turns round at once.
    let is_air = script.deed == Deed::Air;
    let [contact, release, any] =
        [figures.steps.contact, figures.steps.release, figures.steps.any].map(|step| format!("{:.1}", step * 1e3));
    [
        script.name.clone(),
        contact,
        release,
        any,
        format!("{:.1}", figures.ripple * 1e3),
        figures.bands.map(|band| format!("{:.1}", band * 1e3)).join(" "),
        or_dash((!is_air).then(|| in_words(figures.sensation.level))),
        or_dash((!is_air).then(|| format!("{:.0}", figures.sensation.frequency))),
        format!("{:.3}", figures.force),
        or_dash(force_error.map(percent)),
        or_dash(is_air.then(|| format!("{:.3}", figures.drag))),
        format!("{:.1}", figures.afterglow * 1e3),
        or_dash(turn.map(|turn| format!("{:.2}", turn * 1e3))),
        or_dash(finer.map(|factor| format!("{factor}x"))),
    ]
}

/// A table of a device's rows; forces in mN, times in ms.
pub fn text(rows: &[Row]) -> String {
    let head = COLUMNS.map(|(name, ..)| name.to_owned());
    let mut text = String::new();
    for row in std::iter::once(head).chain(rows.iter().map(cells)) {
        for (index, (cell, (.., width))) in row.iter().zip(COLUMNS).enumerate() {
            let _ = match index {
                0 => write!(text, "{cell:<width$}"),
                5 => write!(text, "  {cell:<width$}"),
                _ => write!(text, "{cell:>width$}"),
            };
        }
        text.push('\n');
    }
    text
}

/// The scripts in which the loop released contacts, and the reason; empty if there are none.
pub fn contacts_lost(rows: &[Row]) -> String {
    let rows = rows.iter().filter(|row| row.contacts_lost > 0);
    let lines = rows.map(|row| format!("contacts lost, {}: {}\n", row.script.name, contacts(row.contacts_lost)));
    lines.collect()
}

/// The same for a report.
pub fn table(rows: &[Row]) -> Table {
    let head = COLUMNS.map(|(name, unit, _)| format!("{name}\n{unit}").trim_end().to_owned());
    Table { head: head.to_vec(), rows: rows.iter().map(|row| cells(row).to_vec()).collect() }
}

/// Writes the rows of all devices; SI units.
///
/// # Errors
/// The file system's error.
pub fn write_csv(rows: &[(&str, Vec<Row>)], path: &Path) -> csv::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    let mut header = vec!["device", "hand", "contact_step", "release_step", "any_step", "ripple"];
    header.extend(BANDS.map(|band| band.name));
    header.extend([
        "level_db",
        "level_hz",
        "force",
        "depth",
        "force_error",
        "drag",
        "touches",
        "force_after",
        "turn",
        "finer",
    ]);
    writer.write_record(header)?;
    for (device, rows) in rows {
        for Row { script, figures, force_error, turn, finer, .. } in rows {
            let optional = |value: &Option<f64>| value.map_or_else(String::new, |value| value.to_string());
            let mut row = vec![(*device).to_owned(), script.name.clone()];
            let steps = figures.steps;
            row.extend([steps.contact, steps.release, steps.any, figures.ripple].map(|step| step.to_string()));
            row.extend(figures.bands.map(|band| band.to_string()));
            row.extend([figures.sensation.level, figures.sensation.frequency].map(|number| number.to_string()));
            row.extend([figures.force, figures.depth].map(|number| number.to_string()));
            row.push(optional(force_error));
            row.extend([figures.drag.to_string(), figures.touches.to_string(), figures.afterglow.to_string()]);
            row.extend([turn, finer].map(optional));
            writer.write_record(row)?;
        }
    }
    writer.flush()?;
    Ok(())
}

/// The worst of a device's rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The largest step at contact, up to 0.3 m/s, N.
    pub contact: f64,
    /// At release, as far, N.
    pub release: f64,
    /// Off an edge or a corner, as far, N; none without a body.
    pub off: Option<f64>,
    /// The longest time for which there was force on a probe that touched nothing, s.
    pub after: f64,
    /// The strongest sensation at rest, dB.
    pub rest: f64,
    /// Sliding, smooth seams included, dB.
    pub slide: Option<f64>,
    /// The factor of finer encoders that hides a perceptible slide.
    pub finer: Option<f64>,
    /// Maximum error of the steady force, as a fraction.
    pub error: f64,
    /// Maximum force in front of the wall, N.
    pub hover: f64,
    /// Drag in free air, N.
    pub drag: f64,
    /// The longest turn of the force's direction round a convex edge, m.
    pub turn: Option<f64>,
}

impl Worst {
    /// Of these rows.
    pub fn of(rows: &[Row]) -> Self {
        let most = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::max);
        let of = |like: fn(&Deed) -> bool, figure: fn(&Row) -> f64| {
            most(&mut rows.iter().filter(|row| like(&row.script.deed)).map(figure))
        };
        let slow = |deed: &Deed| matches!(deed, Deed::Approach(speed) if *speed <= BOUND_SPEED);
        let smooth = |deed: &Deed| matches!(deed, Deed::Slide | Deed::Across(None));
        let zero = |value: Option<f64>| value.unwrap_or(0.0);
        Self {
            contact: zero(of(slow, |row| row.figures.steps.contact)),
            release: zero(of(slow, |row| row.figures.steps.release)),
            off: of(|deed| matches!(deed, Deed::Off(speed) if *speed <= BOUND_SPEED), |row| row.figures.steps.any),
            after: zero(of(|_| true, |row| row.figures.afterglow)),
            rest: of(|deed| *deed == Deed::Rest, |row| row.figures.sensation.level).unwrap_or(f64::NEG_INFINITY),
            slide: of(smooth, |row| row.figures.sensation.level),
            finer: most(&mut rows.iter().filter_map(|row| row.finer)),
            error: zero(of(|deed| *deed == Deed::Rest, |row| row.force_error.map_or(0.0, f64::abs))),
            hover: zero(of(|deed| matches!(deed, Deed::Hover | Deed::Air), |row| row.figures.force)),
            drag: zero(of(|deed| *deed == Deed::Air, |row| row.figures.drag)),
            turn: most(&mut rows.iter().filter(|row| row.script.name == ROUND).filter_map(|row| row.turn)),
        }
    }

    /// The heading of [`Self::line`].
    pub fn heading() -> String {
        Self::in_columns(&Self::COLUMNS.map(|(name, _)| name.to_owned()))
    }

    /// A device on a line.
    pub fn line(&self, device: &str) -> String {
        Self::in_columns(&self.cells(device))
    }

    /// Devices as a table of a report.
    pub fn table<'a>(devices: impl Iterator<Item = (&'a str, Self)>) -> Table {
        let rows = devices.map(|(device, worst)| worst.cells(device).to_vec()).collect();
        Table { head: Self::COLUMNS.map(|(name, _)| name.replacen(' ', "\n", 1)).to_vec(), rows }
    }

    const COLUMNS: [(&'static str, usize); 12] = [
        ("device", 20),
        ("contact mN", 10),
        ("release", 10),
        ("off edge", 10),
        ("after ms", 10),
        ("rest dB", 10),
        ("slide dB", 10),
        ("finer", 8),
        ("error %", 9),
        ("hover N", 9),
        ("drag N", 9),
        ("turn mm", 9),
    ];

    fn in_columns(cells: &[String]) -> String {
        let column = |(index, (cell, (_, width))): (usize, (&String, (&str, usize)))| {
            if index == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        };
        cells.iter().zip(Self::COLUMNS).enumerate().map(column).collect()
    }

    fn cells(&self, device: &str) -> [String; Self::COLUMNS.len()] {
        let milli = |value: f64| format!("{:.1}", value * 1e3);
        [
            device.to_owned(),
            milli(self.contact),
            milli(self.release),
            or_dash(self.off.map(milli)),
            milli(self.after),
            in_words(self.rest),
            or_dash(self.slide.map(in_words)),
            or_dash(self.finer.map(|factor| format!("{factor}x"))),
            percent(self.error),
            format!("{:.3}", self.hover),
            format!("{:.3}", self.drag),
            or_dash(self.turn.map(|turn| format!("{:.2}", turn * 1e3))),
        ]
    }
}
