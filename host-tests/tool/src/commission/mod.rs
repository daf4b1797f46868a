//! Commissioning: from a device file that is only nearly right to one that was measured.
//!
//! [`Lab`] is the bench with whoever stands at it: a simulated one ([`SimulatedLab`]), or a device at a port and a
//! person who reads prompts. [`find`] asks it for what it needs and writes what it finds into the file.

mod find;
mod simulated;

pub use find::{Finding, find, find_mounting};
pub use simulated::{Planted, SimulatedLab};

use palpate::commission::JogLimits;
use palpate::device::Duty;
use palpate::wire::Reading;

/// The servo rate at which the device is set up, Hz.
pub const RATE: f32 = 4_000.0;

/// What a device allows while it is set up: a tenth of full torque would not move a Falcon; three tenths hurt nobody at
/// the speed allowed.
pub const LIMITS: JogLimits<3> =
    JogLimits { max_duty: [Duty(9_800); 3], max_speed: 20_000.0, max_travel: 4_000, patience: 0.1 };

/// The bench, and whoever stands at it.
pub trait Lab {
    /// Runs for a fiftieth of a second: with the key held, this motor at this duty; else without current.
    ///
    /// # Errors
    /// A link that fell silent.
    fn step(&mut self, jog: Option<(u8, i16)>) -> anyhow::Result<Reading>;

    /// The hand puts the joints at these angles, rad, by jig, stop or protractor, and holds them.
    ///
    /// # Errors
    /// As [`Self::step`].
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()>;

    /// The hand lets go of one joint and goes on holding the others.
    ///
    /// # Errors
    /// As [`Self::step`].
    fn let_go(&mut self, joint: usize) -> anyhow::Result<()>;

    /// A known weight pulls at the probe, over a pulley where it must: this force, N.
    ///
    /// # Errors
    /// As [`Self::step`].
    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<()>;
}
