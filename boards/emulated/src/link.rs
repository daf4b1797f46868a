//! The way to the host. The binary chooses its medium: `uart` or `fifo`.

use palpate::wire::{Sensors, frame::Received};

/// Carries frames between this board and the host.
pub trait Link {
    /// The next frame, or `None` if none came in time. Waits for a bounded time.
    fn receive(&mut self) -> Option<Received<Sensors>>;

    /// Sends a frame, whole.
    fn send(&mut self, frame: &[u8]);
}
