//! Read access to the whole state, at no cost. Only the loop writes it.

use super::{Fault, Phase, ResetReason, Servo, ServoState, Settings, TableCheck, Tracked};
use crate::device::{Counts, Device, Duty, ElectricalAngle, HomingState};
use crate::math::Vec3;
use crate::render::{Anchor, Energy, Tool};
use crate::track::Contact;

impl<'a, S, K, const JOINTS: usize, G> Servo<'a, S, K, JOINTS, G> {
    /// The settings it was made with.
    #[inline]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Whether its homing moves the joints by their motors.
    #[inline]
    pub const fn homing_drives(&self) -> bool {
        match &self.homing {
            Some(homing) => homing.drives(),
            None => false,
        }
    }

    /// Where the field of each motor is to be for the duties that the state now has; `None` for motors that do not have
    /// three phases ([`crate::device::Reference::Fields`]), and before the first good counts.
    #[inline]
    pub fn fields<W, H>(&self, state: &ServoState<JOINTS, W, H>) -> Option<[ElectricalAngle; JOINTS]> {
        self.homing.as_ref()?.fields(&state.homing, state.counts?)
    }

    /// Its device.
    #[inline]
    pub const fn device(&self) -> &'a Device<K, JOINTS> {
        self.device
    }

    /// What it feels.
    #[inline]
    pub const fn surface(&self) -> &'a S {
        self.surface
    }
}

impl<const JOINTS: usize, W, G> ServoState<JOINTS, W, G> {
    /// What the loop is doing.
    #[inline]
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// What stopped it, and at which tick. Latched.
    #[inline]
    pub const fn fault(&self) -> Option<(Fault, u32)> {
        self.fault
    }

    /// Why the chip was reset before the loop began.
    #[inline]
    pub const fn reset(&self) -> ResetReason {
        self.reset
    }

    /// Ticks done.
    #[inline]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Frames lost, late or damaged so far.
    #[inline]
    pub const fn frames_lost(&self) -> u32 {
        self.frames_lost
    }

    /// Ticks that overran so far.
    #[inline]
    pub const fn overruns(&self) -> u32 {
        self.overruns
    }

    /// How often contact was lost so far: ended because no motion explained it, see [`super::ContactLimits`].
    #[inline]
    pub const fn contacts_lost(&self) -> u32 {
        self.lost_contact.count
    }

    /// Whether the surface is touched and the probe deeper inside than its least radius of curvature: the closest point
    /// is no longer unique there, and the witness point not proved to follow (theory §11). Ordinary where a small
    /// fillet is pressed.
    #[inline]
    pub const fn is_too_deep(&self) -> bool {
        self.is_too_deep
    }

    /// Ticks since the host was heard.
    #[inline]
    pub const fn link_silence(&self) -> u32 {
        self.link_silence
    }

    /// Whether the device is homed.
    #[inline]
    pub const fn homed(&self) -> bool {
        self.homed
    }

    /// How far homing has come.
    #[inline]
    pub const fn homing(&self) -> &HomingState<JOINTS> {
        &self.homing
    }

    /// Joint angle in the middle of count zero, radians: the encoders' own, or what homing found.
    #[inline]
    pub const fn angles_at_zero(&self) -> [f32; JOINTS] {
        self.angles_at_zero
    }

    /// How far the check of the tables has come.
    #[inline]
    pub const fn table_check(&self) -> &TableCheck {
        &self.table_check
    }

    /// Controller steps that were rejected because the distance would have risen.
    #[inline]
    pub const fn rejected_steps(&self) -> u32 {
        self.rejected_steps
    }

    /// The last good encoder counts; `None` before the first.
    #[inline]
    pub const fn counts(&self) -> Option<[Counts; JOINTS]> {
        self.counts
    }

    /// Joint angles, radians.
    #[inline]
    pub const fn angles(&self) -> [f32; JOINTS] {
        self.angles
    }

    /// Joint rates, rad/s, as estimated.
    #[inline]
    pub const fn rates(&self) -> [f32; JOINTS] {
        self.rates
    }

    /// How much room there is to the rim of the workspace ([`crate::device::Device::room`]): 1 well inside; the force
    /// is multiplied by it.
    #[inline]
    pub const fn room(&self) -> f32 {
        self.room
    }

    /// The probe in the body's frame, metres.
    #[inline]
    pub const fn probe(&self) -> Vec3 {
        self.probe
    }

    /// The virtual tool; it is the probe unless there is a coupling.
    #[inline]
    pub const fn tool(&self) -> Tool {
        self.tool
    }

    /// The witness point.
    #[inline]
    pub const fn witness(&self) -> &W {
        &self.witness
    }

    /// The same for what its surface lets be changed between two ticks, as a [`crate::scene::Scene`] does.
    #[inline]
    pub const fn witness_mut(&mut self) -> &mut W {
        &mut self.witness
    }

    /// Where friction holds the surface.
    #[inline]
    pub const fn anchor(&self) -> Anchor {
        self.anchor
    }

    /// What the passivity observer counted.
    #[inline]
    pub const fn energy(&self) -> Energy {
        self.energy
    }

    /// How far the force is faded in, 0 to 1.
    #[inline]
    pub const fn fade(&self) -> f32 {
        self.fade
    }

    /// Force on the probe, N, in the device's frame, as the motors give it.
    #[inline]
    pub const fn force(&self) -> Vec3 {
        self.force
    }

    /// Duties now applied.
    #[inline]
    pub const fn duties(&self) -> [Duty; JOINTS] {
        self.duties
    }

    /// What the guard remembers.
    #[inline]
    pub const fn guard(&self) -> &G {
        &self.guard
    }
}

impl<const JOINTS: usize, W: Tracked, G> ServoState<JOINTS, W, G> {
    /// Signed gap along the outward normal, metres; negative behind the surface.
    #[inline]
    pub fn gap(&self) -> f32 {
        self.witness.gap()
    }

    /// Whether the surface is touched.
    #[inline]
    pub fn contact(&self) -> Contact {
        self.witness.contact()
    }
}
