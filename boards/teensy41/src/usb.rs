//! The USB plug.
//!
//! The driver masks no interrupt here. It waits for the controller in three places: until a packet is handed to it,
//! until what was handed is taken back after a reset of the bus, until the eight bytes of a request are whole. Those
//! loops have no bound of their own: a controller that never answers is found by the watchdog, for main hangs.

use cortex_m::singleton;
use imxrt_ral::read_reg;
use imxrt_ral::usb::USB1;
use palpate_bench::usb::{Chip, PACKET};
use teensy4_bsp::usbd::{BusAdapter, EndpointMemory, EndpointState, Instances, Speed};
use usb_device::bus::UsbBusAllocator;

/// A request each way, a packet each way, the notification that a serial device may send.
static MEMORY: EndpointMemory<{ 4 * PACKET + 8 }> = EndpointMemory::new();
/// Endpoints 0 to 2, each way. The controller reads and writes both where they lie: in DTCM, which has no cache.
static STATE: EndpointState<6> = EndpointState::new();

/// The controller's bus, at full speed: a packet of high speed would be 512 bytes. Its clock is that of `board::t41`.
///
/// # Panics
/// The second time; its peripherals are there once.
pub fn bus(usb: Instances<1>) -> &'static UsbBusAllocator<BusAdapter> {
    // SAFETY: main alone reaches the bus, and no interrupt does.
    let bus = unsafe { BusAdapter::without_critical_sections(usb, &MEMORY, &STATE, Speed::LowFull) };
    let bus = singleton!(: UsbBusAllocator<BusAdapter> = UsbBusAllocator::new(bus));
    let Some(bus) = bus else { panic!("there is one plug") };
    bus
}

/// The bus's functions that usb-device does not use.
pub struct Plug;

impl Chip<BusAdapter> for Plug {
    fn configured(&mut self, bus: &BusAdapter) {
        bus.configure();
    }

    fn is_suspended(&self) -> bool {
        // SAFETY: a register that is only read here; the driver, which owns the others, runs in main too.
        let registers = unsafe { USB1::instance() };
        read_reg!(imxrt_ral::usb, registers, PORTSC1, SUSP == 1)
    }
}
