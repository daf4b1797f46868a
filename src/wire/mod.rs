//! Frames between the device and a host.
//!
//! A frame is `COBS(postcard(message) · CRC-32) · 0x00`. [`frame`] packs and unpacks, [`Sensors`] goes to the device and
//! [`Report`] comes back; one of each a tick.
//!
//! In lockstep the host sends the sensors of tick `n`, the device answers with the report of tick `n`, and only then
//! comes `n + 1`. A host that has nothing to say in a tick sends an empty frame, so that the device need not wait.
//!
//! # Byte by byte
//!
//! Fields follow each other in the order below, without names, lengths or gaps (postcard). *var* is LEB128: seven bits a
//! byte, the lowest first, bit 7 set where another byte follows. *zig-zag* is a signed number `n` as the var
//! `2n` (`n ≥ 0`) or `−2n − 1`. *f32* is four bytes, IEEE 754, little-endian. *flag* is 0 or 1.
//!
//! | [`Sensors`], to the device | bytes | | [`Report`], back | bytes |
//! |---|---|---|---|---|
//! | `tick` | var, 1–5 | | `tick` | var, 1–5 |
//! | `counts`, three | zig-zag, 1–5 each | | `duties`, three | zig-zag, 1–3 each |
//! | `enable` | flag, 1 | | `phase` | 1 |
//! | | | | `fault` | 1 |
//! | | | | `fault_tick` | var, 1–5 |
//! | | | | `refusal` | 1 |
//! | | | | `reset` | 1 |
//! | | | | `overruns` | var, 1–5 |
//! | | | | `mode` | 1 |
//! | | | | `contact` | 1 |
//! | | | | `room` | 1 |
//! | | | | `parameters`, two | f32 each |
//! | | | | `probe`, three | f32 each |
//! | | | | `gap` | f32 |
//! | | | | `force`, three | f32 each |
//! | | | | `frames_lost` | var, 1–5 |
//! | | | | `steps_undone` | var, 1–5 |
//! | | | | `instructions` | var, 1–5 |
//! | | | | `digest` | var, 1–5 |
//!
//! Then the CRC-32 of these bytes (IEEE 802.3), four bytes, little-endian. All of it goes through COBS: with a zero appended,
//! each stretch up to a zero is written as its length plus one and its bytes without the zero (a stretch of 254 bytes or more
//! is cut, but no frame is so long). A `0x00` ends the frame. There is no version: a message of another shape than expected
//! has bytes left over or missing, and is refused as damaged.

pub mod frame;
mod message;
mod report;
pub use message::{Report, Sensors};
