//! Orders that are done, and orders that are refused.

use crate::line::{device, for_seconds, running};
use palpate::scene::SceneError;
use palpate_link::{BodyPose, Command, Contact, Device, Error, Friction, Phase, Refused};
use palpate_sim::simulated::Kind;

/// Upright, here.
pub fn at(position: [f32; 3]) -> BodyPose {
    BodyPose { position, orientation: [0.0, 0.0, 0.0, 1.0] }
}

#[test]
fn the_device_says_what_it_is_and_what_it_does() {
    let (mut device, _) = running();
    let hello = device.hello();
    assert_eq!((hello.rate, hello.max_force, hello.room), (4_000.0, 5.0, 66_560));
    assert_eq!((device.phase().unwrap(), device.fault().unwrap(), device.hold().unwrap()), (Phase::Running, None, 0));
    let position = device.position().unwrap();
    // A light grip, which the arm's weight and the encoders' steps pull at.
    let wanted = [0.03, 0.02, 0.05];
    assert!(position.iter().zip(wanted).all(|(is, wanted)| (is - wanted).abs() < 1e-3), "{position:?}");
    assert_eq!(device.contact().unwrap(), Contact::InFront);
    assert!(device.gap().unwrap() > 0.015 && device.record().is_some());
    assert_eq!((device.body().unwrap(), device.force().unwrap()), (0, [0.0; 3]));
    assert_eq!(device.damaged(), 0);
}

#[test]
fn a_hand_that_presses_is_seen_to() {
    let (mut device, hand) = running();
    hand.goes_to([0.03, 0.02, 0.025]);
    let mut fastest = 0.0_f32;
    for _ in 0..400 {
        fastest = fastest.min(device.velocity().unwrap()[2]);
    }
    assert!(fastest < -0.01, "{fastest}");
    let view = for_seconds(&mut device, 0.5);
    assert_eq!(view.contact, Contact::Touching as u8);
    // 400 N/m of the box and 300 N/m of the hand share 8.5 mm, less what the dome is lower beside its middle.
    assert!(view.gap < -0.002 && view.force[2] > 0.8, "{view:?}");
}

#[test]
fn every_order_is_done() -> Result<(), Error> {
    let (mut device, hand) = running();
    let gap = device.gap()?;
    device.place(0, at([0.0, 0.0, -0.01]))?;
    let lower = for_seconds(&mut device, 0.1).gap;
    // The tip swings by less than half a millimetre.
    assert!((lower - gap - 0.01).abs() < 5e-4, "{lower} after {gap}");
    device.tip(0.004)?;
    assert!((for_seconds(&mut device, 0.1).gap - (lower - 0.004)).abs() < 5e-4);
    device.tip(0.0)?;
    device.move_along(0, [[0.0, 0.0, 0.02], [0.0; 3]], 0.5)?;
    assert!((for_seconds(&mut device, 0.7).gap - gap).abs() < 5e-4);
    for step in 1..=20 {
        let z = -5e-4 * step as f32;
        device.lead(0, at([0.0, 0.0, z]), [[0.0, 0.0, -0.02], [0.0; 3]], 0.05)?;
        for_seconds(&mut device, 0.025);
    }
    assert!((device.gap()? - gap - 0.01).abs() < 2e-3, "{} after {gap}", device.gap()?);
    device.place(0, at([0.0; 3]))?;

    for _ in 0..10 {
        device.push([0.0, 0.0, 1.0])?;
        for_seconds(&mut device, 0.03);
    }
    assert!((device.force()?[2] - 1.0).abs() < 1e-3, "{:?}", device.force()?);
    for _ in 0..10 {
        device.limit(0.5)?;
        device.push([0.0, 0.0, 1.0])?;
        for_seconds(&mut device, 0.03);
    }
    assert!((device.force()?[2] - 0.5).abs() < 1e-3, "{:?}", device.force()?);
    device.limit(5.0)?;
    // Nobody asks for it any more: 0.1 s, and at 100 N/s down.
    assert_eq!(for_seconds(&mut device, 0.2).force, [0.0; 3]);

    hand.goes_to([0.03, 0.02, 0.025]);
    let firm = for_seconds(&mut device, 0.5).force[2];
    device.harden(0, 100.0, 1.0)?;
    let soft = for_seconds(&mut device, 0.5).force[2];
    assert!(soft < 0.5 * firm && soft > 0.1, "{soft} after {firm}");
    device.rub(
        0,
        Some(Friction {
            stiffness_n_per_m: 500.0,
            damping_n_s_per_m: 1.0,
            static_coefficient: 0.8,
            dynamic_coefficient: 0.6,
        }),
    )?;
    hand.goes_to([0.05, 0.02, 0.025]);
    let rubbed = for_seconds(&mut device, 0.3).force[0];
    device.rub(0, None)?;
    let smooth = for_seconds(&mut device, 0.3).force[0];
    // Which way it is held hangs on where the tip came to rest.
    assert!((rubbed - smooth).abs() > 0.05, "{rubbed} and {smooth}");
    device.switch(0)?;
    assert_eq!(for_seconds(&mut device, 0.3).force, [0.0; 3]);
    device.choose(0)?;
    hand.goes_to([0.03, 0.02, 0.05]);
    for_seconds(&mut device, 0.5);
    hand.goes_to([0.03, 0.02, 0.025]);
    assert!(for_seconds(&mut device, 0.5).force[2] > 0.1);
    assert_eq!(device.fault()?, None);
    Ok(())
}

/// What an order is refused for.
fn refused<L: palpate_link::Line>(device: &mut Device<L>, order: Command) -> SceneError {
    match device.order(order) {
        Err(Error::Refused { reason: Refused::Command(reason), .. }) => reason,
        other => panic!("{order:?}: {other:?}"),
    }
}

#[test]
fn what_is_out_of_range_is_refused_with_the_devices_reason() {
    let mut device = device(Kind::default());
    let pose = at([0.0; 3]);
    let spun = BodyPose { orientation: [0.0, 0.0, 0.0, 2.0], ..pose };
    let (velocity, angular_velocity, seconds) = ([3.0, 0.0, 0.0], [0.0; 3], 1.0);
    for (order, reason) in [
        (Command::Place { body: 5, pose }, SceneError::Missing(5)),
        (Command::Place { body: 0, pose: spun }, SceneError::Placement(0)),
        (Command::Place { body: 0, pose: at([f32::NAN, 0.0, 0.0]) }, SceneError::Placement(0)),
        (Command::Move { body: 0, velocity, angular_velocity, seconds }, SceneError::TooFast(0)),
        (
            Command::Harden { body: 1, stiffness: 1e4, damping: 0.0 },
            SceneError::TooStiff { body: 1, max_n_per_m: 600.0 },
        ),
        (
            Command::Harden { body: 1, stiffness: 1.0, damping: -1.0 },
            SceneError::TooDamped { body: 1, max_n_s_per_m: 8.0 },
        ),
        (Command::Rub { body: 1, friction: Some([100.0, 0.0, 0.2, 0.3]) }, SceneError::Friction(1)),
        (Command::Tip { radius: -1.0 }, SceneError::TipRadius),
        (Command::Limit { force: 100.0 }, SceneError::Force),
        (Command::Push { force: [0.0, 0.0, 6.0] }, SceneError::Force),
        (Command::Take { body: 1 }, SceneError::NotUploaded(1)),
        (Command::Take { body: 0 }, SceneError::NotOffered),
    ] {
        assert_eq!(refused(&mut device, order), reason, "{order:?}");
    }
    let said = device.place(5, pose).unwrap_err().to_string();
    assert_eq!(said, "place was refused by the device: there is no body 5");
}
