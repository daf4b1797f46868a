//! A magnetic sensor at the end of a shaft.

use crate::plant::random::Random;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// A sensor that measures the angle of a magnet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagneticSensor {
    /// Counts per turn.
    pub counts_per_turn: f64,
    /// Angle of the shaft at which it starts to count, rad.
    pub angle_at_zero: f64,
    /// Amplitude of its error once a turn, rad: a magnet that is not centred.
    pub eccentricity: f64,
    /// Its noise, rad, 1 σ; uniform between ±√3 σ.
    pub noise: f64,
    /// Age of its angle, s.
    pub delay: f64,
    /// Whether it counts in the opposite direction.
    pub reversed: bool,
}

/// Fault of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MagneticFault {
    /// It repeats its last reading.
    Stuck,
    /// It does not answer.
    Absent,
    /// The magnet is gone: it reports that, and an angle of nothing but noise.
    Magnet,
    /// It is off by this number of counts: the magnet slipped.
    Slipped(i32),
}

/// The sensor at work.
#[derive(Clone, Debug)]
pub struct Sensing {
    sensor: MagneticSensor,
    /// Angles that are not old enough yet, and the time that has passed since each.
    passed: VecDeque<(f64, f64)>,
    seen: f64,
    noise: f64,
    random: Random,
    fault: Option<(MagneticFault, i32)>,
}

impl Sensing {
    pub fn new(sensor: MagneticSensor, angle: f64) -> Self {
        Self { sensor, passed: VecDeque::new(), seen: angle, noise: 0.0, random: Random::new(5), fault: None }
    }

    /// A sub-step has passed, s, and the shaft is at this angle, rad.
    pub fn pass(&mut self, angle: f64, sub_step: f64) {
        for (_, age) in &mut self.passed {
            *age += sub_step;
        }
        self.passed.push_back((angle, 0.0));
        while let Some(&(old, age)) = self.passed.front()
            && age >= self.sensor.delay - 1e-12
        {
            self.seen = old;
            self.passed.pop_front();
        }
    }

    /// A period has passed: its noise is another.
    pub fn sample(&mut self) {
        let most = self.sensor.noise * 3_f64.sqrt();
        self.noise = self.random.between(-most, most);
    }

    pub fn spoil(&mut self, fault: Option<MagneticFault>) {
        self.fault = fault.map(|fault| (fault, self.sound()));
    }

    fn sound(&self) -> i32 {
        let MagneticSensor { counts_per_turn, angle_at_zero, eccentricity, reversed, .. } = self.sensor;
        let turned = self.seen + self.noise - angle_at_zero;
        let shown = turned + eccentricity * turned.sin();
        let way = if reversed { -1.0 } else { 1.0 };
        (way * shown / TAU * counts_per_turn).floor() as i32
    }

    /// Whether it reports a field that is too weak.
    pub fn has_lost_magnet(&self) -> bool {
        matches!(self.fault, Some((MagneticFault::Magnet, _)))
    }

    pub fn counts(&self) -> Option<i32> {
        match self.fault {
            None => Some(self.sound()),
            // Its noise keeps it from looking frozen.
            Some((MagneticFault::Magnet, since)) => Some(since + (self.noise * 1e4) as i32),
            Some((MagneticFault::Stuck, since)) => Some(since),
            Some((MagneticFault::Absent, _)) => None,
            Some((MagneticFault::Slipped(by), _)) => Some(self.sound().wrapping_add(by)),
        }
    }
}
