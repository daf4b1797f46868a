//! The knob's loop over two FIFOs of the host.

#![no_std]
#![no_main]

use palpate_emulated::knob::{KnobLoop, SETTINGS};
use palpate_emulated::{link_semihosting::FifoLink, ticking};

ticking!(KnobLoop<FifoLink>, SETTINGS.rate_hz, FifoLink::open());
