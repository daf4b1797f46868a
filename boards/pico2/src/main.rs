//! Skeleton.
#![no_std]
#![no_main]
use rp235x_hal as hal;
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! { loop {} }
#[hal::entry]
fn main() -> ! { loop {} }
