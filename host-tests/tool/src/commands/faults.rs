//! `palpate faults`: plants the failures of the page in simulated devices.

use crate::devices::{Arms, ShippedDevice, arms_parser};
use crate::faults::{Failure, Found, KNOB, Reaction, Shown, Subject, coverage, table};
use clap::Args;
use std::process::ExitCode;

/// Plants each failure of the faults page in a simulated device and compares detection and time with the page.
///
/// Exit status: 0, or 1 if a failure is not detected as the page states.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Simulated device: a name, or the path of a device file.
    #[arg(long, default_value = "woodenhaptics-2016", value_parser = arms_parser())]
    device: Arms,
    /// The failures of a knob instead, in a simulated one.
    #[arg(long, conflicts_with = "device")]
    knob: bool,
}

/// Counts a turn of the boards' magnetic sensors.
const ANGLES: f64 = 16_384.0;

/// Whether an encoder counts like a magnetic sensor in a turn of its own, or of the joint on whose axis it sits.
fn has_magnets(device: &ShippedDevice) -> bool {
    let counts = device.plant.joints.map(|joint| [joint.counts_per_turn, joint.counts_per_turn * joint.ratio]);
    counts.as_flattened().iter().any(|counts| (counts - ANGLES).abs() < 1e-3)
}

/// The failures that a device can have.
fn rows(device: &ShippedDevice) -> impl Iterator<Item = &'static Failure> {
    let has_frames = has_magnets(device);
    table().filter(move |row| has_frames || !row.is_of_frames())
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> ExitCode {
    if arguments.knob {
        return of_knob();
    }
    let mut is_good = true;
    for device in arguments.device.each() {
        println!(
            "{}\n{:<8}{:<72}{:>12}{:>10}{:>11}  result",
            device.name, "part", "failure", "promised ms", "found ms", "motion mm"
        );
        for row in rows(device) {
            is_good &= print(row, &Subject::new(device));
        }
        let left_out = table().count() - rows(device).count();
        if left_out > 0 {
            println!(
                "left out: {left_out} failures of sensors on a bus; this arm has counters, and one that is unplugged stands \
                 still (a file with `counts = {ANGLES:.1}` has sensors on a bus)"
            );
        }
        println!();
    }
    println!("{}", coverage());
    if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn of_knob() -> ExitCode {
    println!("knob\n{:<60}{:>12}{:>10}{:>11}  result", "failure", "promised ms", "found ms", "motion °");
    let mut is_good = true;
    for row in &KNOB {
        let found = row.plant();
        let time = found.off_ms.map_or_else(|| "never".to_owned(), |time| time.to_string());
        let fault = found.fault.map_or_else(|| "none".to_owned(), |fault| format!("{}: {fault}", fault.code()));
        let verdict = if row.is_as_stated(&found) { "off, " } else { "NOT AS STATED: " };
        println!("{:<60}{:>12}{time:>10}{:>11.3}  {verdict}{fault}", row.failure, row.within_ms, found.motion_degrees);
        is_good &= row.is_as_stated(&found);
    }
    if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Prints a row; whether it is as the page says.
fn print(row: &Failure, subject: &Subject) -> bool {
    let head = format!("{:<8}{:<72}", row.part, row.failure);
    let found = row.plant(subject);
    let motion = found.map_or_else(String::new, |found| format!("{:.3}", found.motion_mm));
    if let Shown::Gap(reason, _) = row.shown {
        println!("{head}{:>12}{:>10}{motion:>11}  not detected: {reason}", "", "");
        return true;
    }
    let excuse = row.excuse(subject);
    if let Some(found) = row.plant_on_knob() {
        let is_as_stated = row.is_as_stated_of(found.off_ms, found.fault);
        let time = found.off_ms.map_or_else(|| "never".to_owned(), |time| time.to_string());
        let fault = found.fault.map_or_else(|| "none".to_owned(), |fault| format!("{}: {fault}", fault.code()));
        let verdict = if is_as_stated { "on a knob: off, " } else { "NOT AS STATED: " };
        println!("{head}{:>12}{time:>10}{:>10.1}°  {verdict}{fault}", row.within_ms, found.motion_degrees);
        return is_as_stated;
    }
    let Some(found) = found else {
        println!("{head}{:>12}{:>21}  not detected: {}", row.within_ms, "", excuse.unwrap_or("it cannot be planted"));
        return excuse.is_some();
    };
    let Found { off_ms, fault, .. } = found;
    let time = off_ms.map_or_else(|| "never".to_owned(), |time| time.to_string());
    let is_as_stated = row.is_as_stated(&found);
    let verdict = match (is_as_stated, row.reaction, excuse) {
        (true, Reaction::Latched(_), _) => {
            fault.map_or_else(String::new, |fault| format!("off, {}: {fault}", fault.code()))
        }
        (true, Reaction::Hold, _) => "off, hold".to_owned(),
        (true, Reaction::NoStart, _) => "no start".to_owned(),
        (false, _, Some(excuse)) => format!("not detected: {excuse}"),
        (false, ..) => {
            let fault = fault.map_or_else(|| "no fault".to_owned(), |fault| format!("{}: {fault}", fault.code()));
            format!("NOT AS STATED: {fault}")
        }
    };
    println!("{head}{:>12}{time:>10}{motion:>11}  {verdict}", row.within_ms);
    is_as_stated || excuse.is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::own_device;
    use palpate_sim::devices::{OwnDevice, named};

    #[test]
    fn an_arm_has_magnetic_sensors_by_its_counts() {
        let shipped = named("woodenhaptics-2016").expect("it ships");
        assert!(!has_magnets(shipped));
        assert!(rows(shipped).all(|row| !row.failure.contains("frame") && !row.failure.contains("magnet")));
        // Geared as the motor, and on the joint's axis.
        for ratio in [16.0, -1.0] {
            let mut file = shipped.file().expect("a file of it");
            (file.joint[0].encoder.counts, file.joint[0].encoder.ratio) = (ANGLES, ratio);
            let arm = own_device(&OwnDevice::new(file, "arm").expect("a device"), "arm");
            assert!(has_magnets(arm), "{ratio}");
            assert_eq!(rows(arm).count(), table().count());
        }
    }
}
