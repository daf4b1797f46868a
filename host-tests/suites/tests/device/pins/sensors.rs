//! What is sent and what is made of the answers. Frames are worked by hand from the data sheets.

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use palpate::device::sensor::{AmsAngle, AmsChip, Mt6701, Mt6701Reading, SensorError};

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

#[test]
fn an_angle_belongs_to_the_frame_before() {
    // 0x1234 has five ones: parity bit set. 0x0123 has four.
    let mut sensor =
        sensor(AmsChip::As5047p, &[(ASK_ANGLE, [0x12, 0x35]), (ASK_ANGLE, [0x92, 0x34]), (ASK_ANGLE, [0x01, 0x23])]);
    assert_eq!(sensor.read(), Ok(None), "the first frame answers nobody");
    assert_eq!(sensor.read(), Ok(Some(0x1234)));
    assert_eq!(sensor.read(), Ok(Some(0x0123)));
    sensor.free().done();
}

#[test]
fn a_fresh_angle_takes_two_frames() {
    let mut sensor = sensor(AmsChip::As5048a, &[(ASK_ANGLE, [0x01, 0x23]), (ASK_ANGLE, [0x92, 0x34])]);
    assert_eq!(sensor.read_fresh(), Ok(0x1234));
    sensor.free().done();
}

#[test]
fn a_sensor_starts_when_it_is_settled_and_sees_its_magnet() {
    // Diagnostics: bit 8 settled, 9 overflow, 10 and 11 field, low byte the gain.
    for (diagnostics, verdict) in [
        ([0x81, 0x80], Err(SensorError::Damaged)),
        ([0x01, 0x80], Ok(())),
        ([0x00, 0x80 | 0x01], Err(SensorError::Absent)),
        ([0x83, 0x80], Err(SensorError::Magnet)),
        ([0x05, 0x83], Err(SensorError::Damaged)),
        ([0x85, 0x80], Err(SensorError::Magnet)),
        ([0x89, 0x80], Err(SensorError::Magnet)),
        ([0x00, 0x00], Err(SensorError::Absent)),
    ] {
        for (chip, ask) in [(AmsChip::As5047p, ASK_DIAGNOSTICS_47), (AmsChip::As5048a, ASK_DIAGNOSTICS_48)] {
            // The second frame's error flag is what the first one clears.
            let frames = [(ASK_ERRORS, [0x12, 0x34]), (ask, [0xc0, 0x00]), (ASK_ANGLE, diagnostics)];
            let mut sensor = sensor(chip, &frames);
            assert_eq!(sensor.start(), verdict, "{diagnostics:x?}");
            sensor.free().done();
        }
    }
}

#[test]
fn after_a_start_the_first_reading_is_an_angle() {
    let mut sensor = sensor(
        AmsChip::As5047p,
        &[(ASK_ERRORS, [0, 0]), (ASK_DIAGNOSTICS_47, [0, 0]), (ASK_ANGLE, [0x01, 0x80]), (ASK_ANGLE, [0x00, 0x03])],
    );
    assert_eq!(sensor.start(), Ok(()));
    assert_eq!(sensor.read(), Ok(Some(3)));
    sensor.free().done();
}

#[test]
fn a_zero_is_believed_of_a_sensor_that_has_diagnostics() {
    for (chip, ask) in [(AmsChip::As5047p, ASK_DIAGNOSTICS_47), (AmsChip::As5048a, ASK_DIAGNOSTICS_48)] {
        for (health, verdict) in [([0x81, 0x00], Ok(0)), ([0x00, 0x00], Err(SensorError::Absent))] {
            // The third answers the angle asked for with the second.
            let rest = [(ASK_ANGLE, [0x00, 0x00]), (ask, [0x00, 0x03]), (ASK_ANGLE, health)];
            let mut fresh = sensor(chip, &[&[(ASK_ANGLE, [0x01, 0x23])], &rest[..]].concat());
            assert_eq!(fresh.read_fresh(), verdict);
            fresh.free().done();
            let mut delayed = sensor(chip, &[&[(ASK_ANGLE, [0x01, 0x23])], &rest[..]].concat());
            assert_eq!(delayed.read(), Ok(None));
            assert_eq!(delayed.read(), verdict.map(Some));
            delayed.free().done();
        }
    }
}

#[test]
fn what_cannot_be_believed_is_told_and_the_next_answer_with_it() {
    for (answer, error) in [
        ([0x92, 0x35], SensorError::Damaged),
        // The error flag, with parity.
        ([0xd2, 0x35], SensorError::Refused),
        ([0xff, 0xff], SensorError::Absent),
    ] {
        let mut sensor = sensor(
            AmsChip::As5047p,
            &[(ASK_ANGLE, [0, 0]), (ASK_ANGLE, answer), (ASK_ANGLE, [0, 3]), (ASK_ANGLE, [0, 5])],
        );
        assert_eq!(sensor.read(), Ok(None));
        assert_eq!(sensor.read(), Err(error));
        assert_eq!(sensor.read(), Ok(None));
        assert_eq!(sensor.read(), Ok(Some(5)));
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
    assert_eq!((sensor.start(), sensor.read(), sensor.read_fresh()), (Err(fault), Err(fault), Err(fault)));
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
