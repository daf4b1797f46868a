//! The same figures of a recording: of `sim --csv`, or of a real device that records every tick.
//!
//! A real device's probe is known only from its encoders, whose counts would hide the vibration. So its displacement is
//! computed from the force, as that of the device's own mass: `x = F/(m ω²)`. With the added mass of a hand the
//! displacement is smaller.
//!
//! The polarity check's pulses and all that is driven outside of the phase *running* are no force of the surface: in
//! those ticks nothing is touched and there is no force.

use super::figures::Figures;
use super::record::{Recording, Tick};
use super::sensation::Sensation;
use super::spectrum::Spectrum;
use super::threshold::Threshold;
use anyhow::{Context, bail, ensure};
use palpate::servo::Phase;
use std::path::Path;

/// Code of the contact [`palpate::track::Contact::Touching`].
const TOUCHING: f64 = 2.0;

/// Reads a recording, with its own rate.
///
/// # Errors
/// A missing column or a faulty row, by name.
pub fn read(path: &Path) -> anyhow::Result<Recording> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    let headers = reader.headers()?.clone();
    let column = |name: &str| headers.iter().position(|header| header == name);
    let needed = |name: &str| column(name).with_context(|| format!("{}: no column {name:?}", path.display()));
    let axes = |stem: &str| -> anyhow::Result<[usize; 3]> {
        Ok([needed(&format!("{stem}_x"))?, needed(&format!("{stem}_y"))?, needed(&format!("{stem}_z"))?])
    };
    let (probe, force, gap, contact) = (axes("probe")?, axes("force")?, needed("gap")?, needed("contact")?);
    let (time, rate, names) = (column("time"), column("rate"), ["device", "model"].map(column));
    if time.is_none() && rate.is_none() {
        bail!("{}: no column \"time\" or \"rate\"", path.display());
    }
    let [phase, withheld, tick] = ["phase", "withheld", "tick"].map(column);
    let mut recording = Recording::default();
    let mut last_tick = None;
    let (mut first, mut last, mut rates) = (None, 0.0, Vec::new());
    for (row, record) in reader.records().enumerate() {
        let record = record?;
        let at = |index: usize| -> anyhow::Result<f64> {
            let text = record.get(index).unwrap_or_default();
            text.parse::<f64>()
                .ok()
                .filter(|number| number.is_finite())
                .with_context(|| format!("{}: row {}: {text:?} is not a number", path.display(), row + 2))
        };
        let vector = |columns: [usize; 3]| -> anyhow::Result<[f64; 3]> {
            Ok([at(columns[0])?, at(columns[1])?, at(columns[2])?])
        };
        if let Some(column) = time {
            last = at(column)?;
            first = first.or(Some(last));
        } else if let Some(column) = rate
            && record.get(column).is_some_and(|text| !text.is_empty())
        {
            rates.push(at(column)?);
        }
        for (kept, column) in [&mut recording.device, &mut recording.model].into_iter().zip(names) {
            let Some(name) = column.and_then(|column| record.get(column)) else { continue };
            let kept = kept.get_or_insert_with(|| name.to_owned());
            if kept != name || name.is_empty() {
                bail!(
                    "{}: row {} is of {name:?}, the rows before it of {kept:?}; record one device and one model a file",
                    path.display(),
                    row + 2
                );
            }
        }
        if let Some(now) = tick.map(at).transpose()?
            && let Some(before) = last_tick.replace(now)
        {
            ensure!(
                now - before == 1.0,
                "{}: row {}: tick {now} comes after {before}, and steps and ripple need every tick: record with `palpate sim \
                 --csv`, or set `ticks_per_record: 1` in boards/pico2/src/set_up.rs or boards/teensy41/src/set_up.rs, \
                 flash the board and record with `palpate monitor --csv` (the Nucleo's line is too slow)",
                path.display(),
                row + 2
            );
        }
        let is_rendered = phase.map(at).transpose()?.is_none_or(|phase| phase == f64::from(Phase::Running as u8))
            && withheld.map(at).transpose()?.is_none_or(|withheld| withheld == 0.0);
        let force = vector(force)?;
        recording.ticks.push(Tick {
            probe: vector(probe)?,
            force: if is_rendered { force } else { [0.0; 3] },
            hand: [0.0; 3],
            gap: at(gap)?,
            is_touching: is_rendered && at(contact)? == TOUCHING,
        });
    }
    let count = recording.ticks.len();
    if count < 2 {
        bail!("{}: fewer than two ticks", path.display());
    }
    recording.rate = match first {
        Some(first) if last > first => (count - 1) as f64 / (last - first),
        _ => {
            rates.sort_by(f64::total_cmp);
            *rates.get(rates.len() / 2).with_context(|| format!("{}: no rate", path.display()))?
        }
    };
    Ok(recording)
}

/// The figures of a recording on a device of some mass, kg: steps of all of it, ripple of the longest touch.
pub fn figures(recording: &Recording, mass: f64, threshold: &Threshold) -> Figures {
    let (mut longest, mut begin) = (0..0, None);
    for (index, tick) in recording.ticks.iter().enumerate() {
        begin = if tick.is_touching { begin.or(Some(index)) } else { None };
        if let Some(begin) = begin
            && index + 1 - begin > longest.len()
        {
            longest = begin..index + 1;
        }
    }
    // The touch without its first and last twentieth of a second: contact and release.
    let [from, until] = [longest.start, longest.end].map(|index| index as f64 / recording.rate);
    let looked_at = if until - from > 0.4 { [from + 0.05, until - 0.05] } else { [from, until] };
    let mut figures = recording.figures(looked_at, threshold);
    let window = recording.between(looked_at);
    let moved = [0, 1, 2].map(|axis| {
        let force: Vec<f64> = window.iter().map(|tick| tick.force[axis]).collect();
        Spectrum::of(&force, recording.rate).moving(mass)
    });
    let [x, y, z] = moved;
    figures.displacement = x.plus(&y).plus(&z);
    figures.sensation = Sensation::of(&figures.displacement, threshold);
    figures
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use std::fmt::Write as _;

    const HEADER: &str = "time,probe_x,probe_y,probe_z,gap,contact,force_x,force_y,force_z";

    fn file(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    /// Two seconds at 4 kHz: a touch of one second with a tone on a force of 1 N.
    fn touch(peak: f64) -> String {
        let mut text = format!("{HEADER}\n");
        for tick in 0..8_000 {
            let time = f64::from(tick) / 4_000.0;
            let touches = (0.5..1.5).contains(&time);
            let force = if touches { 1.0 + peak * (TAU * 150.0 * time).sin() } else { 0.0 };
            let contact = if touches { 2 } else { 1 };
            writeln!(text, "{time},0,0,0,{},{contact},0,0,{force}", if touches { -0.001 } else { 0.001 }).unwrap();
        }
        text
    }

    #[test]
    fn a_tone_planted_in_a_recording_is_found_at_its_level() {
        let (mass, threshold) = (0.05, Threshold::approximate());
        // The force that moves the mass by the threshold at 150 Hz.
        let peak = mass * (TAU * 150.0_f64).powi(2) * threshold.at(150.0);
        let file = file(&touch(peak));
        let recording = read(file.path()).unwrap();
        // The last digit of a time.
        assert!((recording.rate / 4_000.0 - 1.0).abs() < 1e-9 && recording.ticks.len() == 8_000);
        let figures = figures(&recording, mass, &threshold);
        // Mass and threshold both fall as the frequency squared, so that the window's lobe changes nothing.
        assert!(figures.sensation.level.abs() < 0.1, "{:?}", figures.sensation);
        // The first tick of the touch brings 1 N at once, less what the tone has then.
        assert!(figures.touches == 1 && (figures.steps.contact - 1.0).abs() < peak + 1e-9, "{figures:?}");
    }

    #[test]
    fn what_a_file_lacks_is_said_by_its_name() {
        let refused = |text: &str| format!("{:#}", read(file(text).path()).unwrap_err());
        assert!(refused("time,gap\n0,0\n").contains("no column \"probe_x\""));
        let whole = touch(0.0);
        assert!(refused(&whole.replacen("time", "clock", 1)).contains("no column \"time\" or \"rate\""));
        assert!(refused(&format!("{HEADER}\n0,0,0,0,0,1,0,0,0\n")).contains("fewer than two ticks"));
        let spoilt = format!("{HEADER}\n0,0,0,0,0,1,0,0,0\n1,0,0,oops,0,1,0,0,0\n");
        assert!(refused(&spoilt).contains("row 3: \"oops\" is not a number"));
        let sparse = format!("tick,{HEADER}\n7,0,0,0,0,0,1,0,0,0\n8,1,0,0,0,0,1,0,0,0\n48,2,0,0,0,0,1,0,0,0\n");
        let refusal = refused(&sparse);
        assert!(refusal.contains("row 4: tick 48 comes after 8"), "{refusal}");
        // Where the remedy is, on the boards whose line carries it.
        for file in refusal.split_whitespace().filter(|word| word.ends_with("/set_up.rs")) {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
            let source = std::fs::read_to_string(path).expect(file);
            assert!(source.contains("    ticks_per_record: "), "{file}");
        }
        assert_eq!(refusal.matches("/set_up.rs").count(), 2, "{refusal}");
    }

    #[test]
    fn a_force_is_the_surfaces_only_while_it_is_rendered() {
        let rows = [(2, 0, 3.0), (3, 1, 0.0), (3, 1, 2.0), (3, 1, 0.0), (3, 0, 0.5), (3, 0, 0.7), (4, 0, 4.0)];
        let mut text = format!("{HEADER},phase,withheld\n");
        for (time, (phase, withheld, force)) in rows.into_iter().enumerate() {
            writeln!(text, "{time},0,0,0,-0.001,2,0,0,{force},{phase},{withheld}").unwrap();
        }
        let file = file(&text);
        let recording = read(file.path()).unwrap();
        let forces = recording.ticks.iter().map(|tick| tick.force[2]).collect::<Vec<_>>();
        assert_eq!(forces, [0.0, 0.0, 0.0, 0.0, 0.5, 0.7, 0.0]);
        let figures = figures(&recording, 0.05, &Threshold::approximate());
        assert_eq!((figures.touches, figures.steps.any, figures.afterglow), (1, 0.7, 0.0));
    }

    #[test]
    fn a_recording_without_times_has_the_median_of_its_rates() {
        let text = touch(0.0).replacen("time", "rate", 1);
        let rows = text.lines().enumerate().map(|(index, line)| match (index, line.split_once(',')) {
            (0, _) | (_, None) => line.to_owned(),
            (_, Some((_, rest))) => format!("{},{rest}", if index % 10 == 0 { 900.0 } else { 4_000.0 }),
        });
        let file = file(&rows.collect::<Vec<_>>().join("\n"));
        assert_eq!(read(file.path()).unwrap().rate, 4_000.0);
    }
}
