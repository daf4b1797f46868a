//! The boards that suit a device file: those with its sensors, motor stages and homing, and how the others refuse it.

use crate::firmware::BenchBoard;
use anyhow::ensure;
use palpate::device::Encoder;
use palpate::servo::FrameBridge;
use palpate_bench::sensors::{max_step, ticks_per_round};
use palpate_sim::devices::{DeviceFile, HomingEntry, JointEntry};
use std::f64::consts::TAU;

/// Whether a board can home its sensors that way.
const fn homes(board: BenchBoard, homing: HomingEntry) -> bool {
    match homing {
        HomingEntry::Pose => true,
        HomingEntry::Index => board.sensor_counts().is_none(),
        HomingEntry::None => board.sensor_counts().is_some(),
    }
}

/// The boards for the sensors and motor stages of all joints together; those that home them as the file says, if there are.
fn boards_of(file: &DeviceFile) -> Vec<BenchBoard> {
    let has_all = |board: &BenchBoard| {
        file.joint.iter().all(|joint| {
            board.sensor_counts().is_none_or(|counts| joint.encoder.counts == counts)
                && joint.motor.bridge.is_some() == board.has_bridges()
        })
    };
    let mut boards: Vec<_> = BenchBoard::ALL.into_iter().filter(has_all).collect();
    if boards.iter().any(|board| homes(*board, file.homing)) {
        boards.retain(|board| homes(*board, file.homing));
    }
    boards
}

/// The way out on a board without a device's sensors or motor stages. It never leaves an entry out: an image for amplifiers
/// gives a bridge voltage where it means no current.
fn instead(file: &DeviceFile) -> String {
    let way = |board: BenchBoard| {
        let sensors = board.sensor_counts().map_or("quadrature encoders", |_| "angle sensors");
        let stages = if board.has_bridges() { "bridges" } else { "amplifiers that control the current" };
        format!("--board {} reads {sensors} and drives {stages}", board.name())
    };
    let ways: Vec<_> = boards_of(file).into_iter().map(way).collect();
    if !ways.is_empty() {
        return ways.join(", ");
    }
    let stages = if file.joint.iter().all(|joint| joint.motor.bridge.is_some()) {
        "quadrature encoders and bridges"
    } else {
        "bridges and amplifiers"
    };
    format!(
        "no shipped board has {stages} together: leave the file as the device is, and write a board of your own \
         (docs/howto/board.md)"
    )
}

/// The ways out on a board without a device's way of homing: others, and the board that has this one.
pub(super) fn homing_instead(ways: &str, file: &DeviceFile) -> String {
    let board = boards_of(file).into_iter().find(|board| homes(*board, file.homing));
    board.map_or_else(|| ways.to_owned(), |board| format!("{ways}, or --board {}", board.name()))
}

/// Whether a board has the sensors and the motor stages that a device file says, in a loop of `rate`, Hz.
pub(super) fn suits(board: BenchBoard, file: &DeviceFile, rate: u32) -> anyhow::Result<()> {
    let (knows_angles, name) = (board.sensor_counts().is_some(), board.name());
    for JointEntry { name: joint, encoder, motor, .. } in &file.joint {
        if let Some(counts) = board.sensor_counts() {
            ensure!(
                encoder.counts == counts,
                "joint {joint}: counts = {}, and {name} reads angle sensors of {counts} counts a turn: correct the counts of such a sensor; {}",
                encoder.counts,
                instead(file)
            );
        }
        ensure!(
            board.has_bridges() || motor.bridge.is_none(),
            "joint {joint}: `bridge`, and {name} drives amplifiers that control the current: its duty for none is 10 %, which \
             turns a motor on a bridge; {}",
            instead(file)
        );
        ensure!(
            !board.has_bridges() || motor.bridge.is_some(),
            "joint {joint}: no `bridge`, and {name} drives bridges that give a voltage. A bridge needs its supply in V and the \
             resistance of motor and bridge in ohms: bridge = {{ supply = 24.0, resistance = 0.7, back_emf_share = 0.8 }} in \
             [joint.motor]. Of amplifiers: {}",
            instead(file)
        );
    }
    ensure!(
        homes(board, file.homing) || !knows_angles,
        "homing = \"index\": {name} reads angle sensors, which have no index mark: {}",
        homing_instead("homing = \"pose\"", file)
    );
    ensure!(
        homes(board, file.homing),
        "homing = \"none\": {name} counts quadrature encoders from 0 after each reset, wherever the joint is: {}",
        homing_instead("homing = \"pose\" or \"index\"", file)
    );
    let round = if knows_angles { ticks_per_round(3, rate as f32) } else { 1 };
    for JointEntry { name, encoder, range: [least, most], .. } in &file.joint {
        // The angle in a turn of the sensor's shaft, from its count 0 on.
        let (turn, zero) = (TAU / encoder.ratio, encoder.zero);
        ensure!(
            file.homing != HomingEntry::None || (zero.min(zero + turn) <= *least && *most <= zero.max(zero + turn)),
            "joint {name}: homing = \"none\": after a reset its sensor knows one turn of its shaft, from zero = {zero} rad on \
             {turn:.2} rad of the joint, and its range is {least} to {most}: {}",
            if most - least > turn.abs() {
                "homing = \"pose\", or a sensor on the joint".to_owned()
            } else {
                format!(
                    "turn its magnet until its count 0 is outside of that, and set zero, first to {}",
                    if turn > 0.0 { least } else { most }
                )
            }
        );
        let step = max_step(
            &Encoder::geared(encoder.counts as f32, encoder.ratio as f32, 0.0),
            file.limits.max_joint_rate as f32,
            rate as f32,
            FrameBridge::<3>::DEFAULT_IN_A_ROW + round - 1,
        );
        let half = 1 << (board.counter_bits() - 1);
        ensure!(
            step < half,
            "limits.max_joint_rate = {}: joint {name} may then pass {step} counts between two good readings, and {} tells \
             {half} at most from the way back: lower it below {:.0} rad/s",
            file.limits.max_joint_rate,
            board.name(),
            file.limits.max_joint_rate * f64::from(half - 2) / f64::from(step)
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_sim::devices::{BridgeEntry, named};

    #[test]
    fn a_board_takes_the_sensors_and_motor_stages_that_it_has() {
        let file = named("woodenhaptics-2016").and_then(|device| device.file()).expect("a file of an arm that ships");
        let with = |counts: f64, bridge: Option<BridgeEntry>| {
            let mut file = file.clone();
            for joint in &mut file.joint {
                (joint.encoder.counts, joint.motor.bridge) = (counts, bridge);
            }
            file
        };
        let bridge = Some(BridgeEntry { supply: 24.0, resistance: 0.7, inductance: None, back_emf_share: 0.8 });
        let takes =
            |board, counts, bridge| suits(board, &with(counts, bridge), 4_000).map_err(|error| error.to_string());
        for (board, counts, bridge) in [
            (BenchBoard::Stm32g4, 2_000.0, None),
            (BenchBoard::Teensy41, 16_384.0, None),
            (BenchBoard::Pico2, 16_384.0, bridge),
        ] {
            assert_eq!(takes(board, counts, bridge), Ok(()));
        }
        for (board, counts, bridge, culprit) in [
            (BenchBoard::Stm32g4, 2_000.0, bridge, "no shipped board has quadrature encoders and bridges together"),
            (BenchBoard::Teensy41, 2_000.0, None, "counts = 2000"),
            (BenchBoard::Pico2, 8_192.0, bridge, "counts = 8192"),
            (BenchBoard::Pico2, 16_384.0, None, "bridge = {"),
        ] {
            let error = takes(board, counts, bridge).expect_err("a device that the board does not bear");
            assert!(error.contains(culprit), "{error}");
        }
    }

    /// Of each device of two kinds of sensors, motor stages of one kind or mixed, and three ways of homing.
    #[test]
    fn a_board_that_a_refusal_names_takes_the_device_and_no_refusal_asks_to_leave_a_bridge_out() {
        let bridge = Some(BridgeEntry { supply: 24.0, resistance: 0.7, inductance: None, back_emf_share: 0.8 });
        let mut without_a_board = 0;
        for (counts, with_bridges) in
            [2_000.0, 16_384.0].into_iter().flat_map(|counts| (0..8).map(move |joints| (counts, joints)))
        {
            for homing in [HomingEntry::Pose, HomingEntry::Index, HomingEntry::None] {
                let mut file = named("woodenhaptics-2016").and_then(|device| device.file()).expect("a file");
                file.homing = homing;
                for (index, joint) in file.joint.iter_mut().enumerate() {
                    // On the joint, whose one turn it knows.
                    (joint.encoder.counts, joint.encoder.ratio, joint.encoder.zero) =
                        (counts, 1.0, joint.range[0] - 1.0);
                    joint.motor.bridge = bridge.filter(|_| with_bridges >> index & 1 == 1);
                }
                let takes = |board, homing| {
                    let error = suits(board, &DeviceFile { homing, ..file.clone() }, 4_000).err();
                    error.map(|error| error.to_string())
                };
                let has_board = BenchBoard::ALL.into_iter().any(|board| takes(board, HomingEntry::Pose).is_none());
                without_a_board += usize::from(!has_board);
                for error in BenchBoard::ALL.into_iter().filter_map(|board| takes(board, homing)) {
                    let named =
                        BenchBoard::ALL.into_iter().find(|board| error.contains(&format!("--board {}", board.name())));
                    // The way of homing may still be one that no board has with these parts.
                    let is_homed = BenchBoard::ALL.into_iter().any(|board| takes(board, homing).is_none());
                    let suited = if is_homed { homing } else { HomingEntry::Pose };
                    assert!(named.is_none_or(|board| takes(board, suited).is_none()), "{error}");
                    assert_eq!(error.contains("no shipped board has"), !has_board, "{error}");
                    assert!(named.is_some() || !has_board || error.contains("homing = \"pose\""), "{error}");
                    assert!(!error.contains("leave `bridge`") && !error.contains("bridge` out"), "{error}");
                }
            }
        }
        // Encoders on bridges, and either sensor on bridges beside amplifiers, homed in three ways.
        assert_eq!(without_a_board, 3 * (1 + 6 + 6));
    }

    #[test]
    fn a_board_takes_the_homing_and_the_rates_that_its_inputs_bear() {
        let bridge = Some(BridgeEntry { supply: 24.0, resistance: 0.7, inductance: None, back_emf_share: 0.8 });
        let takes = |board: BenchBoard, homing, change: fn(&mut DeviceFile)| {
            let mut file = named("woodenhaptics-2016").and_then(|device| device.file()).expect("a file");
            file.homing = homing;
            for joint in &mut file.joint {
                joint.encoder.counts = board.sensor_counts().unwrap_or(joint.encoder.counts);
                joint.motor.bridge = bridge.filter(|_| board.has_bridges());
            }
            change(&mut file);
            suits(board, &file, 4_000).map_err(|error| error.to_string())
        };
        // Its shafts make a turn in 22 degrees of a joint; sensors on the joints make one turn.
        let as_shipped: fn(&mut DeviceFile) = |_| ();
        let on_joints: fn(&mut DeviceFile) = |file| {
            for (joint, sign) in file.joint.iter_mut().zip([1.0, -1.0, 1.0]) {
                joint.encoder.ratio = sign;
                joint.encoder.zero = if sign > 0.0 { joint.range[0] - 1.0 } else { joint.range[1] + 1.0 };
            }
        };
        for board in BenchBoard::ALL {
            let knows_angles = board.sensor_counts().is_some();
            assert_eq!(takes(board, HomingEntry::Pose, as_shipped), Ok(()));
            assert_eq!(takes(board, HomingEntry::Index, as_shipped).is_ok(), !knows_angles);
            assert_eq!(takes(board, HomingEntry::None, on_joints).is_ok(), knows_angles);
            assert!(takes(board, HomingEntry::None, as_shipped).is_err());
        }
        for (board, homing, change, says) in [
            (BenchBoard::Pico2, HomingEntry::Index, as_shipped, "homing = \"index\": pico2 reads angle sensors"),
            (
                BenchBoard::Stm32g4,
                HomingEntry::None,
                on_joints,
                "homing = \"none\": stm32g4 counts quadrature encoders",
            ),
            (
                BenchBoard::Teensy41,
                HomingEntry::None,
                as_shipped,
                "joint a: homing = \"none\": after a reset its sensor",
            ),
            (
                BenchBoard::Teensy41,
                HomingEntry::None,
                |file| file.joint.iter_mut().for_each(|joint| joint.encoder.ratio = -1.0),
                "its range is -1.6 to 1.6: turn its magnet until its count 0 is outside of that, and set zero, first to 1.6",
            ),
            (
                BenchBoard::Pico2,
                HomingEntry::Pose,
                |file| file.limits.max_joint_rate = 1_000.0,
                "limits.max_joint_rate = 1000: joint a may then pass 31293 counts between two good readings, and pico2 tells 8192",
            ),
        ] {
            let error = takes(board, homing, change).expect_err(says);
            println!("{error}");
            assert!(error.contains(says), "{error}");
        }
    }
}
