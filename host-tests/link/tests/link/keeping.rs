//! Bodies that are kept in the device's flash.

use crate::line::{Bad, device, for_seconds, over, running};
use crate::uploads::{BOX, SPHERE};
use palpate_link::{Device, Error, Phase, Refused, UploadError, View};
use palpate_sim::simulated::{Hand, Kind};

fn crc(file: &[u8]) -> u32 {
    u32::from_le_bytes(*file.last_chunk().unwrap())
}

/// Where the surface of the second body is under the tip, metres, by its gap: the box's dome is 10 mm above its middle,
/// the sphere's 30 mm.
fn touches(device: &mut Device<Bad>, hand: &Hand) -> View {
    hand.enables(false);
    for_seconds(device, 0.1);
    device.place(0, crate::orders::at([0.0, 0.0, -0.2])).unwrap();
    hand.goes_to([0.0, 0.06, 0.08]);
    for_seconds(device, 0.3);
    hand.enables(true);
    for_seconds(device, 0.7)
}

fn is_sphere(view: &View) -> bool {
    let [x, y, z] = view.position;
    let from_middle = (x * x + (y - 0.06) * (y - 0.06) + z * z).sqrt();
    assert_eq!((view.body, view.fault), (1, 0));
    // The sphere's radius is 50 mm, less than half of which the box has there; a tip that moves is seen a tick late.
    (from_middle - view.gap - 0.05).abs() < 2e-4
}

fn greet_after_reset(device: &mut Device<Bad>) -> Hand {
    device.line().restart(true);
    device.line().device.run(8);
    let _ = device.tend();
    device.greet().unwrap();
    device.line().device.hand()
}

#[test]
fn a_kept_body_is_felt_at_once_and_after_a_reset_and_until_it_is_forgotten() {
    let mut device = device(Kind::default());
    let hand = device.line().device.hand();
    assert_eq!((device.hello().flash, device.hello().kept), (65_536, 0));
    assert!(!is_sphere(&touches(&mut device, &hand)));
    hand.enables(false);
    for_seconds(&mut device, 0.1);
    let mut told = (0, 0);
    device.keep(1, SPHERE, |came, all| told = (came, all)).unwrap();
    assert_eq!(told, (SPHERE.len(), SPHERE.len()));
    assert_eq!(device.hello().kept, crc(SPHERE));
    assert!(is_sphere(&touches(&mut device, &hand)));

    let hand = greet_after_reset(&mut device);
    assert_eq!(device.hello().kept, crc(SPHERE));
    assert!(is_sphere(&touches(&mut device, &hand)));
    // Another in RAM in its place, and what was built in, and the kept one no more.
    device.upload(1, BOX, |_, _| ()).unwrap();
    assert!(!is_sphere(&touches(&mut device, &hand)));
    device.put_back(1).unwrap();
    assert!(!is_sphere(&touches(&mut device, &hand)));

    let hand = greet_after_reset(&mut device);
    assert!(is_sphere(&touches(&mut device, &hand)));
    hand.enables(false);
    for_seconds(&mut device, 0.1);
    device.forget_kept(1).unwrap();
    assert_eq!(device.hello().kept, 0);
    assert!(!is_sphere(&touches(&mut device, &hand)));
    let hand = greet_after_reset(&mut device);
    assert_eq!(device.hello().kept, 0);
    assert!(!is_sphere(&touches(&mut device, &hand)));
}

#[test]
fn flash_is_not_written_while_motors_are_driven_or_enable_is_held() {
    let (mut device, hand) = running();
    let before = device.hello();
    let error = device.keep(1, SPHERE, |_, _| ()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "upload was refused by the device: flash is written only while the motors are off; release the enable \
         input first"
    );
    assert!(matches!(error, Error::Refused { reason: Refused::Upload(UploadError::Driven), .. }));
    assert_eq!(device.phase().unwrap(), Phase::Running);
    hand.enables(false);
    for_seconds(&mut device, 0.1);
    device.keep(1, BOX, |_, _| ()).unwrap();
    assert_ne!(before.kept, device.hello().kept);
    // A second one, in the place of the first, which is felt.
    device.keep(1, SPHERE, |_, _| ()).unwrap();
    assert!(is_sphere(&touches(&mut device, &hand)));
}

#[test]
fn a_body_that_was_kept_over_a_bad_line_is_whole() {
    for seed in 0..4 {
        let mut device = over(Bad::new(Kind::default(), seed));
        device.line().spoils = 2_000;
        device.keep(1, BOX, |_, _| ()).unwrap();
        let said = device.line().numbers.len();
        println!("{said} parts said for {}", BOX.len().div_ceil(64) + 2);
        assert!(said > BOX.len().div_ceil(64) + 10, "{said}");
        device.line().spoils = 0;
        greet_after_reset(&mut device);
        assert_eq!(device.hello().kept, crc(BOX));
    }
}

#[test]
fn the_answers_that_it_began_and_that_it_is_whole_may_be_lost() {
    // Begin, the parts, End, and the taking.
    for lost in [0, 1, BOX.len().div_ceil(64) as u32 + 1, BOX.len().div_ceil(64) as u32 + 2] {
        let mut device = device(Kind::default());
        device.line().lose_after = Some(lost);
        device.keep(1, BOX, |_, _| ()).unwrap();
        assert_eq!(device.line().lose_after, None);
        greet_after_reset(&mut device);
        assert_eq!(device.hello().kept, crc(BOX));
    }
}

#[test]
fn a_device_that_loses_its_power_on_the_way_feels_what_it_was_built_with() {
    // The first part starts once the hand has confirmed it.
    for parts in [0, 1, 50, SPHERE.len().div_ceil(64)] {
        let mut device = device(Kind::default());
        device.keep(1, BOX, |_, _| ()).unwrap();
        // All that comes from there on is lost. Before it has begun the old one is still there.
        device.line().dies_after = Some(parts as u32);
        assert!(device.keep(1, SPHERE, |_, _| ()).is_err());
        device.line().dies_after = None;
        let hand = greet_after_reset(&mut device);
        assert_eq!(device.hello().kept, if parts == 0 { crc(BOX) } else { 0 }, "{parts}");
        assert!(!is_sphere(&touches(&mut device, &hand)));
        // And takes another.
        hand.enables(false);
        for_seconds(&mut device, 0.1);
        device.keep(1, SPHERE, |_, _| ()).unwrap();
        assert!(is_sphere(&touches(&mut device, &hand)));
    }
}

#[test]
fn a_host_that_dies_in_the_middle_keeps_nobody_from_force_for_long() {
    let mut device = device(Kind { link_timeout: f32::INFINITY, ..Kind::default() });
    let hand = device.line().device.hand();
    device.line().dies_after = Some(20);
    assert!(device.keep(1, SPHERE, |_, _| ()).is_err());
    hand.enables(true);
    let view = for_seconds(&mut device, 0.5);
    assert_eq!((view.hold & palpate::wire::hold::WRITING, view.force), (palpate::wire::hold::WRITING, [0.0; 3]));
    assert_eq!(device.line().device.duties(), [0; 3]);
    // 5 s after the last part that it took, of which the call above waited for some.
    let view = for_seconds(&mut device, 5.0);
    assert_eq!(view.hold, palpate::wire::hold::RELEASE_FIRST, "nobody asked for force since");
    assert_eq!(device.line().device.duties(), [0; 3]);
    device.line().dies_after = None;
    hand.enables(false);
    for_seconds(&mut device, 0.1);
    hand.enables(true);
    assert_eq!(for_seconds(&mut device, 0.5).phase, Phase::Running as u8);
}

#[test]
fn a_device_without_flash_and_a_body_that_stays_refuse_it() {
    let mut bare = device(Kind { keeps_bodies: false, ..Kind::default() });
    let error = bare.keep(1, BOX, |_, _| ()).unwrap_err();
    assert_eq!(error.to_string(), "upload was refused by the device: this device has no flash for bodies");
    let error = device(Kind::default()).keep(0, BOX, |_, _| ()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "body 0 cannot be replaced: no memory for another is built in with it; upload to another body"
    );
}
