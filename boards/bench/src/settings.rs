//! What is chosen about the loop of a board, beside the servo's own settings.

use palpate::servo::FrameBridge;

/// Between which voltages the motors' supply is believed to be on, V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupplyRange {
    /// Below it the supply is off, or breaks down under load.
    pub least: f32,
    /// Above it braking motors have charged it up.
    pub most: f32,
}

impl SupplyRange {
    /// A supply of 24 V that is on, and does not break down.
    pub const TWENTY_FOUR: Self = Self { least: 20.0, most: 30.0 };
}

/// The settings of the loop. Begin with [`Settings::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Counts of the board's counter in a second, Hz.
    pub clock: u32,
    /// A record is sent every so many ticks, and whenever something changes.
    pub ticks_per_record: u32,
    /// How many bad sensor frames in a row are bridged by the velocity estimate; one more is a fault. 0 bridges none.
    pub bad_frames: u32,
    /// The motors' supply; `None` does not watch it.
    pub supply: Option<SupplyRange>,
    /// Seconds within which the stop input or the supply must say why an amplifier that was driving is no longer ready.
    /// The motors are off meanwhile; after it, it is the amplifier's own fault.
    pub ready_grace: f32,
}

impl Settings {
    /// 20 ticks a record, which 500,000 baud carry at 4 kHz; two bad frames bridged; no supply watched; 50 ms for a
    /// contactor to fall.
    pub const fn new(clock: u32) -> Self {
        Self {
            clock,
            ticks_per_record: 20,
            bad_frames: FrameBridge::<1>::DEFAULT_IN_A_ROW,
            supply: None,
            ready_grace: 0.05,
        }
    }
}
