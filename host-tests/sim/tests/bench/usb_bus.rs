//! A bus that is a mock, and the host at its other end.

use palpate_bench::usb::Chip;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};
use usb_device::UsbDirection::In;
use usb_device::bus::{PollResult, UsbBus};
use usb_device::endpoint::{EndpointAddress, EndpointType};
use usb_device::{Result, UsbDirection, UsbError};

/// What lies between the two, and what the controller has noticed.
#[derive(Default)]
pub struct Wires {
    /// Endpoints handed out, each way.
    endpoints: [usize; 2],
    reset: bool,
    is_asleep: bool,
    wakes: bool,
    setup: Option<[u8; 8]>,
    /// The last packet of a request is taken, as the host does at once.
    control_taken: bool,
    /// What the device answered to requests.
    pub control: Vec<u8>,
    pub stalled: bool,
    pub address: u8,
    /// Bulk packets from the host.
    pub out: VecDeque<Vec<u8>>,
    /// The bulk packet that the controller holds until the host asks for it.
    held: Option<Vec<u8>>,
    /// Sizes of the packets that it has had.
    pub sizes: Vec<usize>,
    /// How often the bus was asked.
    pub polls: u32,
    /// How often the chip was told of a configuration.
    pub configured: u32,
    /// The controller alone knows that the bus is suspended.
    pub is_silent: bool,
}

/// Both ends' hold on it.
#[derive(Clone, Default)]
pub struct Mock(Arc<Mutex<Wires>>);

impl Mock {
    pub fn wires(&self) -> MutexGuard<'_, Wires> {
        self.0.lock().unwrap()
    }

    /// The host resets the bus: whatever the controller held is gone.
    pub fn reset(&self) {
        let mut wires = self.wires();
        (wires.reset, wires.is_asleep, wires.setup, wires.held) = (true, false, None, None);
        wires.out.clear();
    }

    pub fn sleep(&self) {
        self.wires().is_asleep = true;
    }

    pub fn wake(&self) {
        let mut wires = self.wires();
        (wires.is_asleep, wires.wakes) = (false, true);
    }

    /// A request without data to the device.
    pub fn request(&self, setup: [u8; 8]) {
        self.wires().setup = Some(setup);
    }

    /// The host asks for a packet.
    pub fn take(&self) -> Vec<u8> {
        self.wires().held.take().unwrap_or_default()
    }
}

impl Chip<Mock> for Mock {
    fn configured(&mut self, bus: &Mock) {
        bus.wires().configured += 1;
    }

    fn is_suspended(&self) -> bool {
        self.wires().is_silent
    }
}

impl UsbBus for Mock {
    fn alloc_ep(
        &mut self,
        way: UsbDirection,
        address: Option<EndpointAddress>,
        _: EndpointType,
        _: u16,
        _: u8,
    ) -> Result<EndpointAddress> {
        let mut wires = self.wires();
        let handed_out = &mut wires.endpoints[usize::from(way == In)];
        Ok(address.unwrap_or_else(|| {
            *handed_out += 1;
            EndpointAddress::from_parts(*handed_out, way)
        }))
    }

    fn enable(&mut self) {}

    fn reset(&self) {}

    fn set_device_address(&self, address: u8) {
        self.wires().address = address;
    }

    fn write(&self, endpoint: EndpointAddress, bytes: &[u8]) -> Result<usize> {
        let mut wires = self.wires();
        if endpoint.index() == 0 {
            wires.control.extend(bytes);
            wires.control_taken = true;
        } else if wires.held.is_some() {
            return Err(UsbError::WouldBlock);
        } else {
            wires.sizes.push(bytes.len());
            wires.held = Some(bytes.to_vec());
        }
        Ok(bytes.len())
    }

    fn read(&self, endpoint: EndpointAddress, bytes: &mut [u8]) -> Result<usize> {
        let mut wires = self.wires();
        let packet = match endpoint.index() {
            0 => wires.setup.take().map(Vec::from),
            _ => wires.out.pop_front(),
        };
        let packet = packet.ok_or(UsbError::WouldBlock)?;
        bytes.get_mut(..packet.len()).ok_or(UsbError::BufferOverflow)?.copy_from_slice(&packet);
        Ok(packet.len())
    }

    fn set_stalled(&self, _: EndpointAddress, stalled: bool) {
        self.wires().stalled |= stalled;
    }

    fn is_stalled(&self, _: EndpointAddress) -> bool {
        false
    }

    fn suspend(&self) {}

    fn resume(&self) {}

    fn poll(&self) -> PollResult {
        let mut wires = self.wires();
        wires.polls += 1;
        if core::mem::take(&mut wires.reset) {
            return PollResult::Reset;
        }
        if wires.is_asleep {
            return PollResult::Suspend;
        }
        if core::mem::take(&mut wires.wakes) {
            return PollResult::Resume;
        }
        let ep_out = u16::from(!wires.out.is_empty()) << 1;
        let (ep_setup, ep_in_complete) =
            (u16::from(wires.setup.is_some()), u16::from(core::mem::take(&mut wires.control_taken)));
        if ep_out | ep_setup | ep_in_complete == 0 {
            return PollResult::None;
        }
        PollResult::Data { ep_out, ep_in_complete, ep_setup }
    }
}
