//! The simulated dial: a motor with three phases on an inverter, a magnetic sensor behind it, a hand on its rim.

mod heat;
mod magnetic;
mod winding;

pub use heat::PhaseHeat;
pub use magnetic::{MagneticFault, MagneticSensor};
pub use winding::{Inverter, ThreePhaseMotor};

use magnetic::Sensing;
use std::f64::consts::TAU;
use winding::Windings;

/// A part of the cogging: `torque · sin(times θ + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cogging {
    /// How often it comes in a turn.
    pub times: f64,
    /// N·m.
    pub torque: f64,
    /// rad.
    pub phase: f64,
}

/// The dial. It has its own numbers and takes none from the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DialSettings {
    /// The motor.
    pub motor: ThreePhaseMotor,
    /// The inverter that drives it.
    pub inverter: Inverter,
    /// The sensor.
    pub sensor: MagneticSensor,
    /// Torque between its magnets and its teeth.
    pub cogging: [Cogging; 3],
    /// Rotor, magnet and dial, kg·m².
    pub inertia: f64,
    /// N·m·s/rad.
    pub viscous_friction: f64,
    /// N·m.
    pub coulomb_friction: f64,
    /// Angle of the dial at the start, rad.
    pub angle: f64,
    /// Integration steps in a servo period.
    pub sub_steps: u32,
    /// Delay from the tick's start until new pulse widths take effect, servo periods: computation, and the rest of a
    /// period.
    pub delay_periods: f64,
}

impl DialSettings {
    /// A knob on a gimbal motor GBM5208-75T with an AS5047P, on a SimpleFOCShield at 12 V.
    ///
    /// Published: 11 pole pairs, 7.5 Ω a phase, 80 rpm/V (users of the motor), and the sensor's 14 bits, 100 µs and
    /// 0.068° of noise (data sheet, without its dynamic compensation). Assumed: everything else. 2 mH are of such
    /// motors' size; the rotor's 60 g at 25 mm and a dial of 30 g make 5e-5 kg·m²; 24 slots and 22 poles cog 264 times
    /// a turn, and 22 and 24 times as no two poles or teeth are alike; 0.3° for a magnet that is not quite centred; 0.5
    /// µs of dead time at 25 kHz, which is on the large side.
    pub const fn gimbal_knob() -> Self {
        Self {
            motor: ThreePhaseMotor { pole_pairs: 11.0, resistance: 7.5, inductance: 2e-3, rpm_per_volt: 80.0 },
            inverter: Inverter { supply: 12.0, dead_share: 0.0125, ripple: 0.03, lost: None },
            sensor: MagneticSensor {
                counts_per_turn: 16_384.0,
                angle_at_zero: 0.7,
                eccentricity: 0.3 / 360.0 * TAU,
                noise: 0.068 / 360.0 * TAU,
                delay: 1e-4,
                reversed: false,
            },
            cogging: [
                Cogging { times: 22.0, torque: 3e-3, phase: 0.4 },
                Cogging { times: 24.0, torque: 2e-3, phase: 2.0 },
                Cogging { times: 264.0, torque: 1e-3, phase: 1.0 },
            ],
            inertia: 5e-5,
            viscous_friction: 2e-5,
            coulomb_friction: 1e-3,
            angle: 0.3,
            sub_steps: 20,
            delay_periods: 0.25,
        }
    }
}

/// Grip of the hand, which pulls the dial towards an angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fingers {
    /// N·m/rad.
    pub stiffness: f64,
    /// N·m·s/rad.
    pub damping: f64,
    /// Target angle, rad.
    pub aim: f64,
    /// How fast that turns, rad/s.
    pub rate: f64,
}

impl Fingers {
    /// None.
    pub const NONE: Self = Self { stiffness: 0.0, damping: 0.0, aim: 0.0, rate: 0.0 };

    /// A clamp that is next to rigid, at an angle: what a torque is measured with.
    pub const fn clamp(aim: f64) -> Self {
        Self { stiffness: 50.0, damping: 0.05, aim, rate: 0.0 }
    }

    /// A hand that moves it at a rate, rad/s, against any motor of its size: 1 N·m costs it 0.2 rad/s.
    pub const fn forcing(rate: f64) -> Self {
        Self { stiffness: 0.0, damping: 5.0, aim: 0.0, rate }
    }

    /// Fingers that turn it: as stiff as a light grip of 300 N/m on a rim of 20 mm.
    pub const fn turning(aim: f64, rate: f64) -> Self {
        Self { stiffness: 0.12, damping: 2e-3, aim, rate }
    }
}

/// The dial in a hand.
#[derive(Clone, Debug)]
pub struct Dial {
    settings: DialSettings,
    windings: Windings,
    sensing: Sensing,
    fingers: Fingers,
    angle: f64,
    rate: f64,
    /// Widths in force; `None` while the stage is disabled.
    widths: Option<[f64; 3]>,
    period: f64,
    elapsed: u64,
    /// Motor's and cogging's torque over the last period, N·m.
    torque: f64,
}

impl Dial {
    /// A dial at rest, without current.
    ///
    /// # Panics
    /// For no sub-steps.
    pub fn new(settings: DialSettings, rate_hz: f64) -> Self {
        assert!(settings.sub_steps > 0, "a period has sub-steps");
        Self {
            settings,
            windings: Windings::default(),
            sensing: Sensing::new(settings.sensor, settings.angle),
            fingers: Fingers::NONE,
            angle: settings.angle,
            rate: 0.0,
            widths: None,
            period: 1.0 / rate_hz,
            elapsed: 0,
            torque: 0.0,
        }
    }

    /// The sensor's reading, continued over turns; `None` if it does not answer.
    pub fn counts(&self) -> Option<i32> {
        self.sensing.counts()
    }

    /// Whether the sensor reports that its magnet is gone.
    pub fn has_lost_magnet(&self) -> bool {
        self.sensing.has_lost_magnet()
    }

    /// One servo period under these pulse widths, 0 to 1; `None` disables the stage.
    pub fn advance(&mut self, widths: Option<[f64; 3]>) {
        let sub_step = self.period / f64::from(self.settings.sub_steps);
        let late = (self.settings.delay_periods * f64::from(self.settings.sub_steps)).round() as u32;
        let mut sum = 0.0;
        for step in 0..self.settings.sub_steps {
            if step == late.min(self.settings.sub_steps - 1) {
                self.widths = widths;
            }
            sum += self.step(sub_step);
            self.sensing.pass(self.angle, sub_step);
        }
        self.sensing.sample();
        self.torque = sum / f64::from(self.settings.sub_steps);
        self.elapsed += 1;
    }

    /// One sub-step; the torque of motor and cogging, N·m.
    fn step(&mut self, sub_step: f64) -> f64 {
        let DialSettings { motor, inverter, inertia, viscous_friction, coulomb_friction, .. } = self.settings;
        let driven = self.windings.step(&motor, &inverter, self.widths, self.angle, self.rate, sub_step);
        let given = driven + self.cogging_torque(self.angle);
        let Fingers { stiffness, damping, aim, rate } = self.fingers;
        // Everything that pulls with speed, at the step's end: the clamp is stiff.
        let pull = given + stiffness * (aim - self.angle) + damping * rate;
        let drag = viscous_friction + damping + stiffness * sub_step;
        let free = (self.rate * inertia + pull * sub_step) / (inertia + drag * sub_step);
        // Dry friction is as large as it must be to stop it, and at most its limit.
        let most = coulomb_friction * sub_step / (inertia + drag * sub_step);
        self.rate = free - free.clamp(-most, most);
        self.angle += self.rate * sub_step;
        given
    }

    /// The torque of magnets on teeth at an angle, N·m.
    pub fn cogging_torque(&self, angle: f64) -> f64 {
        self.settings.cogging.iter().map(|part| part.torque * (part.times * angle + part.phase).sin()).sum()
    }

    /// From now on the hand holds it so.
    pub fn hold(&mut self, fingers: Fingers) {
        self.fingers = fingers;
    }

    /// From now on the sensor has this fault, or none.
    pub fn spoil(&mut self, fault: Option<MagneticFault>) {
        self.sensing.spoil(fault);
    }

    /// From now on a phase is not connected, or all are.
    pub fn lose(&mut self, phase: Option<usize>) {
        self.settings.inverter.lost = phase;
    }

    /// From now on each winding has this resistance, Ω: a short between turns lowers it.
    pub fn short(&mut self, resistance: f64) {
        self.settings.motor.resistance = resistance;
    }

    /// From now on the supply has this voltage, V.
    pub fn supply(&mut self, volts: f64) {
        self.settings.inverter.supply = volts;
    }

    /// The voltage of the supply, V.
    pub fn supply_volts(&self) -> f64 {
        self.settings.inverter.supply
    }

    /// The angle, rad.
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// The rate, rad/s.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// The torque of motor and cogging on the shaft, averaged over the last period, N·m: the user feels this torque
    /// less the bearings' friction.
    pub fn torque(&self) -> f64 {
        self.torque
    }

    /// The currents of the phases, A.
    pub fn currents(&self) -> [f64; 3] {
        self.windings.currents()
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.elapsed as f64 * self.period
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 4_000.0;

    fn plain() -> DialSettings {
        let mut settings = DialSettings::gimbal_knob();
        settings.cogging = settings.cogging.map(|part| Cogging { torque: 0.0, ..part });
        settings.inverter.dead_share = 0.0;
        (settings.viscous_friction, settings.coulomb_friction) = (0.0, 0.0);
        settings
    }

    /// Widths of a vector of this amplitude, V, at an electrical angle.
    fn widths(amplitude: f64, angle: f64, supply: f64) -> [f64; 3] {
        [0.0, 1.0, 2.0].map(|phase: f64| 0.5 + amplitude / supply * (angle - phase * TAU / 3.0).cos())
    }

    #[test]
    fn a_clamped_motor_has_the_torque_of_its_constant_at_every_angle() {
        for start in [0.0, 0.13, 1.7, -2.2] {
            let settings = DialSettings { angle: start, ..plain() };
            let mut dial = Dial::new(settings, RATE);
            dial.hold(Fingers::clamp(start));
            // A quarter of an electrical turn ahead.
            let field = 11.0 * start + TAU / 4.0;
            (0..400).for_each(|_| dial.advance(Some(widths(3.0, field, 12.0))));
            // 60/(2π·80) V·s/rad between two wires is √3 of a phase's; 3/2 of it times the amplitude of the current.
            let constant = 1.5 * 60.0 / (TAU * 80.0) / 3_f64.sqrt();
            // The clamp yields 40 mN·m / 50 N·m/rad, 11 times that electrically: 1 − cos(0.009).
            assert!((dial.torque() / (constant * 3.0 / 7.5) - 1.0).abs() < 1e-4, "{start}: {}", dial.torque());
        }
    }

    #[test]
    fn turned_without_current_it_gives_the_volts_of_its_speed() {
        // Short-circuited and turned slowly, the current is the back-EMF over the resistance: it brakes with k²/R.
        let mut dial = Dial::new(plain(), RATE);
        let rate = 1.0;
        for tick in 0..2_000 {
            let aim = 0.3 + rate * f64::from(tick) / RATE;
            dial.hold(Fingers { rate, ..Fingers::clamp(aim) });
            dial.advance(Some([0.5; 3]));
        }
        let constant = 30.0 / (std::f64::consts::PI * 80.0) / 2_f64.sqrt();
        let expected = -constant * constant / 7.5 * rate;
        // (ω L/R)² = (11 · 2e-3/7.5)² = 9e-6, and the current lags by a sub-step.
        assert!((dial.torque() / expected - 1.0).abs() < 1e-3, "{} {expected}", dial.torque());
    }

    #[test]
    fn dead_time_takes_its_share_and_a_lost_phase_leaves_a_field_that_stands() {
        let mut settings = plain();
        settings.inverter.dead_share = 0.0125;
        let torque = |settings: DialSettings, field: f64| {
            let mut dial = Dial::new(DialSettings { angle: 0.0, ..settings }, RATE);
            dial.hold(Fingers::clamp(0.0));
            (0..400).for_each(|_| dial.advance(Some(widths(3.0, field, 12.0))));
            dial.torque()
        };
        // At a quarter turn no current in the first phase: ±0.15 V in the others, of 3 · 0.866 V.
        let (with, without) = (torque(settings, TAU / 4.0), torque(plain(), TAU / 4.0));
        assert!((with / without - (1.0 - 0.15 / (3.0 * 0.866_03))).abs() < 1e-3, "{with} {without}");
        settings.inverter.lost = Some(0);
        // The other two have current along one line only: none from a field across it.
        assert!(torque(settings, 0.0).abs() < 1e-4 && torque(settings, TAU / 4.0) > 0.9 * with);
    }

    #[test]
    fn a_free_dial_keeps_its_energy_and_a_rubbing_one_stops() {
        let mut settings = plain();
        settings.cogging[0].torque = 3e-3;
        let mut dial = Dial::new(settings, RATE);
        let energy =
            |dial: &Dial| 0.5 * 5e-5 * dial.rate() * dial.rate() + 3e-3 / 22.0 * (22.0 * dial.angle() + 0.4).cos();
        let start = energy(&dial);
        (0..4_000).for_each(|_| dial.advance(None));
        // The rule that turns rate before angle keeps the energy to h ω = 12.5 µs · 36 rad/s.
        assert!((energy(&dial) - start).abs() < 1e-3 * 3e-3 / 22.0 && dial.rate() != 0.0);
        let mut dial = Dial::new(DialSettings { coulomb_friction: 4e-3, ..settings }, RATE);
        (0..400).for_each(|_| dial.advance(None));
        assert_eq!(dial.rate(), 0.0);
    }
}
