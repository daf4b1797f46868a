//! A device and the person at it.

use super::Device;
use anyhow::bail;
use clap::ValueEnum;
use palpate::wire::Marked;
use std::fmt;

/// The servo rate of a device that is simulated, Hz.
pub const RATE: f32 = 4_000.0;
/// Number of equal readings that show that a joint is at rest: a joint that swings back reverses within one of them,
/// not within four.
const STILL: u32 = 4;
/// Number of readings within which the device repeats a missed report of a mark.
const TOLD_AGAIN: u32 = 10;
/// Maximum number of readings until the joints rest: ten seconds.
const MOST: u32 = 500;

/// A device and the person at it.
pub struct Lab {
    /// The device at its line.
    pub device: Device,
    /// The person.
    pub hands: Box<dyn Hands>,
}

/// Reference for zero and ratio of the encoders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Zero {
    /// Two angles about the middle of the workspace, by jig or protractor
    #[default]
    Jig,
    /// The end stops, which are where the file's ranges end
    Stops,
    /// Two angles as for a jig, and each joint's index mark, by which the board is homed
    Index,
}

impl Lab {
    /// The joints are put at these angles, rad, and held: the counts once they are still, to a count.
    ///
    /// # Errors
    /// A line that fell silent, or joints that do not come to rest.
    pub fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<[i32; 3]> {
        self.still(|hands| hands.place(angles))
    }

    /// The same in the pose in which the device is homed, which its file has at these angles.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<[i32; 3]> {
        self.still(|hands| hands.pose(angles))
    }

    /// Has one joint moved past its mark to these angles; returns the device's report on the marks.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<Marked> {
        self.still(|hands| hands.pass(joint, angles))?;
        // The device repeats its report now and then.
        for _ in 0..TOLD_AGAIN {
            self.device.step(None)?;
        }
        Ok(self.device.marked())
    }

    /// The counts after an action of the hands, once the joints rest.
    fn still(&mut self, what: impl FnOnce(&mut dyn Hands) -> anyhow::Result<()>) -> anyhow::Result<[i32; 3]> {
        // The key is let go before anybody reaches in.
        self.device.step(None)?;
        what(&mut *self.hands)?;
        let (mut began, mut still) = (self.device.step(None)?.counts, 0);
        for _ in 0..MOST {
            let counts = self.device.step(None)?.counts;
            let is_still = counts.iter().zip(began).all(|(now, before)| now.wrapping_sub(before).unsigned_abs() <= 1);
            (began, still) = if is_still { (began, still + 1) } else { (counts, 0) };
            if still == STILL {
                return Ok(counts);
            }
        }
        bail!("the joints do not come to rest: hold them against something that does not give")
    }
}

// Differences between the measurement and the file.

/// A sentence: the joint, the quantity and the difference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding(pub String);

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// Whether a number differs from the file's by more than this fraction.
pub(super) fn differs(found: f64, before: f64, share: f64) -> bool {
    (found - before).abs() > share * before.abs()
}

// The person at the device.

/// Actions of a person at the bench, or of a simulated one.
pub trait Hands {
    /// Puts the joints at these angles, rad, by jig, stop or protractor, and holds them.
    ///
    /// # Errors
    /// Nobody is there any more.
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()>;

    /// Holds the device in the pose in which it is homed, which its file has at these angles, rad.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<()>;

    /// Moves one joint slowly past its index mark to where these angles have it, rad, and holds the others.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<()>;

    /// Lets one joint rest against a support where it is, so that its motor can move it only one way, `towards` rising
    /// angles (1) or falling ones (−1); goes on holding the others.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()>;

    /// Carries the arm's weight and leaves the joint on this motor output free to move.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn carry(&mut self, _output: u8) -> anyhow::Result<()> {
        Ok(())
    }

    /// Has a known weight pull at the probe with this force, N, over a pulley if necessary; zero removes it. Returns
    /// the weight's force, N.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64>;

    /// Presses the device's enable button and goes on holding it, or lets it go.
    ///
    /// # Errors
    /// As [`Self::place`].
    fn enable(&mut self, pressed: bool) -> anyhow::Result<()>;
}
