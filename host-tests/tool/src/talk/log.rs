//! The log of a device: its views at a stated rate, as rows of a CSV file, with the rows that are missing counted.

use super::console::{degrees, is_knob};
use anyhow::Context as _;
use palpate_link::{DIALS_HZ, Dial, Hello, View};
use std::fs::File;
use std::path::Path;

/// Bytes of a view on the line at most, with its frame: a log of 1 kHz needs 63 kB/s.
const BYTES: u32 = 63;

/// A log that grows. Of an arm in SI units, the point in the scene's frame; of a knob its dial, in degrees.
#[derive(Debug)]
pub struct Log {
    writer: csv::Writer<File>,
    /// Servo rate and the log's own, Hz.
    rates: [f64; 2],
    /// The row that came last, as its number at the log's rate since the device's start.
    last: Option<u64>,
    rows: u64,
    missing: u64,
}

/// The columns of every log.
const FIRST: [&str; 6] = ["tick", "time", "missing", "phase", "fault", "hold"];
const ARM: [&str; 13] = [
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
];
const KNOB: [&str; 7] = ["feel", "detent", "end", "angle_degrees", "rate_degrees_per_s", "torque_mn_m", "turns"];

impl Log {
    /// A new file, for a device and rows at `rate`, Hz; without one, 1 kHz, or the rate at which a knob reports its dial.
    ///
    /// # Errors
    /// A rate above the device's, or a file that cannot be written.
    pub fn create(path: &Path, hello: &Hello, rate: Option<f64>) -> anyhow::Result<Self> {
        let (servo_rate, is_knob) = (f64::from(hello.rate), is_knob(hello));
        let (most, what, columns) = if is_knob {
            (f64::from(DIALS_HZ), "the rate of a knob's reports", KNOB.as_slice())
        } else {
            (servo_rate, "the servo rate", ARM.as_slice())
        };
        let rate = rate.unwrap_or(most.min(1_000.0));
        anyhow::ensure!(rate >= 1.0 && rate <= most, "--log-rate is {rate} Hz; set 1 Hz to {what}, {most} Hz");
        let mut writer =
            csv::Writer::from_path(path).with_context(|| format!("{}: cannot be written", path.display()))?;
        writer.write_record([FIRST.as_slice(), columns].concat())?;
        Ok(Self { writer, rates: [servo_rate, rate], last: None, rows: 0, missing: 0 })
    }

    /// The start of a row, by tick, unless its period has one.
    fn start(&mut self, tick: u32) -> Option<Vec<String>> {
        let [servo_rate, rate] = self.rates;
        // A tick on the border belongs to the period that it starts.
        let period = (f64::from(tick) * rate / servo_rate + 1e-9) as u64;
        let missing = match self.last {
            Some(last) if period == last => return None,
            Some(last) if period > last => period - last - 1,
            // The first row, or a device that was reset.
            _ => 0,
        };
        self.last = Some(period);
        (self.rows, self.missing) = (self.rows + 1, self.missing + missing);
        Some(vec![tick.to_string(), (f64::from(tick) / servo_rate).to_string(), missing.to_string()])
    }

    /// Takes the views that came: of those of one period of the log the first, as a row.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take(&mut self, views: &[View]) -> anyhow::Result<()> {
        for view in views {
            let Some(mut row) = self.start(view.tick) else { continue };
            row.extend([view.phase, view.fault, view.hold, view.body, view.contact].map(|number| number.to_string()));
            row.extend([view.feature.to_string(), view.gap.to_string()]);
            row.extend(
                [view.position, view.velocity, view.force].as_flattened().iter().map(|number| number.to_string()),
            );
            self.writer.write_record(row)?;
        }
        Ok(())
    }

    /// The same of a knob, whose newest view has the phase.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take_dials(&mut self, dials: &[Dial], view: &View) -> anyhow::Result<()> {
        for dial in dials {
            let Some(mut row) = self.start(dial.tick) else { continue };
            row.extend([view.phase, view.fault, view.hold, dial.feel].map(|number| number.to_string()));
            row.extend([dial.detent.to_string(), dial.end.to_string(), degrees(dial).to_string()]);
            row.extend([dial.rate.to_degrees(), 1e3 * dial.torque].map(|number| number.to_string()));
            row.push(dial.turns.to_string());
            self.writer.write_record(row)?;
        }
        Ok(())
    }

    /// Writes the last rows; the sentence counts those that came and those that are missing. A port may be a slow one.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn end(mut self, over_port: bool) -> anyhow::Result<String> {
        self.writer.flush()?;
        let (Self { rows, missing, rates: [_, rate], .. }, needed) = (&self, f64::from(BYTES) * self.rates[1] * 1e-3);
        let remedy = if *missing == 0 {
            String::new()
        } else {
            let usb = if over_port { "USB or " } else { "" };
            format!(": {rate} Hz needs {needed:.0} kB/s; use {usb}a lower --log-rate")
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
    fn logged(bytes_per_tick: u32, over_port: bool) -> Logged {
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
        let mut log = Log::create(&path, &device.hello(), None).unwrap();
        device.take_views();
        let until = device.now() + Duration::from_secs(2);
        while device.now() < until {
            device.view(Duration::from_millis(10)).unwrap();
            log.take(&device.take_views()).unwrap();
        }
        let said = log.end(over_port).unwrap();
        let rows = csv::Reader::from_path(&path).unwrap().into_records().collect::<Result<_, _>>().unwrap();
        (rows, said, device.line().own_record())
    }

    #[test]
    fn a_line_as_quick_as_usb_carries_each_row_with_the_loop_s_own_values() {
        // 480 kB/s; full-speed USB carries about twice as much.
        let (rows, said, own) = logged(120, true);
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
        let (rows, said, own) = logged(12, true);
        println!("{said}");
        // A simulated device has no other line.
        assert!(logged(12, false).1.ends_with("missing: 1000 Hz needs 63 kB/s; use a lower --log-rate"));
        let missing: usize = rows.iter().map(|row| row[2].parse::<usize>().unwrap()).sum();
        assert!(
            missing > 100 && said.contains(&format!("{missing} missing: 1000 Hz needs 63 kB/s; use USB")),
            "{said}"
        );
        assert!((rows.len() + missing).abs_diff(own.len() / 4) <= 2, "{} + {missing}: {}", rows.len(), own.len());
    }
}
