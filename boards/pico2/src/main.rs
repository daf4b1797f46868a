//! palpate on a Raspberry Pi Pico 2: three magnetic angle sensors, three bridges, a button that asks for force.
//!
//! The servo runs in the interrupt of a PWM slice that is used as a timer; nothing delays it but the moments for which
//! the USB driver masks interrupts ([`usb`]). Below it `main` sends telemetry and feeds the watchdog. Both are the loop
//! of every board (`boards/src`); here are this one's clocks, pins and memory. The README has the wiring; [`body`] is
//! what to change first.

#![no_std]
#![no_main]

mod body;
mod bus;
mod chip;
mod pins;
mod port;
mod ring;
mod set_up;
mod supply;
mod ticks;
mod usb;

use crate::body::This;
use crate::pins::Board;
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Shared, Ticking};
use rp235x_hal::entry;
use rp235x_hal::pac::interrupt;

/// The loop, or with the feature `accept` the tick of a board that is being accepted: it has no way to drive a motor.
#[cfg(not(feature = "accept"))]
type Loop = palpate_bench::Bench<'static, This, Board, 3>;
#[cfg(feature = "accept")]
type Loop = palpate_bench::accept::Acceptance<'static, This, Board, 3>;
/// Its telemetry.
type Message = <Loop as Ticking>::Message;

static SHARED: Shared<Loop> = Shared::new();

#[interrupt]
fn PWM_IRQ_WRAP_0() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    SHARED.tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Message, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    let below = set_up::set_up(QUEUE, LOOP);
    #[cfg(feature = "accept")]
    below.examine(&SHARED.mailbox, &This, &set_up::BENCH);
    #[cfg(not(feature = "accept"))]
    below.run(&SHARED.mailbox, &body::SETTINGS, &body::offers());
}
