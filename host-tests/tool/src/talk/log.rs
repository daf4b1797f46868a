//! The log of a device: its views at a stated rate, as rows of a CSV file, with the rows that are missing counted.

use anyhow::Context as _;
use palpate_link::View;
use std::fs::File;
use std::path::Path;

/// Bytes of a view on the line at most, with its frame: a log of 1 kHz needs 63 kB/s.
const BYTES: u32 = 63;

/// A log that grows. SI units, the point in the scene's frame.
#[derive(Debug)]
pub struct Log {
    writer: csv::Writer<File>,
    /// Servo rate and the log's own, Hz.
    rates: [f64; 2],
    /// The row that came last and the first, as its number at the log's rate since the device's start.
    last: Option<u64>,
    rows: u64,
    missing: u64,
}

impl Log {
    /// A new file, for a device of this servo rate, Hz, and rows at `rate`, Hz.
    ///
    /// # Errors
    /// A rate above the servo's, or a file that cannot be written.
    pub fn create(path: &Path, servo_rate: f64, rate: f64) -> anyhow::Result<Self> {
        anyhow::ensure!(
            rate >= 1.0 && rate <= servo_rate,
            "--log-rate is {rate} Hz; set 1 Hz to the servo rate, {servo_rate} Hz"
        );
        let mut writer =
            csv::Writer::from_path(path).with_context(|| format!("{}: cannot be written", path.display()))?;
        writer.write_record([
            "tick",
            "time",
            "missing",
            "phase",
            "fault",
            "hold",
            "body",
            "contact",
            "feature",
            "gap",
            "position_x",
            "position_y",
            "position_z",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "force_x",
            "force_y",
            "force_z",
        ])?;
        Ok(Self { writer, rates: [servo_rate, rate], last: None, rows: 0, missing: 0 })
    }

    /// Takes the views that came: of those of one period of the log the first, as a row.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take(&mut self, views: &[View]) -> anyhow::Result<()> {
        let [servo_rate, rate] = self.rates;
        for view in views {
            let time = f64::from(view.tick) / servo_rate;
            // A tick on the border belongs to the period that it starts.
            let period = (f64::from(view.tick) * rate / servo_rate + 1e-9) as u64;
            let missing = match self.last {
                Some(last) if period == last => continue,
                Some(last) if period > last => period - last - 1,
                // The first row, or a device that was reset.
                _ => 0,
            };
            self.last = Some(period);
            (self.rows, self.missing) = (self.rows + 1, self.missing + missing);
            let mut row = vec![view.tick.to_string(), time.to_string(), missing.to_string()];
            row.extend([view.phase, view.fault, view.hold, view.body, view.contact].map(|number| number.to_string()));
            row.extend([view.feature.to_string(), view.gap.to_string()]);
            row.extend(
                [view.position, view.velocity, view.force].as_flattened().iter().map(|number| number.to_string()),
            );
            self.writer.write_record(row)?;
        }
        Ok(())
    }

    /// Writes the last rows; the sentence counts those that came and those that are missing.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn end(mut self) -> anyhow::Result<String> {
        self.writer.flush()?;
        let (Self { rows, missing, rates: [_, rate], .. }, needed) = (&self, f64::from(BYTES) * self.rates[1] * 1e-3);
        let remedy = if *missing == 0 {
            String::new()
        } else {
            format!(": {rate} Hz needs {needed:.0} kB/s; use USB or a lower --log-rate")
        };
        Ok(format!("log: {rows} rows at {rate} Hz, {missing} missing{remedy}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::math::Vec3;
    use palpate::wire::hold;
    use palpate_link::{Device, SILENCE};
    use palpate_sim::simulated::{Kind, Simulated};
    use std::time::Duration;

    /// Rows, the sentence at the end, and the loop's own record: tick, gap, force.
    type Logged = (Vec<csv::StringRecord>, String, Vec<(u32, f32, Vec3)>);

    /// Two seconds of a hand that presses the box, logged at 1 kHz.
    fn logged(bytes_per_tick: u32) -> Logged {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let line = Simulated::new(Kind { bytes_per_tick, ..Kind::default() }).unwrap();
        let hand = line.hand();
        let mut device = Device::over(line).unwrap();
        hand.goes_to([0.03, 0.02, 0.03]);
        // It asks for a button that it has seen released.
        while device.view(SILENCE).unwrap().hold & hold::RELEASE_FIRST != 0 {}
        hand.enables(true);
        device.line().own_record();
        let mut log = Log::create(&path, 4_000.0, 1_000.0).unwrap();
        device.take_views();
        let until = device.now() + Duration::from_secs(2);
        while device.now() < until {
            device.view(Duration::from_millis(10)).unwrap();
            log.take(&device.take_views()).unwrap();
        }
        let said = log.end().unwrap();
        let rows = csv::Reader::from_path(&path).unwrap().into_records().collect::<Result<_, _>>().unwrap();
        (rows, said, device.line().own_record())
    }

    #[test]
    fn a_line_as_quick_as_usb_carries_each_row_with_the_loop_s_own_values() {
        // 480 kB/s; full-speed USB carries about twice as much.
        let (rows, said, own) = logged(120);
        println!("{said}: {} ticks", own.len());
        assert!(said.ends_with("rows at 1000 Hz, 0 missing"), "{said}");
        assert!(rows.len().abs_diff(own.len() / 4) <= 2, "{} rows of {} ticks", rows.len(), own.len());
        let mut pushed = 0;
        for row in &rows {
            let number = |column: usize| row[column].parse::<f32>().unwrap();
            let tick: u32 = row[0].parse().unwrap();
            let Some((_, gap, force)) = own.iter().find(|(of, ..)| *of == tick) else { continue };
            assert_eq!((number(9), [16, 17, 18].map(number)), (*gap, force.to_array()), "tick {tick}");
            pushed += u32::from(*gap < 0.0 && force.length() > 0.1);
        }
        assert!(pushed > 500, "{pushed}");
    }

    #[test]
    fn rows_that_a_slow_line_cannot_carry_are_counted() {
        let (rows, said, own) = logged(12);
        println!("{said}");
        let missing: usize = rows.iter().map(|row| row[2].parse::<usize>().unwrap()).sum();
        assert!(
            missing > 100 && said.contains(&format!("{missing} missing: 1000 Hz needs 63 kB/s; use USB")),
            "{said}"
        );
        assert!((rows.len() + missing).abs_diff(own.len() / 4) <= 2, "{} + {missing}: {}", rows.len(), own.len());
    }
}
