//! palpate on a Nucleo-G474RE: three encoders, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of TIM7, which nothing can delay; below it `main` sends telemetry and feeds the
//! watchdog. Both are the loop of every board (`boards/src`); here are this one's clocks, pins and memory. The
//! README has the wiring; [`body`] is what to change first.

#![no_std]
#![no_main]

mod amplifiers;
mod body;
mod encoders;
#[cfg(feature = "host")]
mod host;
#[cfg(not(feature = "analog"))]
mod pulse_width;
mod set_up;
#[cfg(feature = "analog")]
mod voltage;

use cortex_m_rt::entry;
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Shared, Ticking};
use stm32g4xx_hal::stm32::interrupt;

#[cfg(not(feature = "host"))]
use crate::body::This;
#[cfg(feature = "host")]
use crate::host::This;
use crate::set_up::Board;

/// The loop, or with the feature `accept` the tick of a board that is being accepted: it has no way to drive a motor.
#[cfg(not(feature = "accept"))]
type Loop = palpate_bench::Bench<'static, This, Board, 3>;
#[cfg(feature = "accept")]
type Loop = palpate_bench::accept::Acceptance<'static, This, Board, 3>;
/// Its telemetry.
type Message = <Loop as Ticking>::Message;

static SHARED: Shared<Loop> = Shared::new();

#[interrupt]
fn TIM7() {
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
    #[cfg(all(not(feature = "accept"), not(feature = "host")))]
    below.run(&SHARED.mailbox, &body::SETTINGS, &());
    #[cfg(all(not(feature = "accept"), feature = "host"))]
    below.run(&SHARED.mailbox, &body::SETTINGS, &host::ends());
}
