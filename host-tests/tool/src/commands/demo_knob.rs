//! `palpate demo --device knob`: the knob's image on an emulated board, a hand that turns the simulated dial.

use super::progress;
use crate::commission::{Device, KeyHeld};
use crate::firmware::{Board, Image, Link as _, LinkError, Program, Progress, SetUpError, Transport};
use crate::knob::turning::{HostEnd, Turned, curve, free, size, slips_at, ticks, turn, way, worst_detent};
use crate::knob::{
    COMMUTATION, DIAL_ZERO, FEELS, KnobLine, KnobServo, MOTOR, NAMES, PROTECTION, Recording, SEARCH, SharedKnob,
    TOLD_OF_SUPPLY, device, dial, record, recorded, servo,
};
use crate::plot::{Area, Axes, Axis, FIGURE, Ink, Key, Mark, Svg, at_widths, draw};
use crate::report::{Report, Section};
use anyhow::Context;
use palpate::device::Refusal;
use palpate::render::{Feel, FeelPart, Wave};
use palpate::servo::{Fault, Phase};
use palpate_sim::plant::DialSettings;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

/// A run, and what it was.
pub struct Run {
    /// The loop's table, and its names.
    table: (&'static [Feel], &'static [&'static str]),
    /// Every tick.
    pub turned: Vec<Turned>,
    /// The image, where there is one.
    image: Option<Image>,
}

/// Runs the knob's image, or its loop compiled for the host, with the map of its motor's cogging and without.
///
/// # Errors
/// A build, a run or a file that failed.
pub fn run(board: Board, host: bool, file: &Path, picture: Option<&Path>) -> anyhow::Result<ExitCode> {
    let run = |compensated: bool| if host { on_host(compensated) } else { on_board(board, compensated) };
    let (with, without) = (run(true)?, run(false)?);
    let on = match &with.image {
        Some(_) => format!("firmware on an emulated {} ({}) over fifo", board.core(), board.machine()),
        None => "the loop compiled for the host".to_owned(),
    };
    let subtitle = format!("a knob on a motor with three phases, {on}");
    let figures = figures(&with, &without);
    let sections = sections(&with, &without);
    Report { headline: ["palpate demo", &subtitle], link: None, figures: &figures, sections: &sections }.write(file)?;
    if let Some(picture) = picture {
        fs::write(picture, drawn(&with, &without)).with_context(|| format!("cannot write {}", picture.display()))?;
    }
    println!("palpate demo: {subtitle}");
    for (name, value) in &figures {
        println!("  {name:<20} {value}");
    }
    println!("  {:<20} {}", "report", file.display());
    Ok(ExitCode::SUCCESS)
}

/// On the host.
///
/// # Errors
/// None.
pub fn on_host(compensated: bool) -> anyhow::Result<Run> {
    let cogging = recorded::COGGING.filter(|_| compensated);
    let servo = servo(Box::leak(Box::new(device(cogging))), SEARCH, TOLD_OF_SUPPLY);
    through(servo, (&FEELS, &NAMES))
}

/// A loop with this table.
fn through(servo: KnobServo, table: (&'static [Feel], &'static [&'static str])) -> anyhow::Result<Run> {
    let mut end = HostEnd::new(servo);
    let turned = turn(dial(), table.0, |sensors| Ok(end.exchange(sensors)), |_| ())?;
    Ok(Run { table, turned, image: None })
}

/// On an emulated board, or on the host where no emulator can be had.
///
/// # Errors
/// A build or a run that failed.
pub fn on_board(board: Board, compensated: bool) -> anyhow::Result<Run> {
    let features: &[&str] = if compensated { &["knob"] } else { &["uncompensated"] };
    let program = match Program::prepare(board, "knob", features, &Progress::new()) {
        Ok(program) => program,
        Err(error @ (SetUpError::NoEmulator(_) | SetUpError::NoToolchain(_))) => {
            eprintln!("{error}");
            eprintln!("running the same loop compiled for the host instead; nothing is counted there");
            return on_host(compensated);
        }
        Err(error) => return Err(error.into()),
    };
    let mut emulator = program.start_over(Transport::Fifo)?;
    let bar = progress::ticks(ticks(&FEELS));
    let exchange = |sensors: &_| -> Result<_, LinkError> { emulator.exchange(sensors) };
    let turned = turn(dial(), &FEELS, exchange, |done| bar.tell(done))?;
    Ok(Run { table: (&FEELS, &NAMES), turned, image: Some(program.image.clone()) })
}

/// The first feel of a table that has detents and damping alone.
fn detents(feels: &[Feel]) -> Option<(u8, Wave)> {
    feels.iter().zip(0..).find_map(|(feel, index)| {
        let detents = feel.detents?;
        let rest = feel.with(FeelPart::Detents(None)).with(FeelPart::Damping(0.0));
        (rest == Feel::FREE).then_some((index, detents))
    })
}

fn figures(with: &Run, without: &Run) -> Vec<(&'static str, String)> {
    let ((feels, _), turned, plain) = (with.table, &with.turned, &without.turned);
    let detents = detents(feels).map(|(feel, wave)| {
        let (pitch, torque) = (f64::from(wave.pitch_rad), f64::from(wave.torque_n_m));
        let off = |turned: &[Turned]| 100.0 * worst_detent(&curve(turned, feel), pitch, torque);
        let (off, plain) = (off(turned), off(plain));
        format!("off by at most {off:.2} % of {:.0} mN·m; {plain:.1} % without the map", 1e3 * torque)
    });
    let detents = detents.unwrap_or_else(|| "not measured: no feel of the table has detents alone".to_owned());
    let cogging = |turned: &[Turned]| match free(feels) {
        Some(free) => {
            let [rms, most] = size(&curve(turned, free)).map(|torque| 1e3 * torque);
            format!("{rms:.2} mN·m rms, {most:.2} at most")
        }
        None => "not measured: no feel of the table is free".to_owned(),
    };
    let aligned = turned.iter().position(|sample| sample.report.phase == Phase::Armed as u8);
    let fault = turned.iter().position(|sample| sample.report.fault != 0);
    let told = fault.map_or_else(
        || "none".to_owned(),
        |tick| {
            let quiet =
                turned[tick..].iter().all(|sample| sample.current == 0.0 && sample.report.duties == [i16::MIN; 3]);
            if aligned.is_none() {
                let why = Refusal::from_code(turned[tick].report.refusal);
                return why.map_or_else(|| "not aligned".to_owned(), |why| format!("not aligned: {why}"));
            }
            let name = Fault::from_code(turned[tick].report.fault).map_or_else(String::new, |fault| fault.to_string());
            if tick < slips_at(feels) as usize {
                return format!("none planted: {name} after {:.2} s", turned[tick].time);
            }
            format!(
                "planted, magnet slipped: {name}; {}",
                if quiet { "no current from that tick on" } else { "STILL DRIVEN" }
            )
        },
    );
    let mut figures = vec![
        ("ticks", format!("{} at {} Hz", turned.len(), crate::knob::SETTINGS.rate_hz)),
        ("motor", motor()),
        ("rotor aligned", aligned.map_or_else(|| "no".to_owned(), |tick| format!("after {:.2} s", turned[tick].time))),
        ("detents", detents),
        ("cogging", cogging(plain)),
        ("with the map", cogging(turned)),
        ("fault", told),
        ("state hash", format!("{:08x}", hash(turned))),
    ];
    if let Some(image) = &with.image {
        let mut counts: Vec<u32> = turned.iter().map(|sample| sample.report.instructions).collect();
        counts.sort_unstable();
        let (median, worst) = (counts[counts.len() / 2], counts[counts.len() - 1]);
        figures.push(("instructions a tick", format!("{median} median, {worst} at most")));
        figures.push(("flash", format!("{} bytes", image.flash)));
        figures.push(("RAM, static", format!("{} bytes", image.ram)));
    }
    figures
}

/// The motor's torque at full duty; the knob's, at most its limit, at first and continuously; the torque that aligns it.
fn motor() -> String {
    let full = MOTOR.motors[0].torque_at_full_n_m;
    let most = full.min(MOTOR.max_force_n * MOTOR.kinematics.radius_m);
    let continuous = most.min(full * PROTECTION.motors[0].continuous);
    format!(
        "{} pole pairs, {:.0} mN·m at full duty; the knob has {:.0}, {:.0} continuous; aligned with {:.0}",
        COMMUTATION.pole_pairs,
        1e3 * f64::from(full),
        1e3 * f64::from(most),
        1e3 * f64::from(continuous),
        1e3 * f64::from(SEARCH.torque_n_m)
    )
}

/// Over the digests of all ticks: two runs that agree in it agreed in every bit.
pub fn hash(turned: &[Turned]) -> u32 {
    turned.iter().fold(0x811c_9dc5_u32, |hash, sample| (hash ^ sample.report.digest).wrapping_mul(0x0100_0193))
}

/// Points in degrees and mN·m.
type Line = Vec<(f64, f64)>;

fn in_degrees(curve: &[(f64, f64)]) -> Line {
    curve.iter().map(|(angle, torque)| (angle.to_degrees(), 1e3 * torque)).collect()
}

/// The table's torque at the angles of a curve.
fn asked(feel: &Feel, curve: &[(f64, f64)]) -> Line {
    let mut click = 0;
    let torque = |angle: f64, click: &mut i32| f64::from(feel.torque(click, angle as f32, 0.0));
    curve.iter().map(|(angle, _)| (angle.to_degrees(), 1e3 * torque(*angle, &mut click))).collect()
}

fn sections(with: &Run, without: &Run) -> Vec<Section> {
    let ((feels, names), cogging) = (with.table, cogging(with, without));
    let with = &with.turned;
    let section = |heading: &str, note: &str, axes: [&str; 2], lines: &[Curve<'_>]| Section {
        heading: heading.to_owned(),
        note: note.to_owned(),
        drawing: Some(at_widths(280.0, |svg, area| chart(svg, area, "", axes, lines))),
        table: None,
    };
    let angle = ["angle, degrees", "torque, mN·m"];
    let mut sections: Vec<Section> = (feels.iter().zip(names).zip(0..))
        .filter(|(_, index)| free(feels) != Some(*index))
        .map(|((of, name), feel)| {
            let ways = [0, 1].map(|back| in_degrees(&way(with, feel, back)));
            let note = "Torque at the shaft on the way there and back, and what the table asks of a dial at rest.";
            let [there, back] = ways;
            let asked = asked(of, &curve(with, feel));
            let lines = [("there", Ink::Blue, there), ("back", Ink::Red, back), ("asked", Ink::Green, asked)];
            section(name, note, angle, &lines)
        })
        .collect();
    if let Some(cogging) = &cogging {
        sections.push(section("cogging", "Torque with nothing asked for.", angle, cogging));
    }
    let over_time = |of: fn(&Turned) -> f64| -> Line { with.iter().map(|sample| (sample.time, of(sample))).collect() };
    sections.push(section(
        "phases",
        "The rotor is aligned, every feel is turned through there and back, the magnet slips.",
        ["time, s", "largest current of the three phases, A"],
        &[("", Ink::Red, over_time(|sample| sample.current))],
    ));
    if with.iter().any(|sample| sample.report.instructions > 0) {
        sections.push(section(
            "instructions a tick",
            "Counted under the emulator: the loop and the widths of three phases.",
            ["time, s", "instructions"],
            &[("", Ink::Blue, over_time(|sample| f64::from(sample.report.instructions)))],
        ));
    }
    sections
}

/// A name, an ink and points.
type Curve<'a> = (&'a str, Ink, Line);

fn cogging(with: &Run, without: &Run) -> Option<[Curve<'static>; 2]> {
    let free = free(with.table.0)?;
    Some([
        ("without the map", Ink::Red, in_degrees(&curve(&without.turned, free))),
        ("with the map", Ink::Blue, in_degrees(&curve(&with.turned, free))),
    ])
}

/// The detents and the cogging, one below the other, as far as they are measured.
fn drawn(with: &Run, without: &Run) -> String {
    let detents = detents(with.table.0).map(|(feel, _)| {
        let felt = curve(&with.turned, feel);
        let asked = asked(&with.table.0[usize::from(feel)], &felt);
        [("asked", Ink::Green, asked), ("at the shaft", Ink::Blue, in_degrees(&felt))]
    });
    draw(FIGURE, 560.0, |svg, area| {
        let (upper, lower) = area.split_at(280.0);
        let axes = ["angle, degrees", "torque, mN·m"];
        if let Some(detents) = &detents {
            chart(svg, upper, "detents", axes, detents);
        }
        if let Some(cogging) = &cogging(with, without) {
            chart(svg, lower, "cogging", axes, cogging);
        }
    })
}

fn chart(svg: &mut Svg, area: Area, title: &str, [x, y]: [&str; 2], lines: &[Curve<'_>]) {
    let values = |of: fn(&(f64, f64)) -> f64| lines.iter().flat_map(move |(.., line)| line.iter().map(of));
    let keys: Vec<Key<'_>> =
        lines.iter().filter(|(name, ..)| !name.is_empty()).map(|(name, ink, _)| (*name, *ink, Mark::Line)).collect();
    let (x, y) = (Axis::over(x, values(|point| point.0)), Axis::over(y, values(|point| point.1)));
    let mut chart = Axes { title, x, y, keys: &keys }.on(svg, area);
    lines.iter().for_each(|(_, ink, line)| chart.line(*ink, 1.5, line.iter().copied()));
}

/// The cogging of the simulated dial, recorded again over the line of the boards' loop, as the source that the image is
/// built with.
///
/// # Errors
/// A rotor that does not follow its field.
pub fn recorded_source() -> anyhow::Result<String> {
    let settings = dial();
    debug_assert!((settings.sensor.angle_at_zero - DIAL_ZERO).abs() < 1e-12);
    Ok(recorded_of(settings)?.source("the simulated gimbal motor"))
}

/// The cogging of a simulated dial, recorded so.
///
/// # Errors
/// As [`recorded_source`]'s.
pub fn recorded_of(settings: DialSettings) -> anyhow::Result<Recording> {
    let mut knob = SharedKnob::new(settings);
    let mut device = Device::connect(Box::new(KnobLine::new(&knob)), Box::new(KeyHeld))?;
    record(&mut device, &mut knob)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knob::{LET_GO, SETTINGS, homing};
    use palpate::servo::{Config, Knob, Servo};

    /// The boards' table and a feel after its free one.
    static MORE: [Feel; FEELS.len() + 1] = {
        let mut feels = [Feel { damping_n_m_s_per_rad: 2e-3, ..Feel::FREE }; FEELS.len() + 1];
        let mut index = 0;
        while index < FEELS.len() {
            feels[index] = FEELS[index];
            index += 1;
        }
        feels
    };

    #[test]
    fn a_feel_after_the_free_one_changes_no_other_figure() {
        static KNOB: Knob = Knob::new(&MOTOR, &MORE, LET_GO);
        let more = |cogging| {
            let device = Box::leak(Box::new(device(cogging)));
            let config = Config { settings: SETTINGS, homing: Some(homing(SEARCH)), ..Config::DEFAULT };
            let servo = Servo::protected(device, &KNOB, TOLD_OF_SUPPLY, config);
            let names: Vec<_> = NAMES.into_iter().chain(["mine"]).collect();
            through(servo, (&MORE, names.leak())).expect("it runs")
        };
        let (with, without) = (more(recorded::COGGING), more(None));
        let usual = figures(&on_host(true).expect("it runs"), &on_host(false).expect("it runs"));
        let found = figures(&with, &without);
        for name in ["detents", "cogging", "with the map", "fault"] {
            let [usual, found] = [&usual, &found].map(|of| of.iter().find(|(of, _)| *of == name).expect("a figure"));
            assert_eq!(usual, found);
        }
        let headings: Vec<_> = sections(&with, &without).into_iter().map(|section| section.heading).collect();
        let felt = NAMES.into_iter().filter(|name| *name != "free").chain(["mine", "cogging", "phases"]);
        assert_eq!(headings, felt.collect::<Vec<_>>());
    }
}
