//! Every bit of every tick in one number, and what was visited.

use core::fmt;

use palpate::servo::{Remembered, ServoState, Tracked};
use palpate::track::Contact;

/// The tally of the ticks so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Ticks so far.
    pub ticks: u32,
    /// Every bit of the state after each of them.
    pub digest: u32,
    /// Boundary modes visited, a bit each, by their number.
    pub modes: u32,
    /// Features that had the witness point: faces by their index, edges in the next word, vertices in the last.
    pub features: [u32; 3],
    /// Phases visited.
    pub phases: u32,
    /// Faults seen, by their code.
    pub faults: u32,
    /// Times that the surface was met.
    pub touches: u32,
    /// Ticks in contact.
    pub touching: u32,
    /// Rejected controller steps.
    pub rejected: u32,
}

impl Tally {
    /// Takes in the state after a tick.
    pub fn add<W: Tracked, G: Remembered>(&mut self, before: Contact, state: &ServoState<3, W, G>) {
        self.ticks += 1;
        self.digest = (self.digest.rotate_left(5) ^ state.digest()).wrapping_mul(0x0100_0193);
        self.modes |= 1 << state.witness().witness().mode as u32;
        let feature = state.witness().feature();
        self.features[usize::from(feature >> 14)] |= 1 << (feature & 31);
        self.phases |= 1 << state.phase() as u32;
        self.faults |= state.fault().map_or(0, |(fault, _)| 1 << fault.code());
        let touches = state.contact() == Contact::Touching;
        self.touching += u32::from(touches);
        self.touches += u32::from(touches && before != Contact::Touching);
        self.rejected += u32::from(state.rejected_steps() > 0);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ticks, digest, modes, features, phases, faults, touches, touching, rejected } = self;
        write!(
            formatter,
            "ticks {ticks} digest {digest:08x} modes {modes:02x} features {:x}.{:x}.{:x} phases {phases:02x} ",
            features[0], features[1], features[2]
        )?;
        write!(formatter, "faults {faults:04x} touches {touches} touching {touching} rejected {rejected}")
    }
}
