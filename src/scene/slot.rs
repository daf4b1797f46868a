//! A place in a scene whose body may be exchanged while the scene is rendered.

use super::part::{Material, Motion, Part, Sphere};
use super::{Command, Commanded, SceneError};
use crate::body::{Body, BodyWitness, TableCursor};
use crate::math::Vec3;
use crate::servo::{BakedTables, Surface, Touched, Tracked};
use crate::track::{Contact, Controller, Probe, Witness};

/// Storage of uploaded bodies: banks of memory, so that one can be written while another is rendered.
///
/// A bank that was taken does not change until it is left. No method may wait: the servo's interrupt calls them.
pub trait BodyStore {
    /// Takes the last uploaded and checked body, if it was not taken yet; returns its bank.
    fn take(&self) -> Option<u8>;

    /// The body of a bank that was taken.
    fn body(&self, bank: u8) -> Option<&Body<'_>>;

    /// Releases a bank that was taken: the scene no longer reads it.
    fn leave(&self, bank: u8);
}

/// A body, and where another may come from in its place ([`Command::Take`]).
pub struct Slot<'a, H> {
    baked: &'a Body<'a>,
    store: Option<&'a H>,
}

/// The state of a slot between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotWitness {
    /// The bank of the body, while it is not the one baked.
    bank: Option<u8>,
    witness: BodyWitness,
}

impl<'a, H> Slot<'a, H> {
    /// A body that stays.
    pub const fn fixed(body: &'a Body<'a>) -> Self {
        Self { baked: body, store: None }
    }

    /// A body that stands there until another is uploaded. A store is for one slot of one scene.
    pub const fn exchangeable(body: &'a Body<'a>, store: &'a H) -> Self {
        Self { baked: body, store: Some(store) }
    }

    /// Whether its body can be exchanged.
    pub const fn is_exchangeable(&self) -> bool {
        self.store.is_some()
    }
}

impl<H> core::fmt::Debug for Slot<'_, H> {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.debug_struct("Slot").field("baked", self.baked).finish_non_exhaustive()
    }
}

impl<'a, H> Part<'a, Slot<'a, H>> {
    /// A body of group 0 in a slot. The size of a future body is unknown: a body that can be exchanged is checked
    /// whenever it is its turn.
    pub const fn in_slot(slot: &'a Slot<'a, H>, motion: Motion, material: Material) -> Self {
        let sphere = match slot.store {
            None => Part::new(slot.baked, motion, material).sphere,
            Some(_) => Sphere { centre_m: Vec3::ZERO, radius_m: f32::INFINITY },
        };
        Self { surface: slot, motion, material, sphere, group: 0 }
    }
}

impl<H: BodyStore> Slot<'_, H> {
    #[inline]
    fn body(&self, bank: Option<u8>) -> &Body<'_> {
        match (bank, self.store) {
            (Some(bank), Some(store)) => store.body(bank).unwrap_or(self.baked),
            _ => self.baked,
        }
    }

    fn with(&self, bank: Option<u8>) -> SlotWitness {
        SlotWitness { bank, witness: self.body(bank).start() }
    }
}

impl<H: BodyStore> Surface for Slot<'_, H> {
    type Witness = SlotWitness;

    /// A body that is there before the first tick, as one kept in flash is, stands in the slot from the start.
    fn rest(&self) -> SlotWitness {
        self.with(self.store.and_then(BodyStore::take))
    }

    #[inline]
    fn follow(&self, controller: &Controller, state: &mut SlotWitness, probe: Probe, period: f32) -> Touched {
        self.body(state.bank).follow(controller, &mut state.witness, probe, period)
    }

    fn release(&self, state: &mut SlotWitness) {
        state.witness.forget();
    }

    fn is_too_deep(&self, state: &SlotWitness) -> bool {
        Body::is_too_deep(self.body(state.bank), &state.witness)
    }
}

impl<H: BodyStore> Commanded for Slot<'_, H> {
    fn apply(&self, state: &mut SlotWitness, command: &Command) -> Result<(), SceneError> {
        let Some(store) = self.store else { return Err(SceneError::NotOffered) };
        let bank = match command {
            Command::Take { body } => Some(store.take().ok_or(SceneError::NotUploaded(*body))?),
            Command::PutBack { .. } => None,
            _ => return Err(SceneError::NotOffered),
        };
        if let Some(left) = state.bank {
            store.leave(left);
        }
        *state = self.with(bank);
        Ok(())
    }
}

impl<H: BodyStore> BakedTables for Slot<'_, H> {
    /// Of the body that was baked; one that was uploaded was checked when it came.
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.baked.table_word(cursor)
    }

    fn table_records(&self) -> u32 {
        self.baked.table_records()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.baked.baked_crc()
    }
}

impl Tracked for SlotWitness {
    fn witness(&self) -> &Witness {
        self.witness.witness()
    }

    fn gap(&self) -> f32 {
        self.witness.gap()
    }

    fn contact(&self) -> Contact {
        self.witness.contact()
    }

    fn feature(&self) -> u16 {
        self.witness.feature()
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        take(self.bank.map_or(u32::MAX, u32::from));
        self.witness.for_each_word(take);
    }
}
