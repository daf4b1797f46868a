//! Logs changes with defmt (feature `defmt`). Call it where the records of [`super::telemetry`] come out, below the
//! servo: the log's transport may wait, the loop may not.

use super::Record;
use crate::servo::{Fault, Phase, ResetReason};
use crate::track::{BoundaryMode, Contact};

/// Logs the differences from the record before.
#[derive(Clone, Copy, Debug, Default)]
pub struct Changes {
    last: Option<Record>,
}

impl Changes {
    /// Logs the record's changes: phase, feature, boundary mode and contact as information, overruns and dropped
    /// records as warnings, a fault as an error.
    pub fn log(&mut self, record: &Record) {
        let tick = record.tick;
        let last = self.last.replace(*record);
        let Some(last) = last else {
            defmt::info!("tick {}: reset reason {}, phase {}", tick, reset(record), phase(record));
            return;
        };
        if record.phase != last.phase {
            defmt::info!("tick {}: phase {} -> {}", tick, phase(&last), phase(record));
        }
        if record.feature != last.feature {
            defmt::info!("tick {}: feature {=u16:#06x} -> {=u16:#06x}", tick, last.feature, record.feature);
        }
        if record.mode != last.mode {
            defmt::info!("tick {}: mode {} -> {}", tick, mode(&last), mode(record));
        }
        if record.contact != last.contact {
            defmt::info!("tick {}: contact {} -> {}", tick, contact(&last), contact(record));
        }
        if record.overruns != last.overruns {
            defmt::warn!("tick {}: {} overruns", tick, record.overruns);
        }
        if record.dropped != last.dropped {
            defmt::warn!("tick {}: {} records dropped", tick, record.dropped);
        }
        if let Some(fault) = Fault::from_code(record.fault)
            && record.fault != last.fault
        {
            defmt::error!("tick {}: fault {}, seen at tick {}", tick, fault, record.fault_tick);
        }
    }
}

// A record made here has no other numbers than these.

fn phase(record: &Record) -> Phase {
    Phase::ALL.into_iter().find(|phase| *phase as u8 == record.phase).unwrap_or_default()
}

fn reset(record: &Record) -> ResetReason {
    ResetReason::ALL.into_iter().find(|reason| *reason as u8 == record.reset).unwrap_or_default()
}

fn mode(record: &Record) -> BoundaryMode {
    BoundaryMode::ALL.into_iter().find(|mode| *mode as u8 == record.mode).unwrap_or_default()
}

fn contact(record: &Record) -> Contact {
    Contact::ALL.into_iter().find(|contact| *contact as u8 == record.contact).unwrap_or_default()
}
