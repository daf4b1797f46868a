//! Motors and encoders on other channels than their joints': the loop reads and drives the right joint.

use palpate::commission::Wiring;
use palpate::device::drive::Field;
use palpate::device::{Counts, Duty};
use palpate::servo::{Config, Phase, ResetReason, Servo};
use palpate_bench::Panel;
use palpate_bench::sensors::BadFrame;
use palpate_sim::devices::preset::Preset;
use palpate_sim::devices::{OwnDevice, named, source};
use palpate_sim::plant::Plant;
use palpate_sim::rig::{Made, SETTINGS, WALL, held_at};
use palpate_sim::simulated::{AtPins, CLOCK_HZ, SimulatedBoard};

const PERMUTATIONS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// A device file with its joints on these channels, as text.
fn text(inputs: [usize; 3], outputs: [usize; 3]) -> String {
    let mut file = named("woodenhaptics-2016").unwrap().file().unwrap();
    for (joint, entry) in file.joint.iter_mut().enumerate() {
        (entry.encoder.channel, entry.motor.channel) = (inputs[joint], outputs[joint]);
    }
    toml::to_string(&file).unwrap()
}

/// The channels in a file's text, read without the code under test.
fn channels(text: &str, of: &str) -> [usize; 3] {
    let table: toml::Table = text.parse().unwrap();
    std::array::from_fn(|joint| table["joint"][joint][of]["channel"].as_integer().unwrap() as usize)
}

/// The arm, whose cables go to these channels.
struct Cabled {
    plant: Plant,
    button: bool,
    inputs: [usize; 3],
    outputs: [usize; 3],
    /// What came at each output last.
    duties: [i16; 3],
}

impl AtPins<3> for Cabled {
    fn panel(&mut self) -> Panel {
        Panel { enable: self.button, enable_disagrees: false, stop: false, ready: true, supply: None }
    }

    fn counts(&mut self) -> Result<[Counts; 3], BadFrame> {
        let mut counts = [Counts(0); 3];
        for (joint, count) in self.plant.counts().into_iter().enumerate() {
            counts[self.inputs[joint]] = Counts(count);
        }
        Ok(counts)
    }

    fn advance(&mut self, _: Option<[Field; 3]>, duties: Option<[Duty; 3]>) {
        self.duties = duties.unwrap_or_default().map(|duty| duty.0);
        self.plant.advance(self.outputs.map(|output| self.duties[output]));
    }
}

/// What the loop of a device file does on an arm with cables on these channels: the angles that it believes, the duties
/// at the outputs, the probe's depth in the wall.
fn pressed(file: &str, inputs: [usize; 3], outputs: [usize; 3]) -> ([f32; 3], [i16; 3], f64) {
    let own = OwnDevice::parse(file, "my.toml").unwrap();
    let Preset::SerialArm(device) = own.preset else { panic!("a WoodenHaptics is a serial arm") };
    let servo = Servo::new(device, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let plant = held_at([0.0, 0.0, -0.004]);
    let world = Cabled { plant, button: false, inputs, outputs, duties: [0; 3] };
    let settings = palpate_bench::Settings::new(CLOCK_HZ);
    let mut board = SimulatedBoard::new(Made(servo, false, own.wiring()), world, &settings, ResetReason::PowerOn);
    for tick in 0..1_600 {
        board.bench.board().world.button = tick > 200;
        board.tick(0);
    }
    assert_eq!((board.bench.state().phase(), board.bench.state().fault()), (Phase::Running, None));
    let angles = board.bench.state().angles();
    let world = &board.bench.board().world;
    (angles, world.duties, -world.plant.position()[2])
}

#[test]
fn every_permutation_of_motors_and_encoders_in_the_file_drives_the_right_joints() {
    let (angles, duties, depth) = pressed(&text([0, 1, 2], [0, 1, 2]), [0, 1, 2], [0, 1, 2]);
    let [base, first, second] = duties.map(i32::from);
    // The wall's force is vertical, which loads no turntable.
    assert!(base.abs() < 10 && first.abs() > 300 && second.abs() > 300 && first.abs_diff(second) > 300, "{duties:?}");
    for inputs in PERMUTATIONS {
        for outputs in PERMUTATIONS {
            let file = text(inputs, outputs);
            let (inputs, outputs) = (channels(&file, "encoder"), channels(&file, "motor"));
            let (believed, driven, reached) = pressed(&file, inputs, outputs);
            // The same arm behind other cables: the same numbers, to the bit.
            assert_eq!(believed, angles, "{inputs:?} {outputs:?}");
            assert_eq!(outputs.map(|output| driven[output]), duties, "{inputs:?} {outputs:?}");
            assert_eq!(reached.to_bits(), depth.to_bits());
        }
    }
}

#[test]
fn the_constants_written_for_firmware_have_the_wiring_of_the_file() {
    for inputs in PERMUTATIONS {
        for outputs in PERMUTATIONS {
            let file = text(inputs, outputs);
            let rust = source(&OwnDevice::parse(&file, "my.toml").unwrap(), "my.toml");
            let wanted = format!("Wiring::try_new({:?}, {:?})", channels(&file, "encoder"), channels(&file, "motor"));
            assert!(rust.contains(&wanted), "{wanted}: {rust}");
            let wiring = Wiring::try_new(inputs.map(|input| input as u8), outputs.map(|output| output as u8));
            // A count on the channel of joint j is joint j's; its torque comes out at its own channel.
            for joint in 0..3 {
                let mut at_inputs = [0; 3];
                at_inputs[inputs[joint]] = 7;
                assert_eq!(wiring.unwrap().joints(at_inputs)[joint], 7);
                let mut of_joints = [0; 3];
                of_joints[joint] = 7;
                assert_eq!(wiring.unwrap().outputs(of_joints)[outputs[joint]], 7);
            }
        }
    }
}
