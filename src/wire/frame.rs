//! Packing and unpacking of frames: `COBS(postcard(message) · CRC-32) · 0x00`.
//!
//! COBS keeps `0x00` out of a frame, so after any error on the line the next frame starts at the next `0x00`. The CRC
//! (IEEE 802.3, little-endian) covers the message and accepts one in four thousand million randomly damaged frames; it
//! detects every single flipped bit of a frame, also in the lengths that COBS inserts, where one bit moves zeros about.
//! A frame is accepted only if it holds exactly one message.

use core::marker::PhantomData;

use cobs::{DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc, Table};
use postcard::ser_flavors::{Cobs, Slice, crc::CrcModifier};
use serde::{Serialize, de::DeserializeOwned};
use thiserror::Error;

/// The capacity for any frame of this crate's messages, bytes, the final `0x00` included; a message may still grow.
pub const MAX_FRAME: usize = 128;

/// Ends a frame, and never occurs inside one. Alone it is an empty frame: nothing to say this tick.
pub const DELIMITER: u8 = 0;

/// One table of 1 KB and about 8 instructions a byte. Without a table a report of 80 bytes costs 4,000 instructions, a
/// tenth of a 4 kHz tick; the sixteen-fold table takes 16 KB of flash to save 300.
static CHECKSUM: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);
const CHECKSUM_BYTES: usize = 4;

/// Why a message is not packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FrameError {
    /// The buffer is too small for the frame; [`MAX_FRAME`] bytes hold any.
    #[error("the buffer is too small for the frame")]
    BufferTooSmall,
}

/// Packs a message into a frame at the start of `buffer` and gives that part back.
///
/// ```
/// use palpate::wire::{Sensors, frame};
///
/// let mut buffer = [0; frame::MAX_FRAME];
/// let sensors = Sensors { tick: 7, counts: [-1, 0, 1], enable: true };
/// let bytes = frame::pack(&sensors, &mut buffer)?;
/// assert_eq!(bytes.last(), Some(&frame::DELIMITER));
/// # Ok::<(), frame::FrameError>(())
/// ```
///
/// # Errors
/// [`FrameError::BufferTooSmall`]; the buffer's contents are then undefined.
pub fn pack<'a, M: Serialize>(message: &M, buffer: &'a mut [u8]) -> Result<&'a [u8], FrameError> {
    let encoder = Cobs::try_new(Slice::new(buffer)).map_err(|_| FrameError::BufferTooSmall)?;
    postcard::serialize_with_flavor(message, CrcModifier::new(encoder, CHECKSUM.digest()))
        .map(|frame| &*frame)
        .map_err(|_| FrameError::BufferTooSmall)
}

/// The result of a delimiter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Received<M> {
    /// A whole message.
    Message(M),
    /// Something that is no frame of this message: cut short, overlong, changed on the way, or another message.
    Damaged,
    /// A delimiter with nothing before it.
    Empty,
}

/// Takes bytes as they arrive and returns messages. Starts again at every [`DELIMITER`].
///
/// ```
/// use palpate::wire::{Sensors, frame};
/// use palpate::wire::frame::{Received, Receiver};
///
/// let mut buffer = [0; frame::MAX_FRAME];
/// let sensors = Sensors { tick: 7, counts: [-1, 0, 1], enable: true };
/// let bytes = frame::pack(&sensors, &mut buffer)?;
///
/// let mut receiver = Receiver::<Sensors>::new();
/// let received = bytes.iter().find_map(|byte| receiver.feed(*byte));
/// assert_eq!(received, Some(Received::Message(sensors)));
/// # Ok::<(), frame::FrameError>(())
/// ```
#[derive(Debug)]
pub struct Receiver<M> {
    decoder: DecoderState,
    decoded: [u8; MAX_FRAME],
    length: usize,
    contents: Contents,
    message: PhantomData<fn() -> M>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Contents {
    Empty,
    Good,
    Overlong,
}

impl<M: DeserializeOwned> Receiver<M> {
    /// A receiver at the start of a frame.
    pub const fn new() -> Self {
        Self {
            decoder: DecoderState::Idle,
            decoded: [0; MAX_FRAME],
            length: 0,
            contents: Contents::Empty,
            message: PhantomData,
        }
    }

    /// Takes the next byte; a delimiter returns the frame's result. Bounded work: a frame is decoded as it arrives and
    /// checked once at its end.
    pub fn feed(&mut self, byte: u8) -> Option<Received<M>> {
        let step = self.decoder.feed(byte);
        if byte == DELIMITER {
            let received = match (self.contents, step) {
                (Contents::Empty, _) => Received::Empty,
                (Contents::Good, Ok(DecodeResult::DataComplete)) => {
                    self.unpack().map_or(Received::Damaged, Received::Message)
                }
                _ => Received::Damaged,
            };
            self.length = 0;
            self.contents = Contents::Empty;
            return Some(received);
        }
        if self.contents == Contents::Empty {
            self.contents = Contents::Good;
        }
        if let Ok(DecodeResult::DataContinue(decoded)) = step {
            match self.decoded.get_mut(self.length) {
                Some(place) => {
                    *place = decoded;
                    self.length += 1;
                }
                None => self.contents = Contents::Overlong,
            }
        }
        None
    }

    fn unpack(&self) -> Option<M> {
        let (message, checksum) = self.decoded.get(..self.length)?.split_last_chunk::<CHECKSUM_BYTES>()?;
        if CHECKSUM.checksum(message) != u32::from_le_bytes(*checksum) {
            return None;
        }
        // postcard stops at the message's end: more bytes mean that the other side sent another message.
        match postcard::take_from_bytes(message) {
            Ok((message, [])) => Some(message),
            _ => None,
        }
    }
}

impl<M: DeserializeOwned> Default for Receiver<M> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{DeviceMessage, Record, Report, Sensors};

    const SENSORS: Sensors = Sensors { tick: 70_000, counts: [-1, 0, i32::MAX], enable: true };

    /// Every number takes its longest encoding.
    const LONGEST_REPORT: Report = Report {
        tick: u32::MAX,
        duties: [i16::MIN; 3],
        phase: u8::MAX,
        fault: u8::MAX,
        fault_tick: u32::MAX,
        refusal: u8::MAX,
        reset: u8::MAX,
        overruns: u32::MAX,
        feature: u16::MAX,
        mode: u8::MAX,
        contact: u8::MAX,
        room: u8::MAX,
        parameters: [-1.5; 2],
        probe: [-1.5; 3],
        gap: -1.5,
        force: [-1.5; 3],
        frames_lost: u32::MAX,
        rejected_steps: u32::MAX,
        instructions: u32::MAX,
        digest: u32::MAX,
    };

    /// How many results the bytes give, and the last one.
    fn feed<M: DeserializeOwned + Copy>(receiver: &mut Receiver<M>, bytes: &[u8]) -> (usize, Option<Received<M>>) {
        let results = bytes.iter().filter_map(|byte| receiver.feed(*byte));
        results.fold((0, None), |(count, _), received| (count + 1, Some(received)))
    }

    #[test]
    fn messages_come_back_as_they_were() {
        let mut buffer = [0; MAX_FRAME];
        let mut receiver = Receiver::new();
        for tick in [0, 1, 127, 128, 255, 256, 65_535, u32::MAX] {
            let sensors = Sensors { tick, ..SENSORS };
            let frame = pack(&sensors, &mut buffer).unwrap();
            assert_eq!(feed(&mut receiver, frame), (1, Some(Received::Message(sensors))));
        }
    }

    #[test]
    fn the_bytes_are_those_of_the_table() {
        let mut buffer = [0; MAX_FRAME];
        // By hand: 70,000 = 4·16,384 + 34·128 + 112; −1 is 1, 0 is 0, 2³¹ − 1 is 2³² − 2; true. The CRC by any tool.
        let message = [0xf0, 0xa2, 0x04, 1, 0, 0xfe, 0xff, 0xff, 0xff, 0x0f, 1];
        let [a, b, c, d] = CHECKSUM.checksum(&message).to_le_bytes();
        assert!(![a, b, c, d].contains(&0));
        let expected = [5, 0xf0, 0xa2, 0x04, 1, 11, 0xfe, 0xff, 0xff, 0xff, 0x0f, 1, a, b, c, d, 0];
        assert_eq!(pack(&SENSORS, &mut buffer), Ok(&expected[..]));
    }

    #[test]
    fn the_longest_report_fits_with_room_to_spare() {
        let mut buffer = [0; MAX_FRAME];
        let frame = pack(&LONGEST_REPORT, &mut buffer).unwrap();
        assert!(frame.len() <= MAX_FRAME - 32, "{} bytes", frame.len());
        assert_eq!(feed(&mut Receiver::new(), frame), (1, Some(Received::Message(LONGEST_REPORT))));
    }

    #[test]
    fn the_longest_record_fits() {
        let longest = DeviceMessage::Record(Record {
            tick: u32::MAX,
            number: u32::MAX,
            clock: u32::MAX,
            began: u32::MAX,
            shortest: u32::MAX,
            longest: u32::MAX,
            took: u32::MAX,
            dropped: u32::MAX,
            phase: u8::MAX,
            fault: u8::MAX,
            fault_tick: u32::MAX,
            reset: u8::MAX,
            overruns: u32::MAX,
            bridged: u32::MAX,
            bad_frames: u16::MAX,
            gains: [u8::MAX; 3],
            hold: u8::MAX,
            feature: u16::MAX,
            mode: u8::MAX,
            contact: u8::MAX,
            gap: -1.5,
            probe: [-1.5; 3],
            force: [-1.5; 3],
            duties: [i16::MIN; 3],
        });
        let mut buffer = [0; MAX_FRAME];
        let frame = pack(&longest, &mut buffer).unwrap();
        // Some of the spare bytes went into the rate of bad frames and the gains; twelve are left to grow.
        assert!(frame.len() <= MAX_FRAME - 12, "{} bytes", frame.len());
        assert_eq!(feed(&mut Receiver::new(), frame), (1, Some(Received::Message(longest))));
    }

    #[test]
    fn the_longest_frame_of_an_acceptance_fits() {
        use crate::wire::acceptance::{Finding, Ticks};
        let longest = Finding::Ticks(Ticks {
            number: u32::MAX,
            ticks: u32::MAX,
            began: u32::MAX,
            shortest: u32::MAX,
            longest: u32::MAX,
            took: u32::MAX,
            overruns: u32::MAX,
            bad: [u32::MAX; 5],
            in_a_row: u32::MAX,
            panel: u8::MAX,
            supply: u32::MAX,
            gains: [u8::MAX; 3],
        });
        let mut buffer = [0; MAX_FRAME];
        let frame = pack(&longest, &mut buffer).unwrap();
        assert!(frame.len() <= MAX_FRAME - 32, "{} bytes", frame.len());
        assert_eq!(feed(&mut Receiver::new(), frame), (1, Some(Received::Message(longest))));
    }

    #[test]
    fn the_longest_order_and_upload_fit() {
        use crate::scene::{BodyPose, Command};
        use crate::wire::{CHUNK, HostMessage, Upload};
        let pose = BodyPose { position: [-1.5; 3], orientation: [-1.5; 4] };
        let (velocity, angular_velocity) = ([-1.5; 3], [-1.5; 3]);
        let order = Command::Lead { body: u8::MAX, pose, velocity, angular_velocity, seconds: -1.5 };
        let part = Upload::Bytes { at: u32::MAX, bytes: [[u8::MAX; 16]; CHUNK / 16] };
        let number = u16::MAX;
        for longest in [HostMessage::Command { number, command: order }, HostMessage::Upload { number, part }] {
            let mut buffer = [0; MAX_FRAME];
            let frame = pack(&longest, &mut buffer).unwrap();
            assert!(frame.len() <= MAX_FRAME - 32, "{} bytes", frame.len());
            assert_eq!(feed(&mut Receiver::new(), frame), (1, Some(Received::Message(longest))));
        }
    }

    #[test]
    fn a_small_buffer_is_refused() {
        let mut buffer = [0; MAX_FRAME];
        let whole = pack(&SENSORS, &mut buffer).unwrap().len();
        for length in 0..whole {
            assert_eq!(pack(&SENSORS, &mut buffer[..length]), Err(FrameError::BufferTooSmall));
        }
    }

    /// Feeds the damaged bytes and a good frame, and asserts that only the good frame is taken.
    fn assert_refused_and_resynchronised(bytes: &[u8]) {
        let mut receiver = Receiver::<Sensors>::new();
        for byte in bytes {
            assert!(!matches!(receiver.feed(*byte), Some(Received::Message(_))), "{bytes:x?} was taken");
        }
        // Whatever the damage left open ends here.
        receiver.feed(DELIMITER);
        let mut buffer = [0; MAX_FRAME];
        let good = pack(&SENSORS, &mut buffer).unwrap();
        assert_eq!(feed(&mut receiver, good), (1, Some(Received::Message(SENSORS))));
    }

    #[test]
    fn every_flipped_bit_is_found() {
        let mut buffer = [0; MAX_FRAME];
        let length = pack(&SENSORS, &mut buffer).unwrap().len();
        for bit in 0..length * 8 {
            let mut damaged = buffer;
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert_refused_and_resynchronised(&damaged[..length]);
        }
    }

    #[test]
    fn every_truncation_is_found() {
        let mut buffer = [0; MAX_FRAME];
        let length = pack(&SENSORS, &mut buffer).unwrap().len();
        for kept in 1..length - 1 {
            let mut receiver = Receiver::<Sensors>::new();
            feed(&mut receiver, &buffer[..kept]);
            assert_eq!(receiver.feed(DELIMITER), Some(Received::Damaged), "{kept} bytes kept");
            assert_refused_and_resynchronised(&buffer[..kept]);
        }
    }

    #[test]
    fn an_overlong_frame_is_damaged_however_long() {
        let mut receiver = Receiver::<Sensors>::new();
        for length in [MAX_FRAME, MAX_FRAME + 1, 255, 256, 1_000] {
            for filling in [1, 2, 0xff] {
                for _ in 0..length {
                    assert_eq!(receiver.feed(filling), None);
                }
                assert_eq!(receiver.feed(DELIMITER), Some(Received::Damaged));
            }
        }
        assert_refused_and_resynchronised(&[0xff; 300]);
    }

    #[test]
    fn a_lone_delimiter_is_empty() {
        let mut receiver = Receiver::<Sensors>::new();
        assert_eq!(feed(&mut receiver, &[DELIMITER; 3]), (3, Some(Received::Empty)));
    }

    #[test]
    fn another_message_is_damaged_though_its_checksum_holds() {
        #[derive(Serialize)]
        struct Longer(Sensors, u8);
        let mut buffer = [0; MAX_FRAME];
        let frame = pack(&Longer(SENSORS, 0), &mut buffer).unwrap();
        assert_eq!(feed(&mut Receiver::<Sensors>::new(), frame), (1, Some(Received::Damaged)));
        let frame = pack(&1_u8, &mut buffer).unwrap();
        assert_eq!(feed(&mut Receiver::<Sensors>::new(), frame), (1, Some(Received::Damaged)));
    }

    #[test]
    fn the_checksum_is_the_one_of_ethernet() {
        // The check value of the catalogue of parametrised CRC algorithms.
        assert_eq!(CHECKSUM.checksum(b"123456789"), 0xcbf4_3926);
    }
}
