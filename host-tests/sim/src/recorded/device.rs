//! A device and what protects it.

use crate::recorded::mechanism::Mechanism;
use crate::recorded::walk::{Filled, Taken, Walk};
use alloc::vec::Vec;
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::{Device, Encoder, Endurance, Motor, Protection, SignWatch, SupplyRange};

/// The device of a recorded run.
#[derive(Clone, Copy, Debug)]
pub struct Recorded {
    /// What the loop knows of it.
    pub device: Device<Mechanism, 3>,
    /// What protects it, where its run was protected.
    pub protection: Option<Protection<3>>,
}

impl Recorded {
    /// A device, whichever its mechanism.
    pub fn new<K: Copy + Into<Mechanism>>(of: &Device<K, 3>, protection: Option<Protection<3>>) -> Self {
        let Device { kinematics, encoders, motors, feeds, dry_friction, joint_range, .. } = *of;
        let Device { min_margin, max_joint_rate, max_force, max_stiffness, max_damping, .. } = *of;
        let device = Device {
            kinematics: kinematics.into(),
            encoders,
            motors,
            feeds,
            dry_friction,
            joint_range,
            min_margin,
            max_joint_rate,
            max_force,
            max_stiffness,
            max_damping,
        };
        Self { device, protection }
    }

    /// Its numbers.
    pub fn numbers(&self) -> Vec<f32> {
        let (mut taken, mut copy) = (Taken::default(), *self);
        copy.walk(&mut taken);
        taken.0
    }

    /// From its numbers; `None` where these are too few, too many, or no device's.
    pub fn of(numbers: &[f32]) -> Option<Self> {
        let (mut filled, mut device) = (Filled::new(numbers), VACANT);
        device.walk(&mut filled);
        (filled.is_whole() && device.device.check().is_ok()).then_some(device)
    }

    fn walk(&mut self, walk: &mut impl Walk) {
        let Self { device, protection } = self;
        device.kinematics.walk(walk);
        for Encoder { radians_per_count, angle_at_zero } in &mut device.encoders {
            walk.number(radians_per_count);
            walk.number(angle_at_zero);
        }
        for Motor { torque_at_full } in &mut device.motors {
            walk.number(torque_at_full);
        }
        for feed in &mut device.feeds {
            of_feed(walk, feed);
        }
        walk.numbers(&mut device.dry_friction);
        for range in &mut device.joint_range {
            walk.numbers(range);
        }
        let Device { min_margin, max_joint_rate, max_force, max_stiffness, max_damping, .. } = device;
        for number in [min_margin, max_joint_rate, max_force, max_stiffness, max_damping] {
            walk.number(number);
        }
        walk.maybe(protection, UNPROTECTED, of_protection);
    }
}

const VACANT: Recorded = Recorded {
    device: Device {
        kinematics: Mechanism::VACANT,
        encoders: [Encoder { radians_per_count: 0.0, angle_at_zero: 0.0 }; 3],
        motors: [Motor { torque_at_full: 0.0 }; 3],
        feeds: [Feed::Current; 3],
        dry_friction: [0.0; 3],
        joint_range: [[0.0; 2]; 3],
        min_margin: 0.0,
        max_joint_rate: 0.0,
        max_force: 0.0,
        max_stiffness: 0.0,
        max_damping: 0.0,
    },
    protection: None,
};

const UNPROTECTED: Protection<3> = Protection {
    motors: [Endurance { continuous: 0.0, time_constant: 0.0 }; 3],
    max_joint_rates: [0.0; 3],
    max_probe_speed: 0.0,
    supply: None,
    signs: None,
};

const UNFED: VoltageFeed = VoltageFeed {
    supply: 0.0,
    resistance: 0.0,
    torque_constant: 0.0,
    current_at_full: 0.0,
    ratio: 0.0,
    back_emf_share: 0.0,
};

fn of_feed(walk: &mut impl Walk, feed: &mut Feed) {
    let mut voltage = match feed {
        Feed::Current => None,
        Feed::Voltage(voltage) => Some(*voltage),
    };
    walk.maybe(&mut voltage, UNFED, |walk, voltage| {
        let VoltageFeed { supply, resistance, torque_constant, current_at_full, ratio, back_emf_share } = voltage;
        for number in [supply, resistance, torque_constant, current_at_full, ratio, back_emf_share] {
            walk.number(number);
        }
    });
    *feed = voltage.map_or(Feed::Current, Feed::Voltage);
}

fn of_protection(walk: &mut impl Walk, protection: &mut Protection<3>) {
    let Protection { motors, max_joint_rates, max_probe_speed, supply, signs } = protection;
    for Endurance { continuous, time_constant } in motors {
        walk.number(continuous);
        walk.number(time_constant);
    }
    walk.numbers(max_joint_rates);
    walk.number(max_probe_speed);
    walk.maybe(supply, SupplyRange { least: 0, most: 0 }, |walk, SupplyRange { least, most }| {
        *least = walk.count(*least);
        *most = walk.count(*most);
    });
    walk.maybe(signs, SignWatch { inertia: [0.0; 3] }, |walk, SignWatch { inertia }| walk.numbers(inertia));
}
