//! What is no such device: silent, garbled, of another version, being set up, gone.

use crate::line::device;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::{DeviceMessage, HostMessage};
use palpate_link::{Device, Error, Hello, Line, PROTOCOL};
use palpate_sim::simulated::Kind;
use std::cell::Cell;
use std::io::{self, ErrorKind};
use std::time::{Duration, Instant};

/// Something that says the same again and again, whatever it is told.
struct Stranger {
    says: Vec<u8>,
    began: Instant,
    passed: Cell<Duration>,
    is_gone: bool,
}

impl Stranger {
    fn saying(says: Vec<u8>) -> Self {
        Self { says, began: Instant::now(), passed: Cell::new(Duration::ZERO), is_gone: false }
    }

    fn telling(told: &DeviceMessage) -> Self {
        Self::saying(frame::pack(told, &mut [0; MAX_FRAME]).unwrap().to_vec())
    }
}

impl Line for Stranger {
    fn name(&self) -> String {
        "/dev/ttyACM7".to_owned()
    }

    fn send(&mut self, _: &[u8]) -> io::Result<()> {
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if self.is_gone {
            return Err(ErrorKind::BrokenPipe.into());
        }
        self.passed.set(self.passed.get() + wait.max(Duration::from_micros(100)));
        buffer[..self.says.len()].copy_from_slice(&self.says);
        Ok(if wait.is_zero() { 0 } else { self.says.len() })
    }

    fn now(&self) -> Instant {
        self.began + self.passed.get()
    }
}

fn error(stranger: Stranger) -> Error {
    match Device::over(stranger) {
        Ok(device) => panic!("it was taken for a device: {:?}", device.hello()),
        Err(error) => error,
    }
}

#[test]
fn one_that_is_silent_is_said_to_be() {
    let error = error(Stranger::saying(Vec::new()));
    assert!(matches!(error, Error::Silent { .. }), "{error:?}");
    assert_eq!(error.to_string(), "/dev/ttyACM7: the device has been silent for 1.50 s: is it on, and on this line?");
}

#[test]
fn one_that_cannot_be_understood_is_said_to_be() {
    let error = error(Stranger::saying(b"ready>\0\r\n".to_vec()));
    assert!(matches!(error, Error::Garbled { bytes, .. } if bytes > 100), "{error:?}");
}

#[test]
fn one_of_another_version_is_refused_with_both_numbers() {
    let hello = Hello { protocol: PROTOCOL + 1, ..Hello::default() };
    let error = error(Stranger::telling(&DeviceMessage::Hello(hello)));
    let wanted = format!(
        "/dev/ttyACM7: the device speaks version {} of the protocol, this program version {PROTOCOL}",
        PROTOCOL + 1
    );
    assert_eq!(error.to_string(), wanted);
}

#[test]
fn one_that_falls_silent_or_goes_is_said_to() {
    let hello = Hello { protocol: PROTOCOL, ..Hello::default() };
    let mut device = Device::over(Stranger::telling(&DeviceMessage::Hello(hello))).unwrap();
    device.line().says.clear();
    assert!(matches!(device.position(), Err(Error::Silent { .. })));
    assert!(matches!(device.limit(1.0), Err(Error::Lost { .. })));
    device.line().is_gone = true;
    let error = device.tend().unwrap_err();
    assert!(matches!(&error, Error::Line { .. }), "{error}");
    assert_eq!(error.to_string(), "/dev/ttyACM7: the line broke");
}

#[test]
fn a_body_too_large_for_the_device_is_not_begun() {
    let hello = Hello { protocol: PROTOCOL, room: 1_024, faces: 6, edges: 12, ..Hello::default() };
    let mut device = Device::over(Stranger::telling(&DeviceMessage::Hello(hello))).unwrap();
    device.line().says.clear();
    let error = device.upload(1, crate::uploads::BOX, |_, _| ()).unwrap_err();
    assert!(matches!(error, Error::TooLarge { room: 1_024, most_faces: 6, .. }), "{error}");
}

#[test]
fn one_that_is_being_set_up_feels_nothing_and_says_so() {
    let mut device = device(Kind::default());
    let mut buffer = [0; MAX_FRAME];
    // Its first ticks settle.
    crate::line::for_seconds(&mut device, 0.1);
    let set_up = frame::pack(&HostMessage::SetUp, &mut buffer).unwrap();
    device.line().send(set_up).unwrap();
    // The hand confirms it.
    device.line().device.run(3_500);
    for _ in 0..10 {
        let _ = device.tend();
    }
    assert!(matches!(device.tend(), Err(Error::SetUp { .. })));
    assert!(matches!(device.limit(1.0), Err(Error::SetUp { .. })));
    assert!(matches!(device.view(Duration::from_millis(50)), Err(Error::SetUp { .. })));
    // Whoever is there may stop the jog.
    device.stop().unwrap();
}

#[test]
fn a_port_that_is_not_there_is_named() {
    let error = Device::open("/dev/no-such-port", 500_000).unwrap_err();
    assert_eq!(error.to_string(), "cannot open the serial port /dev/no-such-port");
}
