//! What is sent and what is made of the answers. Frames are worked by hand from the data sheets.

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use palpate::device::sensor::{AmsAngle, AmsChip, AmsReading, Mt6701, Mt6701Reading, SensorError};

const ASK_ANGLE: [u8; 2] = [0xff, 0xff];
const ASK_ERRORS: [u8; 2] = [0x40, 0x01];
const ASK_DIAGNOSTICS_47: [u8; 2] = [0xff, 0xfc];
const ASK_DIAGNOSTICS_48: [u8; 2] = [0x7f, 0xfd];

/// One frame: selected, exchanged, deselected.
fn frame(sent: [u8; 2], answer: [u8; 2]) -> [Transaction<u8>; 3] {
    let exchange = Transaction::transfer_in_place(sent.to_vec(), answer.to_vec());
    [Transaction::transaction_start(), exchange, Transaction::transaction_end()]
}

fn sensor(chip: AmsChip, frames: &[([u8; 2], [u8; 2])]) -> AmsAngle<Mock<u8>> {
    let transactions: Vec<_> = frames.iter().flat_map(|(sent, answer)| frame(*sent, *answer)).collect();
    AmsAngle::new(Mock::new(&transactions), chip)
}

type Diagnostic = ([u8; 2], Result<u8, SensorError<ErrorKind>>);

/// Diagnostics: bit 8 settled, 9 overflow, 10 and 11 field, low byte the gain.
const DIAGNOSTICS: [Diagnostic; 8] = [
    ([0x81, 0x80], Err(SensorError::Damaged)),
    ([0x01, 0x80], Ok(128)),
    ([0x00, 0x80 | 0x01], Err(SensorError::Absent)),
    ([0x83, 0x80], Err(SensorError::Magnet)),
    ([0x05, 0x83], Err(SensorError::Damaged)),
    ([0x85, 0x80], Err(SensorError::Magnet)),
    ([0x89, 0x80], Err(SensorError::Magnet)),
    ([0x00, 0x00], Err(SensorError::Absent)),
];
const CHIPS: [(AmsChip, [u8; 2]); 2] = [(AmsChip::As5047p, ASK_DIAGNOSTICS_47), (AmsChip::As5048a, ASK_DIAGNOSTICS_48)];

#[test]
fn every_reading_is_an_angle_and_the_diagnostics_that_the_one_before_requested() {
    // 0x1234 has five ones: parity bit set. 0x0123 has four.
    for (diagnostics, verdict) in DIAGNOSTICS {
        for (chip, ask) in CHIPS {
            for (answer, angle) in [([0x92, 0x34], 0x1234), ([0x01, 0x23], 0x0123), ([0x00, 0x00], 0)] {
                let frames = [(ASK_ANGLE, diagnostics), (ask, answer)];
                // Where the diagnostics cannot be believed, no angle is requested.
                let mut sensor = sensor(chip, if verdict.is_ok() { &frames } else { &frames[..1] });
                assert_eq!(sensor.read(), verdict.map(|gain| AmsReading { angle, gain }), "{diagnostics:x?}");
                sensor.free().done();
            }
        }
    }
}

#[test]
fn a_sensor_starts_when_it_is_settled_and_sees_its_magnet() {
    for (diagnostics, verdict) in DIAGNOSTICS {
        for (chip, ask) in CHIPS {
            // The second frame's error flag is what the first one clears; the third requests the first reading's.
            let frames = [(ASK_ERRORS, [0x12, 0x34]), (ask, [0xc0, 0x00]), (ask, diagnostics)];
            let mut sensor = sensor(chip, &frames);
            assert_eq!(sensor.start(), verdict.map(|_| ()), "{diagnostics:x?}");
            sensor.free().done();
        }
    }
}

#[test]
fn an_angle_that_came_damaged_is_refused() {
    for (answer, error) in [
        ([0x92, 0x35], SensorError::Damaged),
        // The error flag, with parity.
        ([0xd2, 0x35], SensorError::Refused),
        ([0xff, 0xff], SensorError::Absent),
    ] {
        let frames = [(ASK_ANGLE, [0x01, 0x80]), (ASK_DIAGNOSTICS_47, answer)];
        let mut sensor = sensor(AmsChip::As5047p, &frames);
        assert_eq!(sensor.read(), Err(error));
        sensor.free().done();
    }
}

/// A bus that is off.
struct Broken;

impl ErrorType for Broken {
    type Error = ErrorKind;
}

impl SpiDevice for Broken {
    fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        Err(ErrorKind::ChipSelectFault)
    }
}

#[test]
fn a_bus_that_fails_says_so() {
    let fault = SensorError::Bus(ErrorKind::ChipSelectFault);
    let mut sensor = AmsAngle::new(Broken, AmsChip::As5047p);
    assert_eq!((sensor.start(), sensor.read()), (Err(fault), Err(fault)));
    assert_eq!(Mt6701::new(Broken).read(), Err(fault));
}

/// One reading of an MT6701 that sends these bytes.
fn mt6701(bytes: [u8; 3]) -> Result<Mt6701Reading, SensorError<ErrorKind>> {
    let transactions =
        [Transaction::transaction_start(), Transaction::read_vec(bytes.to_vec()), Transaction::transaction_end()];
    let mut sensor = Mt6701::new(Mock::new(&transactions));
    let reading = sensor.read();
    sensor.free().done();
    reading
}

#[test]
fn an_ssi_frame_is_angle_status_and_crc() {
    // Payload x⁴ (angle 1): the remainder of x¹⁰ by x⁶ + x + 1 is x⁵ + x⁴: 0x30.
    assert_eq!(mt6701([0x00, 0x04, 0x30]), Ok(Mt6701Reading { angle: 1, pressed: false }));
    // The button, x²: x⁸ leaves x³ + x²: 0x0c; together 0x3c.
    assert_eq!(mt6701([0x00, 0x05, 0x3c]), Ok(Mt6701Reading { angle: 1, pressed: true }));
    // Lost track, x³: x⁹ leaves x⁴ + x³: 0x18; field, 1 and x: 0x03 and 0x06.
    assert_eq!(mt6701([0x00, 0x06, 0x28]), Err(SensorError::TrackLost));
    assert_eq!(mt6701([0x00, 0x04, 0x40 | 0x33]), Err(SensorError::Magnet));
    assert_eq!(mt6701([0x00, 0x04, 0x80 | 0x36]), Err(SensorError::Magnet));
    assert_eq!(mt6701([0x00, 0x04, 0x31]), Err(SensorError::Damaged));
    assert_eq!(mt6701([0x00, 0x0c, 0x30]), Err(SensorError::Damaged));
    for dead in [0x00, 0xff] {
        assert_eq!(mt6701([dead; 3]), Err(SensorError::Absent));
    }
}
