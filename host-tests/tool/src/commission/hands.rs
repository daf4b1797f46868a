//! Whoever stands at the device.

/// What a person does at the bench, or a simulation of one.
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

    /// Makes a known weight pull at the probe, over a pulley where it must, along this force, N; none for zero. How
    /// much it is, N.
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
