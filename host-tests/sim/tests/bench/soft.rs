//! A board whose surface deforms: what it tells a host of its modes.

use palpate::body::{Body, Soft};
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::math::vec3;
use palpate::scene::Commanded;
use palpate::servo::{Config, Heartbeat, ResetReason, Servo, Settings, SoftBody, Tracked as _};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{DeviceMessage, HostMessage, MODES_HZ, Modes, PROTOCOL};
use palpate_bench::Idle;
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use palpate_sim::rig::{RATE, Rig, SETTINGS, WALL, settings};
use palpate_sim::simulated::{NoWatchdog, Wire};

mod capped_box {
    include!("../../../../boards/bodies/capped_box.rs");
}
mod deformed {
    include!("../../../../boards/bodies/capped_box_modes.rs");
}

/// The box of a foam, by eight modes.
static FOAM: SoftBody = {
    let body: Body = capped_box::BODY;
    let Ok(soft) = Soft::new(body, &deformed::MODES) else { panic!() };
    let Ok(body) = SoftBody::new(soft, &deformed::MOTION, SETTINGS.rate_hz) else { panic!() };
    body
};

/// From 20 mm above the origin to 5 mm below it and back, once a second.
struct Press;

impl HandPath for Press {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, 0.0075 + 0.0125 * (core::f64::consts::TAU * time).cos()]
    }

    fn velocity(&self, time: f64) -> Vector {
        let rate = core::f64::consts::TAU;
        [0.0, 0.0, -0.0125 * rate * (rate * time).sin()]
    }
}

/// What a device tells of its modes in a second, with those that its state has at each tick.
fn told<S: Commanded + 'static>(surface: &'static S, greets: bool) -> (Vec<Modes>, Vec<Option<[f32; 8]>>) {
    // Off the middle of the dome, whose top is at 33.5 mm.
    let at = Settings { body_origin_m: vec3(-0.042, -0.028, -0.033), ..SETTINGS };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, surface, Config { settings: at, ..Config::DEFAULT });
    let hand = HandSettings { stiffness: 2_000.0, damping: 20.0, mass: 0.0 };
    let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), hand, Box::new(Press), RATE).unwrap();
    let mut rig = Rig::new(servo, plant, &settings(), ResetReason::PowerOn);
    let mut idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default());
    let (mut wire, mut receiver) = (Wire::default(), Receiver::<DeviceMessage>::new());
    let mut buffer = [0; MAX_FRAME];
    if greets {
        wire.to_device.extend(pack(&HostMessage::Hello { protocol: PROTOCOL }, &mut buffer).unwrap());
    }
    let (mut told, mut had) = (Vec::new(), Vec::new());
    for _ in 0..RATE as u32 {
        rig.tick();
        had.push(rig.bench.state().witness().modes());
        // As fast as any line: a letter that nobody fetches is lost to the next.
        for _ in 0..2 * MAX_FRAME {
            idle.step(&mut wire, &mut NoWatchdog);
        }
        for byte in wire.from_device.drain(..) {
            if let Some(Received::Message(DeviceMessage::Modes(modes))) = receiver.feed(byte) {
                told.push(modes);
            }
        }
    }
    (told, had)
}

#[test]
fn a_device_tells_the_modes_of_a_soft_surface_at_their_rate_and_a_rigid_one_says_nothing() {
    let (modes, had) = told(&FOAM, true);
    assert_eq!(modes.len(), MODES_HZ as usize);
    assert!(modes.windows(2).all(|pair| pair[1].tick - pair[0].tick == RATE as u32 / MODES_HZ));
    for Modes { tick, body, q } in &modes {
        assert_eq!((*body, Some(*q)), (0, had[*tick as usize]));
    }
    let most = modes.iter().flat_map(|modes| modes.q).fold(0.0_f32, |most, q| most.max(q.abs()));
    assert!(most > 1e-5, "the hand does not press: {most} m");
    assert_eq!(told(&FOAM, false).0, [], "before a host has greeted");
    assert_eq!(told(&WALL, true).0, []);
}
