//! The settings of a board's loop, beside the servo's own.

use crate::JogSettings;
use palpate::device::SupplyRange;
use palpate::servo::FrameBridge;

/// The settings of the loop. Start from [`Settings::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Counts of the board's counter in a second, Hz.
    pub clock: u32,
    /// Ticks between two records; one is also sent whenever something changes.
    pub ticks_per_record: u32,
    /// How many bad sensor frames in a row are bridged by the velocity estimate; one more is a fault. 0 bridges none.
    pub bad_frames: u32,
    /// The motors' supply, told here and nowhere else; `None` does not watch it. While it is out of its range the
    /// motors are held off, which is no fault.
    pub supply: Option<SupplyRange>,
    /// Seconds within which the stop input or the supply must say why an amplifier that was driving is no longer ready.
    /// The motors are off meanwhile; after it, it is the amplifier's own fault.
    pub ready_grace: f32,
    /// Of a servo that watches its link ([`palpate::servo::Safety::link_timeout_s`]): whether there is no force before a
    /// host was heard. Otherwise the link is watched from a host's first command on.
    pub needs_host: bool,
    /// Whether there is no force after a reset before the stop button has been pressed, and let go of: a contact that is
    /// welded, or a wire to ground, shows in no other way.
    pub tests_stop: bool,
    /// Limits of jogging while the device is set up; `None` offers nothing of the kind.
    pub jog: Option<JogSettings>,
}

impl Settings {
    /// 20 ticks a record, which 500,000 baud carry at 4 kHz; two bad frames bridged; no supply watched; 50 ms for a
    /// contactor to fall; a host where the link is watched; stop untested;
    /// [`JogSettings::DEFAULT`].
    pub const fn new(clock: u32) -> Self {
        Self {
            clock,
            ticks_per_record: 20,
            bad_frames: FrameBridge::<1>::DEFAULT_IN_A_ROW,
            supply: None,
            ready_grace: 0.05,
            needs_host: true,
            tests_stop: false,
            jog: Some(JogSettings::DEFAULT),
        }
    }
}
