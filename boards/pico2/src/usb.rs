//! The USB plug.
//!
//! The HAL's driver masks interrupts, the tick's too, while it asks the controller or copies a packet: without a loop
//! that waits, but long enough to be seen in the record's shortest and longest period. So what masks lies in RAM
//! (`memory.x`), where no cache can miss. Packets lie in the controller's own memory, the rest of them with main.

use cortex_m::singleton;
use rp235x_hal::clocks::UsbClock;
use rp235x_hal::pac::{RESETS, USB, USB_DPRAM};
use rp235x_hal::usb::UsbBus;
use usb_device::bus::UsbBusAllocator;

/// The controller's bus. No pin says whether the plug is in: the driver takes it to be, and a plug that is out is a bus
/// that is suspended. The clock is the crystal's, by a PLL of its own.
///
/// # Panics
/// The second time; its peripherals are there once.
pub fn bus(usb: USB, memory: USB_DPRAM, clock: UsbClock, resets: &mut RESETS) -> &'static UsbBusAllocator<UsbBus> {
    let bus = UsbBusAllocator::new(UsbBus::new(usb, memory, clock, true, resets));
    let Some(bus) = singleton!(: UsbBusAllocator<UsbBus> = bus) else { panic!("there is one plug") };
    bus
}
