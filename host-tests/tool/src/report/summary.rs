//! The figures of a run.

use crate::simulation::Trace;
use palpate::device::Refusal;
use palpate::servo::Fault;
use palpate::track::Contact;
use std::collections::BTreeSet;
use std::fmt;

/// Counted instructions of the servo tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instructions {
    /// The median over the run.
    pub median: u32,
    /// The worst tick.
    pub largest: u32,
}

/// The figures of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Servo rate, Hz.
    pub rate: f64,
    /// Ticks done.
    pub ticks: usize,
    /// Changes of the boundary mode.
    pub mode_changes: usize,
    /// Changes of the feature that has the witness point.
    pub feature_changes: usize,
    /// Features that had it: faces, edges, vertices.
    pub features: [usize; 3],
    /// Number of times that contact started.
    pub touches: usize,
    /// Ticks until the contacts were located, if they were.
    pub located: Option<usize>,
    /// Seconds in contact.
    pub contact_time: f64,
    /// Largest force, N.
    pub largest_force: f64,
    /// Largest depth in contact, metres.
    pub largest_penetration: f64,
    /// Contacts released because they were too deep or no motion explained them, where they are counted.
    pub contacts_lost: Option<u32>,
    /// Frames lost, late or damaged, as the loop counted them.
    pub frames_lost: u32,
    /// Rejected controller steps.
    pub rejected_steps: u32,
    /// The latched fault and its tick.
    pub fault: Option<(Fault, u32)>,
    /// Why homing was refused.
    pub refusal: Option<Refusal>,
    /// A hash over the digest of every tick's state: two runs that agree in it agreed in every bit.
    pub state_hash: u32,
    /// Instructions a tick, where the board counts them.
    pub instructions: Option<Instructions>,
}

impl Summary {
    /// The figures of a trace.
    pub fn new(trace: &Trace) -> Self {
        let reports = || trace.samples.iter().map(|sample| &sample.report);
        let touching = |report: &&palpate::wire::Report| report.contact == Contact::Touching as u8;
        let changes = |differs: fn(&palpate::wire::Report, &palpate::wire::Report) -> bool| {
            trace.samples.windows(2).filter(|pair| differs(&pair[0].report, &pair[1].report)).count()
        };
        let mut counted: Vec<u32> = reports().map(|report| report.instructions).filter(|count| *count > 0).collect();
        counted.sort_unstable();
        let last = trace.samples.last().map(|sample| sample.report).unwrap_or_default();
        Self {
            rate: trace.rate,
            ticks: trace.samples.len(),
            mode_changes: changes(|before, after| before.mode != after.mode),
            feature_changes: changes(|before, after| before.feature != after.feature),
            features: features(&trace.samples.iter().map(|sample| sample.report.feature).collect()),
            touches: changes(|before, after| {
                after.contact == Contact::Touching as u8 && before.contact != Contact::Touching as u8
            }),
            located: reports().position(|report| report.contact != Contact::Behind as u8).map(|tick| tick + 1),
            contact_time: reports().filter(touching).count() as f64 / trace.rate,
            largest_force: reports().map(|report| norm(report.force)).fold(0.0, f64::max),
            largest_penetration: reports().filter(touching).map(|report| -f64::from(report.gap)).fold(0.0, f64::max),
            contacts_lost: trace.contacts_lost,
            frames_lost: last.frames_lost,
            rejected_steps: last.rejected_steps,
            state_hash: reports().fold(0, |hash, report| (hash ^ report.digest).wrapping_mul(0x0100_0193)),
            refusal: Refusal::from_code(last.refusal),
            fault: Fault::from_code(last.fault).map(|fault| (fault, last.fault_tick)),
            instructions: counted
                .last()
                .map(|largest| Instructions { median: counted[counted.len() / 2], largest: *largest }),
        }
    }

    /// The figures as rows of a name and a value.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let instructions = match self.instructions {
            Some(Instructions { median, largest }) => format!("{median} median, {largest} at most"),
            None => "not counted on the host".to_owned(),
        };
        let [faces, edges, vertices] = self.features;
        let fault = match self.fault {
            Some((fault, tick)) => {
                let why = self.refusal.map_or(String::new(), |refusal| format!(": {refusal}"));
                format!("{fault}{why} (code {}) at tick {tick}", fault.code())
            }
            None => "none".to_owned(),
        };
        let lost = self.contacts_lost.filter(|count| *count > 0);
        let lost = lost.map(|count| ("contacts lost", contacts_lost(count)));
        let before = [
            ("ticks", format!("{} at {} Hz", self.ticks, self.rate)),
            (
                "features",
                format!("{faces} faces, {edges} edges, {vertices} vertices in {} changes", self.feature_changes),
            ),
            ("mode changes", self.mode_changes.to_string()),
            ("located", self.located.map_or("never".to_owned(), |ticks| format!("after {ticks} ticks"))),
            ("contact time", format!("{:.3} s in {} touches", self.contact_time, self.touches)),
            ("largest force", format!("{:.2} N", self.largest_force)),
            ("largest penetration", format!("{:.2} mm", self.largest_penetration * 1e3)),
            ("frames lost", self.frames_lost.to_string()),
            ("faults", fault),
        ];
        let after = [
            ("rejected steps", self.rejected_steps.to_string()),
            ("state hash", format!("{:08x}", self.state_hash)),
            ("instructions a tick", instructions),
        ];
        before.into_iter().chain(lost).chain(after).collect()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.rows().iter().try_for_each(|(name, value)| writeln!(formatter, "  {name:<20} {value}"))
    }
}

/// A count of released contacts, with the reason.
pub fn contacts_lost(count: u32) -> String {
    format!("{count}, too deep: released at the contact limit, or a jump that no motion explains")
}

/// How many of these features are faces, edges and vertices.
fn features(met: &BTreeSet<u16>) -> [usize; 3] {
    let mut counts = [0; 3];
    for code in met {
        counts[usize::from(code >> 14)] += 1;
    }
    counts
}

/// The length of a vector.
pub(super) fn norm(vector: [f32; 3]) -> f64 {
    vector.iter().map(|component| f64::from(*component).powi(2)).sum::<f64>().sqrt()
}
