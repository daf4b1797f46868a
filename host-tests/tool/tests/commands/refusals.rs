//! Options that would have no effect are refused, with what to give instead.

use std::error::Error;
use std::process::Command;

#[test]
fn an_option_without_effect_is_refused_with_a_remedy() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    for (arguments, message) in [
        ("feel --device falcon --stiffness 2001", "--stiffness 2001: falcon takes 0 to 2000 N/m"),
        ("feel --device falcon --clean --damping 5.5", "--damping 5.5: falcon takes 0 to 5 N·s/m"),
        ("feel --stiffness inf", "the stiffness must be between 0 and the device's maximum"),
        ("sim --device falcon --stiffness 2001", "--stiffness 2001: falcon takes 0 to 2000 N/m"),
        ("feel --device hapkit --model sphere", "need three joints; hapkit has 1: leave them out"),
        ("feel --device hapkit --clean", "--clean needs two joints; hapkit has one"),
        ("feel --recording x.csv", "add --device NAME"),
        ("feel --device falcon --recording x.csv --out y", "'--recording <FILE.csv>' cannot be used with '--out"),
        ("feel --device falcon --recording x.csv --rate 1000", "cannot be used with '--rate"),
        ("feel --device falcon --recording x.csv --stiffness 9", "cannot be used with '--stiffness"),
        ("feel --device falcon --recording x.csv --rendering plain", "cannot be used with '--rendering"),
        ("zwidth --device all --plot x.svg", "--plot is of one device: add --device NAME"),
        ("zwidth --modes m.toml --model sphere --plot x.svg", "cannot be used with '--plot"),
        ("sim --device x.urdf", "x.urdf: a device file ends in .toml, and states lengths, masses"),
        ("device x.urdf --out y.rs", "x.urdf: a device file ends in .toml"),
        ("firmware --device x.urdf build", "x.urdf: a device file ends in .toml"),
        ("sim --tool capsule --csv x.csv --recording x.json", "a tool with a shape is not recorded"),
    ] {
        let run =
            Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments.split(' ')).current_dir(&folder).output()?;
        let said = String::from_utf8(run.stderr)?;
        assert!(run.status.code() == Some(2) && said.contains(message), "{arguments}: {said}");
        assert!(run.stdout.is_empty() && std::fs::read_dir(&folder)?.next().is_none(), "{arguments}");
    }
    Ok(())
}
