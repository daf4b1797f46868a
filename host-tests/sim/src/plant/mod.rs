//! The simulated device and the hand that holds it: what the servo is proved against.
//!
//! A [`Plant`] takes motor duties and gives encoder counts, as the real device does. All its numbers are f64 and its
//! own, in [`PlantSettings`]: nothing is taken from the library, so that each checks the other. The same settings, hand
//! and duties give the same trace, bit for bit, on the same platform. Devices of one and two joints leave the other
//! entries of counts and duties alone.

mod arm;
mod delta;
mod dial;
mod encoder;
mod five_bar;
mod friction;
mod hand;
mod lumped;
mod mechanics;
mod mechanism;
mod motor;
mod paddle;
mod path;
mod presets;
mod random;
mod settings;
mod thermal;
mod touching;
mod validate;
mod vector;
mod within;

pub use arm::{Arm, Link};
pub use delta::DeltaSettings;
pub use dial::{
    Cogging, Dial, DialSettings, Fingers, Inverter, MagneticFault, MagneticSensor, PhaseHeat, ThreePhaseMotor,
};
pub use encoder::{Encoder, EncoderFault};
pub use five_bar::{FiveBarSettings, LinkLump, LinkageArmSettings};
pub use hand::{HandPath, HandSettings, StillHand};
pub use lumped::{Geometry, Lumped, Point, Points};
pub use mechanism::{Dynamics, Mechanism};
pub use motor::{Amplifier, Motor, Winding};
pub use paddle::PaddleSettings;
pub use path::{PathError, TouchingPath};
pub use settings::{ArmSettings, Direction, JointSettings, MechanismSettings, PlantSettings};
pub use thermal::{AIR, Thermal, ThermalSettings};
pub use touching::TouchingSettings;
pub use validate::PlantError;
pub use vector::{Matrix, Vector, dot, inverse, scaled, times};
pub use within::{direction_around, middle, place_around};

use encoder::FaultyEncoder;
use mechanics::Mechanics;
use motor::Drives;
use validate::validate;
use vector::difference;

/// The device in a hand.
pub struct Plant {
    mechanics: Mechanics,
    drives: Drives,
    encoders: [FaultyEncoder; 3],
    hand: HandSettings,
    path: Box<dyn HandPath>,
    sub_step: f64,
    sub_steps: u32,
    /// Sub-steps since the start.
    elapsed: u64,
}

impl Plant {
    /// A device at rest, without current, its probe at the start of the hand's path.
    ///
    /// # Errors
    /// A setting that makes no sense, by name; a path that starts out of reach.
    pub fn new(
        settings: &PlantSettings,
        hand: HandSettings,
        path: Box<dyn HandPath>,
        rate_hz: f64,
    ) -> Result<Self, PlantError> {
        validate(settings, &hand, rate_hz)?;
        let mechanism = settings.mechanism(hand.mass);
        let position = path.target(0.0);
        let angles = mechanism.angles(position).ok_or(PlantError::OutOfReach { position })?;
        let between = |(angle, joint): (f64, JointSettings)| joint.stops[0] <= angle && angle <= joint.stops[1];
        if !angles.into_iter().zip(settings.joints).all(between) {
            return Err(PlantError::OutOfReach { position });
        }
        let sub_step = 1.0 / (rate_hz * f64::from(settings.sub_steps));
        let delay = (settings.delay_periods * f64::from(settings.sub_steps)).round() as u64;
        Ok(Self {
            mechanics: Mechanics {
                mechanism,
                viscous: settings.joints.map(|joint| joint.viscous_friction),
                coulomb: settings.joints.map(|joint| joint.coulomb_friction),
                stops: settings.joints.map(|joint| joint.stops),
                angles,
                rates: [0.0; 3],
            },
            drives: Drives::new(settings.motors(), delay, settings.current_time_constant, sub_step),
            encoders: settings.encoders().map(FaultyEncoder::sound),
            hand,
            path,
            sub_step,
            sub_steps: settings.sub_steps,
            elapsed: 0,
        })
    }

    /// The encoders' readings.
    pub fn counts(&self) -> [i32; 3] {
        core::array::from_fn(|joint| self.encoders[joint].counts(self.mechanics.angles[joint]))
    }

    /// One servo period under these duties (±32 767 is full scale), which reach the amplifiers after the delay.
    pub fn advance(&mut self, duties: [i16; 3]) {
        self.drives.command(self.elapsed, duties);
        for _ in 0..self.sub_steps {
            let torques = self.drives.step(self.elapsed, self.mechanics.rates);
            let aims = [0.0, 0.5, 1.0].map(|share| self.aim(self.elapsed as f64 + share));
            let hand = self.hand;
            self.mechanics.step(self.sub_step, torques, |half_steps, position, velocity| {
                let (target, target_velocity) = aims[half_steps];
                hand.force(target, target_velocity, position, velocity)
            });
            self.elapsed += 1;
        }
        self.encoders.iter_mut().for_each(FaultyEncoder::tick);
    }

    /// From now on an encoder has this fault, or none. The joint is counted from 0; one that is not there is left
    /// alone.
    pub fn inject(&mut self, joint: usize, fault: Option<EncoderFault>) {
        if let (Some(encoder), Some(angle)) = (self.encoders.get_mut(joint), self.mechanics.angles.get(joint)) {
            encoder.inject(fault, *angle);
        }
    }

    /// From now on the hand holds the probe like this; [`HandSettings::NONE`] lets go. Its mass stays.
    pub fn hold(&mut self, hand: HandSettings) {
        self.hand = hand;
    }

    /// From now on the hand aims along this path.
    pub fn follow(&mut self, path: Box<dyn HandPath>) {
        self.path = path;
    }

    /// From now on a joint's end stops are here, rad: something got in the way, or broke off.
    pub fn move_stops(&mut self, joint: usize, stops: [f64; 2]) {
        if let Some(place) = self.mechanics.stops.get_mut(joint) {
            *place = stops;
        }
    }

    /// Where the hand aims, and how fast that moves.
    fn aim(&self, sub_steps: f64) -> (Vector, Vector) {
        let time = sub_steps * self.sub_step;
        (self.path.target(time), self.path.velocity(time))
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.elapsed as f64 * self.sub_step
    }

    /// The probe's position, m in the device frame (from the workspace centre).
    pub fn position(&self) -> Vector {
        self.mechanics.position()
    }

    /// The probe's velocity, m/s.
    pub fn velocity(&self) -> Vector {
        self.mechanics.velocity()
    }

    /// Joint angles, rad.
    pub fn angles(&self) -> Vector {
        self.mechanics.angles
    }

    /// Joint rates, rad/s.
    pub fn rates(&self) -> Vector {
        self.mechanics.rates
    }

    /// Motor currents, A.
    pub fn currents(&self) -> Vector {
        self.drives.currents()
    }

    /// The point the hand aims at, m in the device frame.
    pub fn hand_target(&self) -> Vector {
        self.path.target(self.time())
    }

    /// The hand's force on the probe, N.
    pub fn hand_force(&self) -> Vector {
        let (target, target_velocity) = self.aim(self.elapsed as f64);
        self.hand.force(target, target_velocity, self.position(), self.velocity())
    }

    /// Energy of motion, of height and of the hand's spring, J.
    pub fn energy(&self) -> f64 {
        let stretch = difference(self.hand_target(), self.position());
        self.mechanics.energy() + 0.5 * self.hand.stiffness * dot(stretch, stretch)
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &dyn Mechanism {
        self.mechanics.mechanism.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::vector::{add_scaled, inverse, norm, scaled, times};
    use super::*;

    const RATE: f64 = 4_000.0;

    fn smooth() -> PlantSettings {
        let mut settings = PlantSettings::wooden_haptics_2016();
        for joint in &mut settings.joints {
            (joint.viscous_friction, joint.coulomb_friction) = (0.0, 0.0);
        }
        settings
    }

    fn still(settings: &PlantSettings, hand: HandSettings, place: Vector) -> Plant {
        Plant::new(settings, hand, Box::new(StillHand(place)), RATE).unwrap()
    }

    /// The force at the probe that balances joint torques: `Jᵀ F = τ`, by way of `J Jᵀ F = J τ`.
    fn balancing_force(jacobian: &Matrix, torques: Vector) -> Vector {
        let squared = core::array::from_fn(|i| core::array::from_fn(|j| dot(jacobian[i], jacobian[j])));
        times(&inverse(&squared), times(jacobian, torques))
    }

    #[test]
    fn constant_duty_presses_on_a_stiff_hand_with_the_predicted_force() {
        let grip = HandSettings { stiffness: 1e5, damping: 200.0, mass: 0.0 };
        for gravity in [0.0, 9.81] {
            for duties in [[8_000, 0, 0], [0, 8_000, 0], [0, 0, 8_000], [-3_000, 5_000, -7_000]] {
                let settings = PlantSettings { gravity, ..smooth() };
                let mut plant = still(&settings, grip, [0.02, 0.03, -0.01]);
                let arm = settings.arm(0.0);
                let angles = plant.angles();
                (0..2_000).for_each(|_| plant.advance(duties));
                // From the published constants, not from the plant's motors.
                let ratios = [16.0, -12.0, 12.0];
                let motor: Vector =
                    core::array::from_fn(|joint| f64::from(duties[joint]) / 32_767.0 * 3.0 * 0.0259 * ratios[joint]);
                let torques = add_scaled(motor, arm.gravity_torques(angles), 1.0);
                let expected = scaled(balancing_force(&arm.jacobian(angles), torques), -1.0);
                let error = norm(difference(plant.hand_force(), expected)) / norm(expected);
                // The probe yields 5 N / 1e5 N/m = 50 µm of some 0.1 m, which turns the Jacobian by less than 1e-3.
                assert!(error < 1e-3, "{duties:?}: {:?}, expected {expected:?}", plant.hand_force());
            }
        }
    }

    #[test]
    fn a_duty_moves_the_arm_after_its_delay_to_the_sub_step() {
        for (periods, sub_steps) in [(0.0, 0), (0.5, 10), (1.0, 20), (2.0, 40)] {
            // A servo period of one integration step shows the sub-steps of the 4 kHz plant one by one.
            let settings = PlantSettings {
                gravity: 0.0,
                sub_steps: 1,
                delay_periods: periods * 20.0,
                current_time_constant: 0.0,
                ..smooth()
            };
            let mut plant =
                Plant::new(&settings, HandSettings::NONE, Box::new(StillHand([0.0; 3])), 20.0 * RATE).unwrap();
            let moved = (0..100).find(|_| {
                plant.advance([10_000, 0, 0]);
                plant.rates()[0] != 0.0
            });
            assert_eq!(moved, Some(sub_steps), "{periods} periods");

            let settings = PlantSettings { sub_steps: 20, delay_periods: periods, ..settings };
            let mut plant = still(&settings, HandSettings::NONE, [0.0; 3]);
            plant.advance([10_000, 0, 0]);
            plant.advance([0; 3]);
            plant.advance([0; 3]);
            // Full torque for the part of the three periods in which the one command is in force.
            let in_force = (3.0 - periods).min(1.0);
            let torque = 10_000.0 / 32_767.0 * 3.0 * 0.0259 * 16.0;
            let rate = torque / plant.mechanism().mass_matrix(plant.angles())[0][0] * in_force / RATE;
            // The current jumps within a sub-step, whose mean is half: at the two ends they cancel, unless one end is
            // yet to come; half a sub-step of 20. Otherwise the inertia's change over 0.1 mrad.
            let bound = if periods == 2.0 { 0.5 / 20.0 + 1e-3 } else { 1e-3 };
            assert!((plant.rates()[0] / rate - 1.0).abs() < bound, "{periods}: {} {rate}", plant.rates()[0]);
        }
    }

    #[test]
    fn currents_saturate() {
        let mut settings = smooth();
        settings.joints[1].current_limit = 1.25;
        let grip = HandSettings { stiffness: 1e4, damping: 100.0, mass: 0.0 };
        let mut plant = still(&settings, grip, [0.0; 3]);
        (0..100).for_each(|_| plant.advance([i16::MAX, i16::MAX, i16::MIN]));
        // 25 ms are 160 time constants: rounding is left.
        assert!(norm(difference(plant.currents(), [3.0, 1.25, -3.0])) < 1e-12, "{:?}", plant.currents());
    }

    #[test]
    fn energy_of_a_held_device_only_falls() {
        let mut plant = still(&PlantSettings::wooden_haptics_2016(), HandSettings::default(), [0.0, 0.02, 0.03]);
        let mut last = plant.energy();
        let start = last;
        for _ in 0..4_000 {
            plant.advance([0; 3]);
            // Rounding of 0.2 J.
            assert!(plant.energy() <= last + 1e-15, "{} s: {} J after {last} J", plant.time(), plant.energy());
            last = plant.energy();
        }
        assert!(start - last > 1e-5, "it sags and settles: {} J", start - last);
        assert!(norm(plant.velocity()) < 1e-9, "it rests: {:?}", plant.velocity());
    }

    /// A patch of a sphere of 60 mm, its top 10 mm over the workspace centre.
    fn touching(seed: u64) -> Box<TouchingPath> {
        let dome = |u: f64, v: f64| {
            let along = [u - 0.5, v - 0.5, 0.9];
            let normal = scaled(along, 1.0 / norm(along));
            (add_scaled([0.0, 0.0, -0.05], normal, 0.06), normal)
        };
        Box::new(TouchingPath::new(dome, TouchingSettings::default(), seed).unwrap())
    }

    /// Half a second under duties that depend on the counts: every bit of the trace.
    fn trace(seed: u64) -> Vec<u64> {
        let settings = PlantSettings::wooden_haptics_2016();
        let mut plant = Plant::new(&settings, HandSettings::default(), touching(seed), RATE).unwrap();
        let mut bits = Vec::new();
        for _ in 0..2_000 {
            let duties = plant.counts().map(|count| (count * 37 % 4_001 - 2_000) as i16);
            plant.advance(duties);
            for value in [plant.position(), plant.velocity(), plant.currents(), plant.hand_force()].concat() {
                bits.push(value.to_bits());
            }
        }
        bits
    }

    #[test]
    fn the_same_seed_gives_the_same_trace_bit_for_bit() {
        assert!(trace(11) == trace(11));
        assert!(trace(11) != trace(12));
    }

    #[test]
    fn the_probe_follows_the_hand_to_a_few_millimetres() {
        let settings = PlantSettings::wooden_haptics_2016();
        for seed in 0..4 {
            let mut plant = Plant::new(&settings, HandSettings::default(), touching(seed), RATE).unwrap();
            let mut farthest: f64 = 0.0;
            for _ in 0..20_000 {
                plant.advance([0; 3]);
                farthest = farthest.max(norm(difference(plant.position(), plant.hand_target())));
            }
            // The hand carries the links, about 0.5 N, and moves some 0.15 kg at up to 5 m/s²: 1.3 N on 300 N/m.
            assert!(farthest < 5e-3, "seed {seed}: {farthest} m");
            assert!((plant.time() - 5.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_finer_step_gives_the_same_motion() {
        let run = |sub_steps| {
            let settings = PlantSettings { sub_steps, ..PlantSettings::wooden_haptics_2016() };
            let mut plant = Plant::new(&settings, HandSettings::default(), touching(5), RATE).unwrap();
            for tick in 0..4_000 {
                plant.advance([if tick % 100 < 50 { 3_000 } else { -3_000 }, 0, 1_000]);
            }
            plant.position()
        };
        // Dry friction reverses at most a sub-step late: 0.01 N·m for 12.5 µs, at each of some 100 reversals, moves the
        // probe by nanometres in the time the hand's spring remembers (about 0.1 s).
        assert!(norm(difference(run(20), run(80))) < 1e-6, "{:?} {:?}", run(20), run(80));
    }

    #[test]
    fn a_start_out_of_reach_is_refused() {
        let settings = PlantSettings::wooden_haptics_2016();
        for place in [[1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]] {
            let built = Plant::new(&settings, HandSettings::default(), Box::new(StillHand(place)), RATE);
            assert!(matches!(built.err(), Some(PlantError::OutOfReach { .. })));
        }
    }
}
