//! palpate on a Raspberry Pi Pico 2: three magnetic angle sensors, three bridges, a button that asks for force.
//!
//! The servo runs in the interrupt of a PWM slice that is used as a timer; nothing delays it but the moments for which
//! the USB driver masks interrupts ([`usb`]). Below it `main` sends telemetry and feeds the watchdog. What both do is
//! the loop of every board (`boards/bench`); here are this one's clocks, pins and memory. The README has the wiring;
//! [`body`] is what to change first.

#![no_std]
#![no_main]

mod body;
mod chip;
#[path = "../../felt.rs"]
mod felt;
#[cfg(feature = "host")]
#[path = "../../host_memory.rs"]
mod host;
mod pins;
mod port;
#[path = "../../program.rs"]
mod program;
mod set_up;
mod supply;
mod ticks;
mod usb;

use palpate::wire::telemetry::Queue;
use rp235x_hal::entry;
use rp235x_hal::pac::interrupt;

use crate::pins::Board;
use crate::program::{Loop, Message};

#[interrupt]
fn PWM_IRQ_WRAP_0() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    program::tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Message, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    set_up::set_up(QUEUE, LOOP).run()
}
