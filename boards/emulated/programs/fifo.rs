//! The servo loop over two FIFOs of the host.

#![no_std]
#![no_main]

use palpate_emulated::{body::SETTINGS, link_semihosting::FifoLink, servo_loop::ServoLoop, ticking};

ticking!(ServoLoop<FifoLink>, SETTINGS.rate_hz, FifoLink::open());
