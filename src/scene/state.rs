//! The state of a scene between two ticks, with the changes that are possible while it is rendered.

use super::host_force::HostForce;
use super::part::PartState;
use crate::field::MAX_MODES;
use crate::math::Vec3;
use crate::servo::Tracked;
use crate::track::{Contact, Witness};

/// Everything of a scene that changes: a plain value, as the loop's own state. Change it between two ticks with
/// [`super::Scene`]'s methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneState<W, const N: usize> {
    pub(super) parts: [PartState<W>; N],
    /// Ticks so far.
    pub(super) ticks: u32,
    /// The bodies that are tracked at each tick.
    pub(super) tracked: [u8; 2],
    /// The last checked one of the other bodies.
    pub(super) turn: u8,
    /// The body in foremost contact, or the nearest.
    pub(super) felt: u8,
    /// Which groups are on.
    pub(super) groups: u32,
    /// Of the tool's spherical tip, metres.
    pub(super) tip_radius: f32,
    /// The force of all bodies on the tool, N.
    pub(super) backed: Vec3,
    /// The part that is left over from before a switch.
    pub(super) left_over: Vec3,
    /// Whether something was switched since the last tick.
    pub(super) switched: bool,
    /// The host's own force, and its limit of the whole force.
    pub(super) host: HostForce,
    /// The force of all of it on the tool, N.
    pub(super) force: Vec3,
}

impl<W: Tracked, const N: usize> SceneState<W, N> {
    /// The body of this index, if there is one.
    pub fn part(&self, index: usize) -> Option<&PartState<W>> {
        self.parts.get(index)
    }

    /// The index of the body whose witness point, gap and feature this is: the one touched deepest, or the nearest of
    /// those tracked.
    pub const fn felt(&self) -> usize {
        self.felt as usize
    }

    /// The bodies that are tracked at each tick; the second is `N` and more where there is no other.
    pub const fn tracked(&self) -> [usize; 2] {
        [self.tracked[0] as usize, self.tracked[1] as usize]
    }

    /// The force of the scene on the tool, N, in its frame, before soft start and limits.
    pub const fn force(&self) -> Vec3 {
        self.force
    }

    /// Ticks so far: the scene's clock.
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Radius of the tool's tip, metres.
    pub const fn tip_radius(&self) -> f32 {
        self.tip_radius
    }

    /// Whether the groups of these bits are on.
    pub const fn groups(&self) -> u32 {
        self.groups
    }

    pub(super) fn is_tracked(&self, index: usize) -> bool {
        usize::from(self.tracked[0]) == index || usize::from(self.tracked[1]) == index
    }

    fn primary(&self) -> &PartState<W> {
        // N is at least 1, and `felt` is below it.
        &self.parts[if usize::from(self.felt) < N { usize::from(self.felt) } else { 0 }]
    }
}

impl<W: Tracked, const N: usize> Tracked for SceneState<W, N> {
    const HAS_OWN_FORCE_ONLY: bool = true;

    #[inline]
    fn own_force(&self) -> Option<Vec3> {
        Some(self.force)
    }

    /// In the frame of the foremost body.
    fn witness(&self) -> &Witness {
        self.primary().witness.witness()
    }

    fn gap(&self) -> f32 {
        self.primary().gap
    }

    fn contact(&self) -> Contact {
        self.primary().contact
    }

    /// The feature of the foremost body: see [`SceneState::felt`].
    fn feature(&self) -> u16 {
        self.primary().witness.feature()
    }

    fn body(&self) -> u8 {
        self.felt
    }

    /// Of the foremost body.
    fn modes(&self) -> Option<[f32; MAX_MODES]> {
        self.primary().witness.modes()
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for part in &self.parts {
            part.for_each_word(&mut take);
        }
        take(self.ticks);
        take(u32::from_le_bytes([self.tracked[0], self.tracked[1], self.turn, self.felt]));
        take(self.groups);
        for vector in [self.backed, self.left_over, self.force] {
            for number in vector.to_array() {
                take(number.to_bits());
            }
        }
        self.host.for_each_word(&mut take);
        take(self.tip_radius.to_bits());
        take(u32::from(self.switched));
    }
}
