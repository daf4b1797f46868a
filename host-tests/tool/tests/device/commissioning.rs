//! Commissioning of simulated devices in which something was planted: each fault is found, and the file that is written
//! is that of the very device.

use palpate_plant::{Direction, JointSettings};
use palpate_tool::commission::{Planted, SimulatedLab, find, find_mounting};
use palpate_tool::devices::{DEVICES, ShippedDevice};
use palpate_tool::own::OwnDevice;

/// The devices of three joints, with what their files are.
fn devices() -> impl Iterator<Item = (&'static ShippedDevice, OwnDevice)> {
    DEVICES.iter().filter_map(|shipped| {
        let file = shipped.file()?;
        Some((shipped, OwnDevice::new(file, shipped.name).expect("it ships")))
    })
}

fn turn(direction: &mut Direction) {
    *direction = if *direction == Direction::With { Direction::Against } else { Direction::With };
}

/// Commissions a device with something planted, and gives what was found and the file.
fn commission(
    shipped: &ShippedDevice,
    own: &OwnDevice,
    weighs: bool,
    harm: impl Fn(&mut Planted),
) -> (Vec<String>, OwnDevice) {
    let mut planted = Planted { plant: shipped.plant, encoder_on: [0, 1, 2], motor_on: [0, 1, 2] };
    harm(&mut planted);
    let mut lab = SimulatedLab::new(planted).expect("a bench");
    let outcome = if weighs { find(&mut lab, own) } else { find_mounting(&mut lab, own) };
    let (file, findings) = outcome.unwrap_or_else(|error| panic!("{}: {error}", shipped.name));
    let found = OwnDevice::new(file, "found.toml").expect("a device");
    // What is written is what was planted.
    for (index, (joint, truth)) in found.file.joint.iter().zip(&planted.plant.joints).enumerate() {
        let JointSettings { ratio, counts_per_turn, encoder_direction, motor_direction, angle_at_zero, .. } = *truth;
        let per_turn = counts_per_turn * ratio * encoder_direction.sign();
        let (encoder, motor) = (&joint.encoder, &joint.motor);
        // A count at either end of 0.3 rad, of a thousand or more.
        assert!((encoder.counts * encoder.ratio / per_turn - 1.0).abs() < 5e-3, "{} {index}: encoder", shipped.name);
        assert!((encoder.zero - angle_at_zero).abs() < 5e-3, "{} {index}: zero {}", shipped.name, encoder.zero);
        assert_eq!(motor.ratio > 0.0, motor_direction == Direction::With, "{} {index}: motor sign", shipped.name);
        assert_eq!(planted.encoder_on[encoder.channel], index, "{}: encoder input", shipped.name);
        assert_eq!(planted.motor_on[motor.channel], index, "{}: motor output", shipped.name);
        let torque = motor.torque_constant * motor.ratio.abs();
        assert!(
            (torque / (truth.torque_constant * ratio) - 1.0).abs() < 0.05,
            "{} {index}: torque {torque}, {}",
            shipped.name,
            truth.torque_constant * ratio
        );
    }
    (findings.into_iter().map(|finding| finding.0).collect(), found)
}

#[test]
fn a_device_that_is_as_its_file_says_is_left_as_it_is() {
    for (shipped, own) in devices() {
        // Its friction takes all the duty that a jog may have.
        let weighs = shipped.name != "falcon";
        let (findings, _) = commission(shipped, &own, weighs, |_| {});
        println!("{}: {findings:?}", shipped.name);
        let unexpected: Vec<_> = findings.iter().filter(|finding| !finding.contains("friction")).collect();
        assert!(unexpected.is_empty(), "{}: {unexpected:?}", shipped.name);
    }
}

#[test]
fn a_weight_that_friction_hides_is_refused() {
    let (shipped, own) = devices().find(|(shipped, _)| shipped.name == "falcon").expect("it ships");
    let planted = Planted { plant: shipped.plant, encoder_on: [0, 1, 2], motor_on: [0, 1, 2] };
    let refusal = find(&mut SimulatedLab::new(planted).expect("a bench"), &own).expect_err("too much friction");
    assert!(refusal.to_string().contains("take less weight"), "{refusal:#}");
}

/// What is planted, and what the findings must say of it.
type Harm = (&'static str, fn(&mut Planted), &'static str);

#[test]
fn every_planted_fault_is_found_and_the_file_that_is_written_says_so() {
    let harms: [Harm; 6] = [
        ("encoder sign", |planted| turn(&mut planted.plant.joints[1].encoder_direction), "joint b: encoder sign"),
        ("motor sign", |planted| turn(&mut planted.plant.joints[2].motor_direction), "joint c: motor sign"),
        ("ratio", |planted| planted.plant.joints[0].counts_per_turn *= 1.25, "joint a: encoder ratio"),
        ("zero", |planted| planted.plant.joints[1].angle_at_zero += 0.2, "joint b: encoder zero"),
        ("swapped encoders", |planted| planted.encoder_on = [1, 0, 2], "joint a: encoder on input 1"),
        ("swapped motors", |planted| planted.motor_on = [0, 2, 1], "joint b: motor on output 2"),
    ];
    for (shipped, own) in devices() {
        for (name, harm, says) in &harms {
            let (findings, _) = commission(shipped, &own, false, harm);
            println!("{:<20} {name}: {findings:?}", shipped.name);
            assert!(findings.iter().any(|finding| finding.starts_with(says)), "{} {name}: {findings:?}", shipped.name);
        }
    }
}
