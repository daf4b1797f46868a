//! A device that is set up over an emulated board's serial port, by the command that sets up a real one.

use crate::running::is_wanted;
use palpate_tool::own::OwnDevice;
use std::process::Command;

#[test]
fn what_is_planted_in_the_device_at_an_emulated_board_is_found_over_its_line() {
    if !is_wanted("what_is_planted_in_the_device_at_an_emulated_board_is_found_over_its_line") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("found.toml");
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["commission", "--emulator", "m4", "--device", "phantom-premium", "--plant", "encoder-sign:1"])
        .args(["--plant", "motors:0-2", "--out"])
        .arg(&out)
        .output()
        .expect("it runs");
    let (said, complained) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    println!("{said}{complained}");
    assert!(run.status.success());
    for finding in ["joint b: encoder sign", "joint a: motor on output 2", "joint c: motor on output 0"] {
        assert!(said.contains(finding), "{finding}");
    }
    assert!(said.contains("3 found"), "and nothing else");
    let found = OwnDevice::read(&out).expect("a device file");
    assert_eq!(found.file.joint.iter().map(|joint| joint.motor.channel).collect::<Vec<_>>(), [2, 1, 0]);
}
