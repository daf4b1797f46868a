//! The way to the host. The binary chooses its medium: `uart` or `fifo`.

/// A frame of sensors.
#[cfg(not(feature = "wrist"))]
pub use palpate::wire::Sensors as Frame;
/// A frame of sensors.
#[cfg(feature = "wrist")]
pub use palpate::wire::WristSensors as Frame;
use palpate::wire::frame::Received;

/// Carries frames between this board and the host.
pub trait Link {
    /// The next frame, or `None` if none came in time. Waits for a bounded time.
    fn receive(&mut self) -> Option<Received<Frame>>;

    /// Sends a frame, whole.
    fn send(&mut self, frame: &[u8]);
}
