//! Bodies that are uploaded while others are felt.

use crate::line::{Bad, device, for_seconds, running};
use palpate::body::FileError;
use palpate_link::{Device, Error, Fault, Refused, UploadError};
use palpate_sim::simulated::Kind;

/// A capped box of 4,532 bytes and a sphere of 24,356, as `palpate bake` makes them.
pub const BOX: &[u8] = include_bytes!("../../../../boards/bodies/capped_box.palp");
pub const SPHERE: &[u8] = include_bytes!("../../../../boards/bodies/sphere_body.palp");

#[test]
fn a_body_comes_while_another_is_felt_and_takes_its_place() {
    let (mut device, hand) = running();
    hand.goes_to([0.03, 0.02, 0.025]);
    let before = for_seconds(&mut device, 0.5);
    let mut told = Vec::new();
    device.upload(1, SPHERE, |came, all| told.push((came, all))).unwrap();
    assert!(told.windows(2).all(|pair| pair[0].0 <= pair[1].0) && told.last() == Some(&(SPHERE.len(), SPHERE.len())));
    let after = for_seconds(&mut device, 0.1);
    // The first body was felt throughout.
    assert_eq!((after.body, after.fault), (0, 0));
    assert!((after.force[2] - before.force[2]).abs() < 0.05, "{before:?} {after:?}");
    // With the first out of the way, the sphere is: its middle is 60 mm to the side.
    device.place(0, crate::orders::at([0.0, 0.0, -0.2])).unwrap();
    hand.goes_to([0.0, 0.06, 0.08]);
    let view = for_seconds(&mut device, 0.7);
    let [x, y, z] = view.position;
    let from_middle = (x * x + (y - 0.06) * (y - 0.06) + z * z).sqrt();
    assert_eq!(view.body, 1);
    // A sphere: from wherever its surface is nearest towards its middle.
    hand.goes_to([0.02, 0.06, 0.07]);
    let other = for_seconds(&mut device, 0.7);
    let [x, y, z] = other.position;
    let other_from_middle = (x * x + (y - 0.06) * (y - 0.06) + z * z).sqrt();
    let radii = [from_middle - view.gap, other_from_middle - other.gap];
    println!("radius {:?} m", radii);
    // Positions of a tip that moves are those of a tick before or after: some hundredths of a millimetre.
    assert!((radii[0] - radii[1]).abs() < 1e-4, "{radii:?}");
}

#[test]
fn three_in_a_row_take_turns_in_two_banks() {
    let mut device = device(Kind::default());
    for file in [BOX, SPHERE, BOX, SPHERE] {
        device.upload(1, file, |_, _| ()).unwrap();
    }
}

#[test]
fn an_upload_whose_parts_and_answers_are_lost_goes_on_where_it_was() {
    let mut device = device(Kind::default());
    let mut parts = 0;
    device.upload(1, BOX, |_, _| parts += 1).unwrap();
    assert_eq!(parts, BOX.len().div_ceil(64));
    for seed in 0..4 {
        let mut device = Device::over(Bad::new(Kind::default(), seed)).unwrap();
        // One byte in 500 is lost, one in 500 flipped: a part of 90 bytes or its answer is gone in two of five cases.
        device.line().spoils = 2_000;
        let mut last = (0, 0);
        device.upload(1, BOX, |came, all| last = (came, all)).unwrap();
        assert_eq!(last, (BOX.len(), BOX.len()));
        let said = device.line().numbers.len();
        println!("{said} parts said for {parts}");
        assert!(said > parts + 10, "{said}");
        assert_eq!(device.fault().unwrap(), None);
    }
}

#[test]
fn an_upload_goes_on_where_the_device_says_that_it_is() {
    let mut device = device(Kind::default());
    // The word that an upload begins comes once more in the middle of it: the device is at its start again.
    device.line().stray_after = Some(50);
    let mut least = usize::MAX;
    let mut parts = 0;
    device
        .upload(1, BOX, |came, _| {
            parts += 1;
            least = if parts > 40 { least.min(came) } else { usize::MAX };
        })
        .unwrap();
    assert_eq!(device.line().stray_after, None);
    assert_eq!(least, 0);
}

#[test]
fn the_answer_that_it_was_taken_may_be_lost_too() {
    let mut device = device(Kind::default());
    // Begin, the parts, End.
    device.line().lose_after = Some(BOX.len().div_ceil(64) as u32 + 2);
    device.upload(1, BOX, |_, _| ()).unwrap();
    assert_eq!(device.line().lose_after, None);
    let numbers = &device.line().numbers;
    assert_eq!(numbers[numbers.len() - 1], numbers[numbers.len() - 2], "the taking was asked for twice");
}

#[test]
fn a_spoiled_file_is_not_sent() {
    let mut device = device(Kind::default());
    let mut file = BOX.to_vec();
    file[1_000] ^= 4;
    let error = device.upload(1, &file, |_, _| ()).unwrap_err();
    assert!(matches!(error, Error::Body(FileError::Damaged { .. })), "{error}");
    let error = device.upload(1, &BOX[..BOX.len() - 2], |_, _| ()).unwrap_err();
    assert!(matches!(error, Error::Body(FileError::Length { .. })), "{error}");
    let error = device.upload(1, b"solid", |_, _| ()).unwrap_err();
    assert!(matches!(error, Error::Body(_)), "{error}");
    assert_eq!(device.line().numbers, []);
}

#[test]
fn a_device_without_memory_and_a_body_that_stays_refuse_it() {
    let mut bare = device(Kind { takes_bodies: false, ..Kind::default() });
    let error = bare.upload(1, BOX, |_, _| ()).unwrap_err();
    assert_eq!(error.to_string(), "upload was refused by the device: this device has no memory for bodies");
    assert!(matches!(error, Error::Refused { reason: Refused::Upload(UploadError::NoRoom), .. }));
    let error = device(Kind::default()).upload(0, BOX, |_, _| ()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "body 0 cannot be replaced: no memory for another is built in with it; upload to another body"
    );
}

#[test]
fn an_upload_keeps_the_link() {
    let mut device = device(Kind { link_timeout: 0.05, ..Kind::default() });
    device.upload(1, SPHERE, |_, _| ()).unwrap();
    assert_eq!(device.fault().unwrap(), None);
    assert_ne!(for_seconds(&mut device, 0.1).fault, Fault::LinkLost.code());
}
