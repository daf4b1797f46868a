//! A device, and whoever stands at it.

use super::{Device, Hands};
use clap::ValueEnum;

/// The servo rate of a device that is simulated, Hz.
pub const RATE: f32 = 4_000.0;

/// A device, and whoever stands at it.
pub struct Lab {
    /// The device at its line.
    pub device: Device,
    /// Whoever stands at it.
    pub hands: Box<dyn Hands>,
}

/// By which angles zero and ratio of the encoders are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Zero {
    /// Two angles about the middle of the workspace, by jig or protractor
    #[default]
    Jig,
    /// The end stops, which are where the file's ranges end
    Stops,
}

impl Lab {
    /// The joints are put at these angles, rad, and held.
    ///
    /// # Errors
    /// A line that fell silent.
    pub fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<[i32; 3]> {
        // The key is let go before anybody reaches in.
        self.device.step(None)?;
        self.hands.place(angles)?;
        for _ in 0..5 {
            self.device.step(None)?;
        }
        Ok(self.device.step(None)?.counts)
    }
}
