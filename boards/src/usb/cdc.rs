//! The plug.

use super::{Bytes, Plug};
use crate::Port;
use palpate::wire::frame::DELIMITER;
use usb_device::LangID;
use usb_device::bus::{UsbBus, UsbBusAllocator};
use usb_device::device::{StringDescriptors, UsbDevice, UsbDeviceBuilder, UsbDeviceState, UsbVidPid};
use usb_device::prelude::BuilderError;
use usbd_serial::{CdcAcmClass, USB_CLASS_CDC};

/// Bytes of a packet at most. Full speed has 8, 16, 32 or 64: copied with interrupts masked where a chip's HAL does so,
/// so not the most; and control requests need more than 18, lest some hosts send the next one too early for a HAL.
pub const PACKET: usize = 32;

/// The bus is polled once in this number of turns of main. A host wants it asked every 10 ms (usb-device,
/// `UsbDevice::poll`). A turn takes or gives a byte or two, packs or checks one frame, and has no loop that waits; main
/// takes many in the 20 ms after which the watchdogs of these boards reset the chip. A turn moves a byte each way, so
/// that asking more often would find little more to move.
pub const TURNS: u8 = 16;

/// pid.codes keeps these for tests. A product needs numbers of its own.
const NUMBERS: UsbVidPid = UsbVidPid(0x1209, 0x0001);

/// The maximum current from the plug, mA: twice a Teensy 4.1's, for LED and sensors too.
const CURRENT: usize = 200;

/// A chip's functions beyond those that usb-device uses of every bus.
pub trait Chip<B> {
    /// The host has configured the device.
    fn configured(&mut self, _: &B) {}

    /// Whether the bus is suspended although its `poll` does not say so: the host sleeps, or the plug is out.
    fn is_suspended(&self) -> bool {
        false
    }
}

/// A chip whose bus wants nothing more.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plain;

impl<B> Chip<B> for Plain {}

/// A serial device at the USB plug, never waited for. Each call of [`Port`] is a turn.
pub struct Cdc<'a, B: UsbBus, C> {
    device: UsbDevice<'a, B>,
    class: CdcAcmClass<'a, B>,
    chip: C,
    /// The rest of the last packet.
    incoming: Bytes<PACKET>,
    /// The packet that goes next. Never a full one, after which a host would wait for more before it hands it on.
    outgoing: Bytes<{ PACKET - 1 }>,
    is_open: bool,
    turns: u8,
}

impl<'a, B: UsbBus, C: Chip<B>> Cdc<'a, B, C> {
    /// On this bus, whose endpoints nobody else has. The host finds it from now on.
    ///
    /// # Errors
    /// A device that USB does not allow.
    pub fn try_new(bus: &'a UsbBusAllocator<B>, chip: C) -> Result<Self, BuilderError> {
        let class = CdcAcmClass::new(bus, PACKET as u16);
        let strings = StringDescriptors::new(LangID::EN_US).manufacturer("palpate").product("palpate");
        let device = UsbDeviceBuilder::new(bus, NUMBERS)
            .strings(&[strings])?
            .device_class(USB_CLASS_CDC)
            .max_packet_size_0(PACKET as u8)?
            .max_power(CURRENT)?
            .build();
        Ok(Self { device, class, chip, incoming: Bytes::new(), outgoing: Bytes::new(), is_open: false, turns: 0 })
    }

    fn turn(&mut self) {
        self.turns += 1;
        if self.turns >= TURNS {
            self.turns = 0;
            self.poll();
        }
    }

    /// At most one event of the bus, and a packet each way. A function of its own, so that a memory map can say where
    /// it lies.
    #[inline(never)]
    fn poll(&mut self) {
        let was = self.device.state();
        self.device.poll(&mut [&mut self.class]);
        let is_configured = self.device.state() == UsbDeviceState::Configured;
        if is_configured && was != UsbDeviceState::Configured {
            self.chip.configured(self.device.bus());
        }
        let is_open = is_configured && self.class.dtr() && !self.chip.is_suspended();
        if is_open != self.is_open {
            self.is_open = is_open;
            self.incoming.clear();
            self.outgoing.clear();
            // The frame that another host left unfinished ends here.
            if is_open {
                self.incoming.push(DELIMITER);
            }
        }
        if !is_open {
            // Bytes from a closed port are old by the time that it is open. A bus that is not configured
            // has nothing to be read.
            if is_configured {
                let _ = self.class.read_packet(&mut [0; PACKET]);
            }
            return;
        }
        if self.incoming.is_empty() {
            self.incoming.fill(|bytes| self.class.read_packet(bytes).ok());
        }
        if !self.outgoing.is_empty()
            && let Ok(sent) = self.class.write_packet(self.outgoing.waiting())
        {
            self.outgoing.drop_first(sent);
        }
    }
}

impl<B: UsbBus, C: Chip<B>> Port for Cdc<'_, B, C> {
    fn send(&mut self, byte: u8) -> bool {
        self.turn();
        self.is_open && self.outgoing.push(byte)
    }

    fn receive(&mut self) -> Option<u8> {
        // Before the turn: a caller that first asks whether the port is open gets bytes of that time.
        let byte = self.incoming.pop();
        self.turn();
        byte
    }
}

impl<B: UsbBus, C: Chip<B>> Plug for Cdc<'_, B, C> {
    fn is_open(&self) -> bool {
        self.is_open
    }
}
