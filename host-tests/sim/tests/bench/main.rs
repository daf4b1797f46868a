//! The loop of the boards, on the host: with the simulated device at its pins, and with mocks.

mod angles;
mod calibration;
mod chopper;
mod flash;
mod frames;
mod guarded;
mod homing;
mod idle;
mod knob;
mod knob_orders;
mod knob_set_up;
mod orders;
mod panel;
mod phases;
mod pins;
mod reset;
mod set_up;
mod soft;
mod usb;
mod usb_bus;
mod wiring;
