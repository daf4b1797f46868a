//! A device and what protects it.

use crate::recorded::mechanism::Mechanism;
use crate::recorded::walk::{Filled, Taken, Walk};
use alloc::vec::Vec;
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::{Device, Encoder, Endurance, Motor, PolarityCheck, Protection, SupplyRange};

/// The device of a recorded run.
#[derive(Clone, Copy, Debug)]
pub struct Recorded {
    /// The loop's description of it.
    pub device: Device<Mechanism, 3>,
    /// Its protection; `None` for a run without.
    pub protection: Option<Protection<3>>,
}

/// A device with its mechanism as another type.
pub const fn with_mechanism<K: Copy, L: Copy>(of: &Device<K, 3>, kinematics: L) -> Device<L, 3> {
    Device {
        kinematics,
        encoders: of.encoders,
        motors: of.motors,
        feeds: of.feeds,
        dry_friction_n_m: of.dry_friction_n_m,
        joint_range_rad: of.joint_range_rad,
        min_margin_m_per_rad: of.min_margin_m_per_rad,
        max_joint_rate_rad_per_s: of.max_joint_rate_rad_per_s,
        max_force_n: of.max_force_n,
        max_stiffness_n_per_m: of.max_stiffness_n_per_m,
        max_damping_n_s_per_m: of.max_damping_n_s_per_m,
    }
}

impl Recorded {
    /// A device, whichever its mechanism.
    pub fn new<K: Copy + Into<Mechanism>>(of: &Device<K, 3>, protection: Option<Protection<3>>) -> Self {
        Self { device: with_mechanism(of, of.kinematics.into()), protection }
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
        for Encoder { radians_per_count, angle_at_zero_rad: angle_at_zero } in &mut device.encoders {
            walk.number(radians_per_count);
            walk.number(angle_at_zero);
        }
        for Motor { torque_at_full_n_m: torque_at_full } in &mut device.motors {
            walk.number(torque_at_full);
        }
        for feed in &mut device.feeds {
            of_feed(walk, feed);
        }
        walk.numbers(&mut device.dry_friction_n_m);
        for range in &mut device.joint_range_rad {
            walk.numbers(range);
        }
        let Device {
            min_margin_m_per_rad: min_margin,
            max_joint_rate_rad_per_s: max_joint_rate,
            max_force_n: max_force,
            max_stiffness_n_per_m: max_stiffness,
            max_damping_n_s_per_m: max_damping,
            ..
        } = device;
        for number in [min_margin, max_joint_rate, max_force, max_stiffness, max_damping] {
            walk.number(number);
        }
        walk.maybe(protection, UNPROTECTED, of_protection);
    }
}

const VACANT: Recorded = Recorded {
    device: Device {
        kinematics: Mechanism::VACANT,
        encoders: [Encoder { radians_per_count: 0.0, angle_at_zero_rad: 0.0 }; 3],
        motors: [Motor { torque_at_full_n_m: 0.0 }; 3],
        feeds: [Feed::Current; 3],
        dry_friction_n_m: [0.0; 3],
        joint_range_rad: [[0.0; 2]; 3],
        min_margin_m_per_rad: 0.0,
        max_joint_rate_rad_per_s: 0.0,
        max_force_n: 0.0,
        max_stiffness_n_per_m: 0.0,
        max_damping_n_s_per_m: 0.0,
    },
    protection: None,
};

const UNPROTECTED: Protection<3> = Protection {
    motors: [Endurance { continuous: 0.0, time_constant_s: 0.0 }; 3],
    max_joint_rates_rad_per_s: [0.0; 3],
    max_probe_speed_m_per_s: 0.0,
    supply: None,
    polarity: None,
};

const UNFED: VoltageFeed = VoltageFeed {
    supply_v: 0.0,
    full_fraction: 0.0,
    resistance_ohm: 0.0,
    torque_constant_n_m_per_a: 0.0,
    current_at_full_a: 0.0,
    ratio: 0.0,
    back_emf_fraction: 0.0,
};

fn of_feed(walk: &mut impl Walk, feed: &mut Feed) {
    let mut voltage = match feed {
        Feed::Current => None,
        Feed::Voltage(voltage) => Some(*voltage),
    };
    walk.maybe(&mut voltage, UNFED, |walk, voltage| {
        let VoltageFeed {
            supply_v: supply,
            full_fraction,
            resistance_ohm: resistance,
            torque_constant_n_m_per_a: torque_constant,
            current_at_full_a: current_at_full,
            ratio,
            back_emf_fraction: back_emf_share,
        } = voltage;
        for number in [supply, full_fraction, resistance, torque_constant, current_at_full, ratio, back_emf_share] {
            walk.number(number);
        }
    });
    *feed = voltage.map_or(Feed::Current, Feed::Voltage);
}

fn of_protection(walk: &mut impl Walk, protection: &mut Protection<3>) {
    let Protection {
        motors,
        max_joint_rates_rad_per_s: max_joint_rates,
        max_probe_speed_m_per_s: max_probe_speed,
        supply,
        polarity: signs,
    } = protection;
    for Endurance { continuous, time_constant_s: time_constant } in motors {
        walk.number(continuous);
        walk.number(time_constant);
    }
    walk.numbers(max_joint_rates);
    walk.number(max_probe_speed);
    walk.maybe(supply, SupplyRange { min_mv: 0, max_mv: 0 }, |walk, SupplyRange { min_mv: least, max_mv: most }| {
        *least = walk.count(*least);
        *most = walk.count(*most);
    });
    walk.maybe(signs, PolarityCheck { inertia_kg_m2: [0.0; 3] }, |walk, PolarityCheck { inertia_kg_m2: inertia }| {
        walk.numbers(inertia)
    });
}
