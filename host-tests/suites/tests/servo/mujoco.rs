//! WoodenHaptics in MuJoCo, where `PALPATE_MUJOCO` names a Python that has it: `host-tests/mujoco/arm.py` over a pipe.

use palpate_sim::motion::Moving;
use palpate_sim::plant::{Encoder, HandSettings, Motor, PlantSettings, Vector};
use std::io::{Read as _, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The arm at the far end.
pub struct Mujoco {
    python: Child,
    asks: ChildStdin,
    answers: ChildStdout,
    encoders: [Encoder; 3],
    motors: [Motor; 3],
    pub angles: Vector,
    position: Vector,
    velocity: Vector,
}

impl Mujoco {
    /// An arm at rest with these joint angles; `None` where there is no MuJoCo.
    pub fn start(settings: &PlantSettings, angles: Vector) -> Option<Self> {
        let python = std::env::var_os("PALPATE_MUJOCO")?;
        let mut python = Command::new(python)
            .arg(palpate_suites::repository("host-tests/mujoco/arm.py"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the Python of PALPATE_MUJOCO starts");
        let (mut asks, answers) = (python.stdin.take().unwrap(), python.stdout.take().unwrap());
        let numbers = settings.numbers().expect("an arm");
        writeln!(asks, "{}", numbers.replacen('{', &format!("{{\"angles\": {angles:?}, "), 1)).unwrap();
        let (encoders, motors) = (settings.encoders(), settings.motors());
        let mut mujoco =
            Self { python, asks, answers, encoders, motors, angles, position: [0.0; 3], velocity: [0.0; 3] };
        mujoco.read();
        Some(mujoco)
    }

    fn read(&mut self) {
        let mut bytes = [0; 72];
        self.answers.read_exact(&mut bytes).expect("MuJoCo answers");
        let numbers: [f64; 9] =
            core::array::from_fn(|index| f64::from_le_bytes(bytes[8 * index..][..8].try_into().unwrap()));
        for (to, from) in [&mut self.angles, &mut self.position, &mut self.velocity].into_iter().zip(numbers.chunks(3))
        {
            to.copy_from_slice(from);
        }
    }
}

impl Moving for Mujoco {
    fn counts(&self) -> [i32; 3] {
        core::array::from_fn(|joint| self.encoders[joint].counts(self.angles[joint]))
    }

    fn position(&self) -> Vector {
        self.position
    }

    fn velocity(&self) -> Vector {
        self.velocity
    }

    fn advance(&mut self, duties: [i16; 3], aim: Vector, aim_velocity: Vector, grip: HandSettings) {
        let torques: Vector =
            core::array::from_fn(|joint| self.motors[joint].aim(duties[joint]) * self.motors[joint].torque_per_ampere);
        let asked = [torques, aim, aim_velocity].concat().into_iter().chain([grip.stiffness, grip.damping]);
        let bytes: Vec<u8> = asked.flat_map(f64::to_le_bytes).collect();
        self.asks.write_all(&bytes).expect("MuJoCo listens");
        self.read();
    }
}

impl Drop for Mujoco {
    fn drop(&mut self) {
        let _ = self.python.kill();
        let _ = self.python.wait();
    }
}
