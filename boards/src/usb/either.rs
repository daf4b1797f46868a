//! Two lines, one of which has a host.

use crate::Port;
use palpate::wire::frame::DELIMITER;

/// A line that knows whether a host has it open.
pub trait Plug: Port {
    /// Whether one has, as of the last turn.
    fn is_open(&self) -> bool;
}

/// The plug while a host has it open, else the UART. One host at a time: what the other line says meanwhile is
/// forgotten, so that nothing of it is done late, and it hears nothing. A host that is not heard any more is a link
/// that is lost.
#[derive(Debug)]
pub struct Either<U, P> {
    plug: U,
    uart: P,
    /// Which of them was heard last.
    is_plug: bool,
}

impl<U: Plug, P: Port> Either<U, P> {
    /// Both.
    pub const fn new(plug: U, uart: P) -> Self {
        Self { plug, uart, is_plug: false }
    }
}

impl<U: Plug, P: Port> Port for Either<U, P> {
    fn send(&mut self, byte: u8) -> bool {
        if self.plug.is_open() { self.plug.send(byte) } else { self.uart.send(byte) }
    }

    fn receive(&mut self) -> Option<u8> {
        let is_plug = self.plug.is_open();
        if is_plug != self.is_plug {
            self.is_plug = is_plug;
            // Half a frame of the line that is left ends here, and this byte is of neither.
            return Some(DELIMITER);
        }
        let (plug, uart) = (self.plug.receive(), self.uart.receive());
        if is_plug { plug } else { uart }
    }
}
