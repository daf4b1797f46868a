//! `palpate device`: the file of one's own device as the library's constants, in Rust or C; or the file of a shipped
//! device to start from.

use crate::devices;
use anyhow::{Context, bail};
use clap::Args;
use palpate_sim::devices::{OwnDevice, c_header, c_preset, rust_preset, source};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes the library's constants for a device file, or the file of a shipped device to start from.
///
/// The constants are checked here and again by the compiler.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Device file (my.toml), or the name of a shipped device
    device: PathBuf,
    /// Output: constants of Rust (device.rs) or C (device.h); of three joints also a device file (my.toml)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// The refused entry of the file; no output is written then.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let name = arguments.device.to_string_lossy();
    let extension = arguments.out.extension().and_then(|extension| extension.to_str());
    // One and two joints have no device file.
    if let Some(shipped) = devices::named(&name).filter(|shipped| shipped.file().is_none()) {
        let text = match extension {
            Some("rs") => rust_preset(shipped),
            Some("h") => c_preset(shipped),
            _ => bail!("{name} has fewer than three joints, and so no device file; --out must end in .rs or .h"),
        };
        write(&arguments.out, &text)?;
        println!("{name}: {} joints, written to {}", shipped.preset.feeds().len(), arguments.out.display());
        return Ok(ExitCode::SUCCESS);
    }
    let own = devices::own(&arguments.device)?;
    // A copy under another name would lose its remarks without a word.
    let [device, out] = [&arguments.device, &arguments.out].map(|path| path.canonicalize().ok());
    if device.is_some() && device == out {
        bail!("{name}: --out is the device file itself, which is not overwritten; give another name");
    }
    let text = match extension {
        Some("rs") => source(&own, &name),
        Some("h") => c_header(&own, &name),
        Some("toml") => noted(&toml_of(&own, &format!("Written by `palpate device` from {name}."))?),
        _ => bail!("{}: --out must end in .rs, .h or .toml", arguments.out.display()),
    };
    write(&arguments.out, &text)?;
    println!("{}: {} joints, written to {}", own.file.name, own.file.joint.len(), arguments.out.display());
    Ok(ExitCode::SUCCESS)
}

/// A device file's text, with a line on top.
///
/// # Errors
/// None of a file that was read.
pub fn toml_of(own: &OwnDevice, head: &str) -> anyhow::Result<String> {
    Ok(format!("# {head} SI units; see docs/reference/device-format.md.\n\n{}", toml::to_string(&own.file)?))
}

/// The source of each entry's number in one's own file, in the file's order where an entry has two.
const NOTES: &[(&str, &str)] = &[
    ("name", "yours"),
    ("homing", "choose: pose, index or none"),
    ("kind", "keep"),
    ("base_height", "drawing: m, from the table to the first link's axis"),
    ("first_link", "drawing: m, axis to axis"),
    ("second_link", "drawing: m, axis to probe"),
    ("second_pivot", "drawing: m"),
    ("cranks", "drawing: m, axis to axis"),
    ("rods", "drawing: m, axis to axis"),
    ("side", "drawing: linkage 1 or -1, on which the rods meet; delta m"),
    ("tool", "drawing: m, from the first elbow towards the hinge"),
    ("pivot_reach", "drawing: m, from the turntable's axis"),
    ("thigh", "drawing: m, axis to axis"),
    ("shin", "drawing: m, axis to axis"),
    ("stub", "drawing: m, both together"),
    ("reach", "drawing: m, of a hip less that of a shin's end on the plate"),
    ("legs", "drawing: rad, directions about z"),
    ("workspace_centre", "choose: m; half to 0.7 of first_link + second_link from the first link's axis"),
    ("workspace_depth", "choose: m, in front of the base"),
    ("end_masses", "scales: kg that each link lifts, at its end; `commission --weigh` corrects it"),
    ("mass", "scales or CAD: kg; `commission --weigh` corrects it"),
    ("along", "CAD: m, of the centre of mass along the link"),
    ("across", "CAD: m, of it to the left"),
    ("carried_mass", "scales: kg, plate and half the shins; `commission --weigh` corrects it"),
    ("thigh_moment", "scales: kg·m; `commission --weigh` corrects it"),
    ("min_margin", "keep, scaled with the links: m/rad, below it (near a singularity) no force"),
    ("max_joint_rate", "keep: rad/s, faster is a sensor fault"),
    ("max_force", "keep, 0.6 of it for the first force: N"),
    ("max_stiffness", "measure: N/m, `palpate zwidth`, then the bench"),
    ("max_damping", "keep: N·s/m; raise it only on the bench, in steps, until it buzzes"),
    ("max_probe_speed", "keep: m/s, faster under force is a fault"),
    ("name", "yours"),
    ("range", "measure: rad at the end stops, and 0.03 more; beyond is a sensor fault"),
    ("friction", "measure: N·m, `commission --weigh`"),
    ("inertia", "CAD: kg·m² at the joint, of drum, links and rotor × ratio², in the middle of the workspace"),
    ("channel", "wiring: the board's input; commissioning finds it"),
    ("counts", "data sheet: a turn, 4 × lines; 16384.0 on Pico 2 and Teensy"),
    ("ratio", "drawing: drum / encoder's pulley; commissioning finds the sign"),
    ("zero", "commissioning measures it: rad"),
    ("channel", "wiring: the board's output; commissioning finds it"),
    ("torque_constant", "data sheet: N·m/A; `commission --weigh` measures it"),
    ("current_at_full", "set-up of the amplifier: A at full duty; bridge: supply / resistance at most"),
    ("ratio", "drawing: drum / motor's pulley; commissioning finds the sign"),
    ("continuous_current", "data sheet: A, nominal current of the motor"),
    ("time_constant", "data sheet: s, thermal, of the winding"),
    ("max_rate", "keep: rad/s, faster under force is a fault"),
    ("supply", "yours: V"),
    ("resistance", "data sheets: ohms of winding, brushes and bridge"),
    ("inductance", "data sheet: H, of the winding; simulation alone"),
    ("back_emf_share", "keep, 0.8 if unknown"),
];

/// A device file with the source of each entry's number, where the entry comes first.
fn noted(text: &str) -> String {
    let mut left: Vec<_> = NOTES.to_vec();
    let mut note = |line: &str| {
        let key = line.split_once(" = ")?.0;
        let at = left.iter().position(|(of, _)| *of == key)?;
        Some(left.remove(at).1)
    };
    text.lines()
        .map(|line| note(line).map_or_else(|| format!("{line}\n"), |note| format!("{line:<40} # {note}\n")))
        .collect()
}

fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_entry_of_a_file_has_its_source_once() {
        let mut shipped: Vec<_> = devices::DEVICES.iter().filter_map(devices::ShippedDevice::file).collect();
        assert_eq!(shipped.len(), 4);
        shipped[0].joint[0].motor.bridge = Some(palpate_sim::devices::BridgeEntry {
            supply: 24.0,
            resistance: 0.7,
            inductance: Some(1.2e-4),
            back_emf_share: 0.8,
        });
        for file in shipped {
            let text = noted(&toml::to_string(&file).expect("a file"));
            let (noted, bare): (Vec<_>, Vec<_>) =
                text.lines().filter(|line| line.contains(" = ")).partition(|line| line.contains(" # "));
            let key = |line: &&str| line.split(' ').next().map(str::to_owned);
            for line in bare {
                assert!(noted.iter().any(|noted| key(noted) == key(&line)), "{line}");
            }
            assert_eq!(OwnDevice::parse(&text, "my.toml").expect("it reads back").file, file);
        }
    }
}
