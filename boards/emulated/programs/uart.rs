//! The servo loop over the UART.

#![no_std]
#![no_main]

use palpate_emulated::{board::BOARD, body::SETTINGS, link_uart::UartLink, servo_loop::ServoLoop, ticking};

ticking!(ServoLoop<UartLink>, SETTINGS.rate_hz, UartLink::new(&BOARD));
