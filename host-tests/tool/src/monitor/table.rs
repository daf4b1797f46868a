//! Every record as a row of a CSV file; SI units, but for microseconds where the name says so.

use super::Figures;
use std::fs::File;
use std::path::Path;

/// A CSV file that grows.
#[derive(Debug)]
pub struct Table(csv::Writer<File>);

impl Table {
    /// Names of the columns.
    const COLUMNS: [&str; 33] = [
        "tick",
        "number",
        "rate",
        "shortest_us",
        "longest_us",
        "took_us",
        "dropped",
        "phase",
        "fault",
        "fault_tick",
        "reset",
        "overruns",
        "feature",
        "mode",
        "contact",
        "gap",
        "probe_x",
        "probe_y",
        "probe_z",
        "force_x",
        "force_y",
        "force_z",
        "force",
        "duty_a",
        "duty_b",
        "duty_c",
        "clock",
        "bridged",
        "hold",
        "bad_frames",
        "gain_a",
        "gain_b",
        "gain_c",
    ];

    /// A new file, in place of any that was there.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn create(path: &Path) -> csv::Result<Self> {
        let mut writer = csv::Writer::from_path(path)?;
        writer.write_record(Self::COLUMNS)?;
        Ok(Self(writer))
    }

    /// One more row.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&mut self, figures: &Figures) -> csv::Result<()> {
        let record = &figures.record;
        let mut row = vec![record.tick.to_string(), record.number.to_string()];
        row.push(figures.rate.map_or_else(String::new, |rate| rate.to_string()));
        row.extend([figures.periods[0], figures.periods[1], figures.took].map(|time| time.to_string()));
        row.push(record.dropped.to_string());
        row.extend([record.phase, record.fault].map(|number| number.to_string()));
        row.extend([record.fault_tick, u32::from(record.reset), record.overruns].map(|number| number.to_string()));
        row.push(record.feature.to_string());
        row.extend([record.mode, record.contact].map(|number| number.to_string()));
        row.push(record.gap.to_string());
        row.extend(record.probe.iter().chain(&record.force).map(|component| component.to_string()));
        row.push(figures.force().to_string());
        row.extend(record.duties.map(|duty| duty.to_string()));
        row.push(record.clock.to_string());
        row.extend([record.bridged, u32::from(record.hold)].map(|number| number.to_string()));
        row.push(record.bad_frames.to_string());
        row.extend(record.gains.map(|gain| gain.to_string()));
        self.0.write_record(row)
    }

    /// Whatever was written is in the file when this returns.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn flush(&mut self) -> std::io::Result<()> {
        self.0.flush()
    }
}
