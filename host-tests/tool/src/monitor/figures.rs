//! A record in units of people.

use palpate::servo::{Fault, Phase};
use palpate::track::Contact;
use palpate::wire::Record;

/// Figures of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// The record itself.
    pub record: Record,
    /// Servo rate since the record before, Hz, by the device's own clock.
    pub rate: Option<f64>,
    /// The shortest and the longest period since the record before, microseconds.
    pub periods: [f64; 2],
    /// The longest that a tick took since the record before, microseconds.
    pub took: f64,
}

impl Figures {
    /// The figures of a record that came after `last`.
    pub fn new(record: Record, last: Option<&Record>) -> Self {
        let microseconds = |counts: u32| f64::from(counts) * 1e6 / f64::from(record.clock);
        let rate = last.and_then(|last| {
            let (ticks, counts) = (record.tick - last.tick, record.began.wrapping_sub(last.began));
            (counts > 0).then(|| f64::from(ticks) * f64::from(record.clock) / f64::from(counts))
        });
        Self {
            record,
            rate,
            periods: [record.shortest, record.longest].map(microseconds),
            took: microseconds(record.took),
        }
    }

    /// The force's magnitude, N.
    pub fn force(&self) -> f64 {
        self.record.force.iter().map(|component| f64::from(*component).powi(2)).sum::<f64>().sqrt()
    }

    /// The phase's word.
    pub fn phase(&self) -> &'static str {
        match Phase::ALL.into_iter().find(|phase| *phase as u8 == self.record.phase) {
            Some(Phase::Reset) => "reset",
            Some(Phase::Calibrate) => "calibrate",
            Some(Phase::Armed) => "armed",
            Some(Phase::Running) => "running",
            Some(Phase::Fault) => "fault",
            None => "unknown",
        }
    }

    /// The contact's word.
    pub fn contact(&self) -> &'static str {
        match Contact::ALL.into_iter().find(|contact| *contact as u8 == self.record.contact) {
            Some(Contact::Behind) => "behind",
            Some(Contact::InFront) => "in front",
            Some(Contact::Touching) => "touching",
            None => "unknown",
        }
    }

    /// The fault, in words.
    pub fn fault(&self) -> String {
        match (self.record.fault, Fault::from_code(self.record.fault)) {
            (0, _) => "no fault".to_owned(),
            (_, Some(fault)) => format!("{fault} at tick {}", self.record.fault_tick),
            (code, None) => format!("unknown fault {code} at tick {}", self.record.fault_tick),
        }
    }
}
