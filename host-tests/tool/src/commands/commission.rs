//! `palpate commission`: a device on the bench, measured into its file.

use super::demo_knob::recorded_of;
use super::device::toml_of;
use crate::commission::{
    Device, EmulatedLine, Finding, GIVE, Hands, HostLine, Key, KeyHeld, Keyboard, Lab, Line, MOVED, NoKey, Person,
    Planted, PlantedFault, PortLine, RATE, SimulatedHands, World, Zero, angle, begin_within, calibration, find,
    find_mounting, said,
};
use crate::firmware::{Board, Choice, Program, Progress};
use crate::knob;
use anyhow::{Context, bail};
use clap::Args;
use palpate::commission::{Calibration, JogRefusal};
use palpate::wire::{Calibrated, Reading};
use palpate_sim::devices::{self, DeviceFile, HomingEntry, OwnDevice};
use palpate_sim::knob::dial;
use std::io::{IsTerminal, Write as _, stdout};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Commissions a device: jogs its motors one at a time, measures it, writes its file.
///
/// A motor moves only while the device's enable button and the space bar are both held, with at most 0.4 of its full
/// torque; a line silent for 0.1 s counts as a released key. With --emulator or --host the device, its hands and its
/// faults (--plant) are simulated, and nothing is asked.
///
/// Exit status 1: weighing contradicts the file's masses. The entries in doubt are left as they are.
///
/// For a knob (--device knob) the cogging of its motor is recorded while both are held; --out is the file that its
/// image is built from.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Serial port, such as /dev/ttyACM0
    #[arg(long, group = "where")]
    port: Option<String>,
    /// Baud rate
    #[arg(long, default_value_t = 500_000)]
    baud: u32,
    /// Emulated board with a simulated device and hands
    #[arg(long, value_parser = Board::cortex_f(), group = "where")]
    emulator: Option<Board>,
    /// The boards' loop compiled for the host, with a simulated device and hands
    #[arg(long, group = "where")]
    host: bool,
    /// Assumed device: your own file (my.toml), a shipped device, or knob
    #[arg(long, value_name = "DEVICE", default_value = "woodenhaptics-2016")]
    device: PathBuf,
    /// Output: device.toml, for a knob FILE.rs; without it nothing is measured
    #[arg(long, value_name = "FILE", required_unless_present_any = ["jog", "watch", "forget"])]
    out: Option<PathBuf>,
    /// Save the calibration in the device's flash too; used after the next reset
    #[arg(long, requires = "out")]
    keep: bool,
    /// Delete the calibration in the device's flash. After the next reset the device uses its compiled-in calibration
    #[arg(long, conflicts_with_all = ["out", "jog", "watch"])]
    forget: bool,
    /// Encoder reference: jig, stops or index
    #[arg(long, value_enum, default_value_t)]
    zero: Zero,
    /// Measure torque constants and friction too, with known masses
    #[arg(long)]
    weigh: bool,
    /// Time to show counts, angles and holds, without driving, s
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["out", "jog"])]
    watch: Option<f64>,
    /// Motor output to jog (0 to 2) while both keys are held, for --for seconds
    #[arg(long, value_name = "OUTPUT", value_parser = clap::value_parser!(u8).range(0..3), conflicts_with = "out")]
    jog: Option<u8>,
    /// Jog duty, −0.4 to 0.4 of full scale
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, allow_hyphen_values = true)]
    duty: f64,
    /// Jog time, s
    #[arg(long = "for", value_name = "SECONDS", default_value_t = 60.0)]
    seconds: f64,
    /// Planted fault of the simulated device, repeatable: encoder-sign:0, motor-sign:2, ratio:0=1.25, zero:1=0.2,
    /// torque:2=0.8, friction:0=2, encoders:0-1, motors:1-2
    #[arg(long, value_name = "FAULT", conflicts_with = "port")]
    plant: Vec<PlantedFault>,
    /// Print what a person at a port is asked; simulated hands answer
    #[arg(long, conflicts_with = "port")]
    prompts: bool,
}

/// How often a line is shown.
const SHOWN: Duration = Duration::from_millis(100);

/// Runs the command.
///
/// # Errors
/// The missing action of the device or the person; no file is written then.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if arguments.port.is_none() && arguments.emulator.is_none() && !arguments.host {
        bail!("either --port, --emulator or --host");
    }
    let name = arguments.device.to_string_lossy();
    if name == "knob" {
        return record_cogging(arguments);
    }
    let own = crate::devices::own(&arguments.device)?;
    let by_marks = arguments.zero == Zero::Index || own.file.homing == HomingEntry::Index;
    if arguments.emulator.is_some() && by_marks {
        bail!("emulated boards have no index marks; use --port or --host");
    }
    let mut lab = lab(arguments, &own)?;
    say_calibration(&lab.device, &own.file);
    if arguments.forget {
        keep(&mut lab, &own.file, None)?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(seconds) = arguments.watch {
        return watch(&mut lab.device, &own.file, seconds);
    }
    if let Some(output) = arguments.jog {
        return jog(&mut lab, &own.file, (output, arguments.duty), arguments.seconds);
    }
    let Some(out) = &arguments.out else { bail!("--out FILE is required") };
    let (file, findings, weights) = if arguments.weigh {
        find(&mut lab, &own, arguments.zero).map(|(file, findings, weights)| (file, findings, Some(weights)))
    } else {
        find_mounting(&mut lab, &own, arguments.zero).map(|(file, findings)| (file, findings, None))
    }?;
    let found = OwnDevice::new(file, "what was measured")?;
    let head = format!("Measured by `palpate commission`, started from {name}.");
    std::fs::write(out, toml_of(&found, &head)?).with_context(|| format!("cannot write {}", out.display()))?;
    report(&own, &findings);
    let doubts = weights.map_or_else(Vec::new, |weights| {
        println!("  {}", weights.line);
        weights.doubts
    });
    for sentence in begin_within(&found.file) {
        println!("  {sentence}");
    }
    if !doubts.is_empty() {
        let saved = if arguments.keep { "; nothing is saved in the device's flash" } else { "" };
        println!("written to {}, without the entries in doubt{saved}", out.display());
        doubts.iter().for_each(|doubt| eprintln!("error: {doubt}"));
        return Ok(ExitCode::from(1));
    }
    println!("written to {}", out.display());
    if arguments.keep {
        keep(&mut lab, &own.file, Some(calibration(&found).context("a device of less than three joints")?))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Records the cogging of a knob's motor.
fn record_cogging(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let Some(out) =
        arguments.out.as_ref().filter(|_| !arguments.weigh && !arguments.keep && arguments.plant.is_empty())
    else {
        bail!(
            "a knob records only its cogging: use --out FILE.rs, without --watch, --jog, --weigh, --keep and --plant"
        );
    };
    let (recording, from) = if let Some(path) = &arguments.port {
        let mut device = Device::connect(Box::new(PortLine::open(path, arguments.baud)?), Box::new(Keyboard::new()?))?;
        println!(
            "The field leads the dial round once and a quarter, there and back, in three minutes. Let go of the dial."
        );
        (knob::record(&mut device, &mut Person::new(Vec::new()))?, "this board's motor")
    } else if arguments.host {
        (recorded_of(dial())?, "the simulated gimbal motor")
    } else {
        bail!("a knob needs --port, or --host for the simulated one");
    };
    std::fs::write(out, recording.source(from)).with_context(|| format!("cannot write {}", out.display()))?;
    println!("cogging of {:.2} mN·m, root mean square", 1e3 * recording.size());
    println!("written to {}; build the image again", out.display());
    Ok(ExitCode::SUCCESS)
}

/// Says what the device uses since its last reset.
fn say_calibration(device: &Device, file: &DeviceFile) {
    match device.calibrated() {
        None => println!("the device keeps no calibration"),
        Some(Calibrated::BuiltIn) => println!("the device is what it was built with: no calibration is stored"),
        Some(Calibrated::Kept { crc }) => println!("the device uses the calibration that it keeps, CRC {crc:08x}"),
        Some(Calibrated::Refused(error)) => {
            println!("the device keeps its motors off: {}", file.by_name(&error.to_string()))
        }
    }
}

/// Has a calibration kept in the device's flash, or forgotten. A simulated device is reset, to see that it is used.
fn keep(lab: &mut Lab, file: &DeviceFile, found: Option<Calibration<3>>) -> anyhow::Result<()> {
    lab.hands.enable(false)?;
    let kept = lab.device.keep(found.map(|found| found.0));
    kept.map_err(|error| anyhow::anyhow!("{}", file.by_name(&error.to_string())))
        .context("the device's flash is unchanged, or empty")?;
    match found {
        Some(found) => println!("saved in the device's flash, CRC {:08x}; used after the next reset", found.crc()),
        None => println!("forgotten: from the next reset on the device is what it was built with"),
    }
    if lab.device.reset()? {
        print!("after a reset ");
        say_calibration(&lab.device, file);
    }
    Ok(())
}

fn report(own: &OwnDevice, findings: &[Finding]) {
    match findings.len() {
        0 => println!(
            "{}: all that was measured is as the file says, angles within {} mrad or two counts",
            own.file.name,
            1e3 * GIVE
        ),
        count => println!("{}: {count} found to be other than the file says", own.file.name),
    }
    for finding in findings {
        println!("  {finding}");
    }
}

/// The device and the person at it.
fn lab(arguments: &Arguments, own: &OwnDevice) -> anyhow::Result<Lab> {
    let names = own.file.joint.iter().map(|joint| joint.name.clone()).collect();
    if let Some(path) = &arguments.port {
        // Looking takes nobody at the keys, and holds none.
        let key: Box<dyn Key> = if arguments.watch.is_some() { Box::new(NoKey) } else { Box::new(Keyboard::new()?) };
        let hands = Box::new(Person::new(names));
        let device = Device::connect(Box::new(PortLine::open(path, arguments.baud)?), key)?;
        return Ok(Lab { device, hands });
    }
    let sound = Planted::sound(own.plant).wired(&own.file);
    let planted = arguments.plant.iter().fold(sound, |planted, fault| planted.with(*fault));
    let planted = if arguments.jog.is_some() { planted.carried() } else { planted };
    let world = World::shared(planted)?;
    let line: Box<dyn Line> = match arguments.emulator {
        Some(board) => {
            let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
            let settings = folder.path().join("settings.rs");
            std::fs::write(&settings, devices::settings_source(own, RATE))?;
            let choice = Choice { board, settings: Some(settings), ..Choice::default() };
            let program = Program::prepare_with(&choice, "bench", &[], &Progress::new())?;
            Box::new(EmulatedLine::start(program, &world)?)
        }
        None => Box::new(HostLine::new(own, &world)?),
    };
    let device = Device::connect(line, Box::new(KeyHeld))?;
    let simulated = SimulatedHands::new(&world);
    let hands: Box<dyn Hands> =
        if arguments.prompts { Box::new(Person::rehearsed(names, simulated)) } else { Box::new(simulated) };
    Ok(Lab { device, hands })
}

/// Shows what the encoders say, and drives nothing.
fn watch(device: &mut Device, file: &DeviceFile, seconds: f64) -> anyhow::Result<ExitCode> {
    let mut shown = Shown::until(seconds)?;
    let first = device.step(None)?.counts;
    let (mut last, mut range) = (first, first.map(|count| [count; 2]));
    while shown.goes_on() {
        let reading = device.step(None)?;
        shown.show(file, &reading)?;
        last = reading.counts;
        for ([least, most], count) in range.iter_mut().zip(last) {
            (*least, *most) = (count.min(*least), count.max(*most));
        }
    }
    println!();
    for (input, [least, most]) in range.into_iter().enumerate() {
        println!("input {input}: {} at the start, {least} to {most}, {} at the end", first[input], last[input]);
    }
    Ok(ExitCode::SUCCESS)
}

/// Drives one motor while the keys are held, and prints what it moved each time they are let go.
fn jog(lab: &mut Lab, file: &DeviceFile, (output, share): (u8, f64), seconds: f64) -> anyhow::Result<ExitCode> {
    if !share.is_finite() || share.abs() > 0.4 {
        bail!("--duty {share}: must be between −0.4 and 0.4");
    }
    lab.hands.enable(false)?;
    lab.device.wait_for_release()?;
    lab.hands.carry(output)?;
    lab.hands.enable(true)?;
    let mut shown = Shown::until(seconds)?;
    let (mut at_rest, mut was_live, mut moved) = (lab.device.step(None)?, false, None);
    loop {
        let goes_on = shown.goes_on();
        let reading = lab.device.step(goes_on.then_some((output, (share * 32_767.0) as i16)))?;
        shown.show(file, &reading)?;
        if !reading.live {
            if was_live {
                let sentence = motion(file, at_rest.counts, reading.counts);
                println!("\noutput {output} at duty {share}: {sentence}");
                moved = Some(sentence);
            }
            at_rest = reading;
        }
        was_live = reading.live;
        // A limit stands until both keys are let go: the next jog is another one.
        let is_stopped = reading.refusal != 0;
        if is_stopped || !goes_on {
            let reasons = said(&reading);
            let remedy = if is_stopped { "" } else { ": hold both keys" };
            moved.with_context(|| format!("output {output} was not driven{reasons}{remedy}"))?;
            if is_stopped {
                println!("stopped by the device{reasons}");
            }
            return Ok(ExitCode::SUCCESS);
        }
    }
}

/// The inputs that counted on, by more than a bent support does, with the joints that the file has on them.
fn motion(file: &DeviceFile, before: [i32; 3], now: [i32; 3]) -> String {
    let inputs = file.joint.iter().enumerate().filter_map(|(index, joint)| {
        let radians = angle(file, index, now) - angle(file, index, before);
        let input = joint.encoder.channel;
        let counts = now[input].wrapping_sub(before[input]);
        let (name, degrees) = (&joint.name, radians.to_degrees());
        (radians.abs() > MOVED)
            .then(|| format!("input {input} moved by {counts:+} counts (joint {name} {degrees:+.2}°)"))
    });
    let inputs: Vec<_> = inputs.collect();
    if inputs.is_empty() {
        return "no input moved; raise --duty, at most to 0.4, or check the motor supply".to_owned();
    }
    inputs.join(", ")
}

/// A line that is updated in place on a terminal, and printed again elsewhere.
struct Shown {
    began: Instant,
    lasts: Duration,
    last: Option<Instant>,
}

impl Shown {
    fn until(seconds: f64) -> anyhow::Result<Self> {
        let lasts = Duration::try_from_secs_f64(seconds).context("--watch and --for must be positive times")?;
        Ok(Self { began: Instant::now(), lasts, last: None })
    }

    fn goes_on(&self) -> bool {
        self.began.elapsed() < self.lasts
    }

    fn show(&mut self, file: &DeviceFile, reading: &Reading) -> anyhow::Result<()> {
        let is_due = self.last.is_none_or(|last| last.elapsed() >= SHOWN);
        if !is_due {
            return Ok(());
        }
        self.last = Some(Instant::now());
        let joints =
            file.joint.iter().enumerate().map(|(index, joint)| {
                format!("{} {:+8.2}°", joint.name, angle(file, index, reading.counts).to_degrees())
            });
        let joints: Vec<_> = joints.collect();
        let refusal = JogRefusal::from_code(reading.refusal).map_or_else(String::new, |refusal| format!("  {refusal}"));
        let line = format!(
            "tick {:>9}  counts {:>8?}  {}  duties {:>6?}  {}{}{refusal}",
            reading.tick,
            reading.counts,
            joints.join("  "),
            reading.duties,
            if reading.live { "live" } else { "off" },
            if reading.enable { "" } else { ", enable is not held" },
        );
        let mut output = stdout().lock();
        if output.is_terminal() {
            write!(output, "\r\x1b[2K{line}")?;
        } else {
            writeln!(output, "{line}")?;
        }
        Ok(output.flush()?)
    }
}
