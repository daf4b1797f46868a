use super::*;
use crate::device::Duty;
use crate::device::drive::Supply;
use crate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;

/// The preset's own numbers on inputs and outputs that are swapped.
fn kept() -> Calibration<3> {
    Calibration(core::array::from_fn(|joint| JointCalibration {
        input: [2, 0, 1][joint],
        output: [0, 2, 1][joint],
        radians_per_count: DEVICE.encoders[joint].radians_per_count,
        zero_of: [ZeroOf::Pose, ZeroOf::Mark, ZeroOf::Count][joint],
        angle_at_zero_rad: DEVICE.encoders[joint].angle_at_zero_rad,
        torque_at_full_n_m: DEVICE.motors[joint].torque_at_full_n_m,
        dry_friction_n_m: DEVICE.dry_friction_n_m[joint],
    }))
}

/// Makes of a joint what it cannot be.
type Spoil = fn(&mut JointCalibration);

#[test]
fn what_was_written_is_read_and_nothing_else_is() {
    let words = kept().to_words();
    assert_eq!((words.len(), Calibration::<3>::WORDS), (16, 16));
    assert_eq!(Calibration::from_words(&words), Ok(kept()));
    // Standard CRC-32, over the little-endian bytes: what a host computes with any library.
    assert_eq!(crc_of(&[u32::from_le_bytes(*b"1234"), u32::from_le_bytes(*b"5678")]), 0x9AE0_DAAF);
    assert_eq!(Calibration::<2>::from_words(&words), Err(CalibrationError::Joints { joints: 3 }));
    assert_eq!(Calibration::<3>::from_words(&[u32::MAX; 16]), Err(CalibrationError::Absent));
    for bit in 0..16 * 32 {
        let mut spoilt = words;
        spoilt[bit / 32] ^= 1 << (bit % 32);
        assert_eq!(Calibration::<3>::from_words(&spoilt), Err(CalibrationError::Damaged), "bit {bit}");
        // Flash that was erased, but for a bit.
        let mut worn = [u32::MAX; 16];
        worn[bit / 32] ^= 1 << (bit % 32);
        assert!(!matches!(Calibration::<3>::from_words(&worn), Ok(_) | Err(CalibrationError::Absent)), "bit {bit}");
    }
    let of = |zero_of| Calibration(kept().0.map(|joint| JointCalibration { zero_of, ..joint }));
    assert_eq!(of(ZeroOf::Mark).check_zeroes(Some(ZeroOf::Mark)), Ok(()));
    assert_eq!(of(ZeroOf::Mark).check_zeroes(Some(ZeroOf::Pose)), Err(CalibrationError::ZeroOf { joint: 0 }));
    assert_eq!(kept().check_zeroes(Some(ZeroOf::Pose)), Err(CalibrationError::ZeroOf { joint: 1 }));
    assert_eq!(kept().check_zeroes(None), Ok(()));
    let mut newer = words;
    newer[1] += 1;
    newer[15] = crc_of(&newer[..15]);
    assert_eq!(Calibration::<3>::from_words(&newer), Err(CalibrationError::Version { version: 3 }));
}

#[test]
fn a_record_that_is_not_written_to_its_end_is_no_record() {
    let words = kept().to_words();
    // Two words at a time, the first two last.
    for written in 1..=7 {
        let mut half = [u32::MAX; 16];
        half[2..2 + 2 * written].copy_from_slice(&words[2..2 + 2 * written]);
        assert_eq!(Calibration::<3>::from_words(&half), Err(CalibrationError::Interrupted), "{written}");
    }
}

#[test]
fn a_device_is_what_was_found_within_what_it_can_be() {
    let same = DEVICE.calibrated(&kept()).unwrap();
    assert_eq!((same.encoders, same.motors), (DEVICE.encoders, DEVICE.motors));
    let with = |change: fn(&mut JointCalibration)| {
        let mut found = kept();
        change(&mut found.0[1]);
        DEVICE.calibrated(&found).map(|device| (device.encoders[1], device.motors[1], device.dry_friction_n_m[1]))
    };
    let [encoder, motor] = [DEVICE.encoders[1].radians_per_count, DEVICE.motors[1].torque_at_full_n_m];
    // The wrong way round, four times as coarse, zero elsewhere: what commissioning is for.
    let found = with(|joint| {
        joint.radians_per_count *= -4.0;
        joint.torque_at_full_n_m *= -0.6;
        (joint.angle_at_zero_rad, joint.dry_friction_n_m) = (-0.4, 0.03);
    });
    let measured = Encoder { radians_per_count: -4.0 * encoder, angle_at_zero_rad: -0.4 };
    assert_eq!(found, Ok((measured, Motor { torque_at_full_n_m: -0.6 * motor }, 0.03)));
    let refused: [(Spoil, CalibrationError); 15] = [
        (|joint| joint.radians_per_count *= 5.1, CalibrationError::Encoder { joint: 1 }),
        (|joint| joint.radians_per_count *= -0.19, CalibrationError::Encoder { joint: 1 }),
        (|joint| joint.radians_per_count = 0.0, CalibrationError::Encoder { joint: 1 }),
        (|joint| joint.radians_per_count = f32::NAN, CalibrationError::NotFinite { joint: 1 }),
        // The range is -0.8 to 2.2.
        (|joint| joint.angle_at_zero_rad = -7.1, CalibrationError::Zero { joint: 1 }),
        (|joint| joint.angle_at_zero_rad = 8.5, CalibrationError::Zero { joint: 1 }),
        (|joint| joint.angle_at_zero_rad = f32::INFINITY, CalibrationError::NotFinite { joint: 1 }),
        (|joint| joint.torque_at_full_n_m *= 2.01, CalibrationError::Torque { joint: 1 }),
        (|joint| joint.torque_at_full_n_m *= -0.49, CalibrationError::Torque { joint: 1 }),
        (|joint| joint.torque_at_full_n_m = f32::NEG_INFINITY, CalibrationError::NotFinite { joint: 1 }),
        (|joint| joint.dry_friction_n_m = -0.01, CalibrationError::Friction { joint: 1 }),
        (|joint| joint.dry_friction_n_m = 1.0, CalibrationError::Friction { joint: 1 }),
        // An eighth of 5 N on 205 mm is 0.128 N·m.
        (|joint| joint.dry_friction_n_m = 0.13, CalibrationError::Friction { joint: 1 }),
        (|joint| joint.input = 1, CalibrationError::Channels),
        (|joint| joint.output = 3, CalibrationError::Channels),
    ];
    for (change, error) in refused {
        assert_eq!(with(change), Err(error));
    }
}

/// The back-EMF, V, that a feed compensates at a rate of 2 rad/s.
fn made_up_for(feed: Feed) -> f32 {
    let Feed::Voltage(VoltageFeed { supply_v: supply, .. }) = feed else { panic!("a bridge") };
    feed.command(Duty::ZERO, 2.0, Supply::UNMEASURED).fraction() * supply
}

#[test]
fn back_emf_is_made_up_for_the_way_a_motor_was_found_to_turn_and_never_by_more_than_was_built() {
    const FEED: VoltageFeed = VoltageFeed {
        supply_v: 12.0,
        full_fraction: 1.0,
        resistance_ohm: 5.0,
        torque_constant_n_m_per_a: 0.05,
        current_at_full_a: 2.0,
        ratio: -10.0,
        back_emf_fraction: 0.8,
    };
    let mut built = DEVICE;
    built.feeds = [Feed::Voltage(FEED); 3];
    let before = made_up_for(built.feeds[1]);
    for step in 0..=30 {
        // From 0.5 to 2.
        let size = 0.5 * 4.0_f32.powf(step as f32 / 30.0);
        for factor in [size, -size] {
            let mut found = kept();
            found.0[1].torque_at_full_n_m *= factor;
            let device = built.calibrated(&found).unwrap();
            let now = made_up_for(device.feeds[1]) / before;
            // A motor that turns the other way has its back-EMF the other way.
            assert_eq!(now.signum(), factor.signum(), "{factor}");
            // Whichever of the three changed the torque, the compensation is no more of the back-EMF than the preset's:
            // the torque constant (proportional to the back-EMF), the supply (proportional to the compensation), the
            // resistance (proportional to neither). A step of 2⁻¹⁵ of 12 V is 0.05 %.
            let [by_constant, by_supply, by_resistance] = [now.abs() / size, now.abs() * size, now.abs()];
            for share in [by_constant, by_supply, by_resistance] {
                assert!((0.2..=1.001).contains(&share), "{factor}: {share}");
            }
            assert_eq!((device.feeds[0], device.feeds[2]), (built.feeds[0], built.feeds[2]));
        }
    }
    assert_eq!(built.calibrated(&kept()).unwrap().feeds, built.feeds);
}

#[test]
fn no_word_makes_a_device_that_none_is() {
    // Random numbers with a valid CRC: a record that is accepted gives a valid device.
    let mut random = 1_u32;
    let mut next = || {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        random
    };
    let mut taken = 0;
    for _ in 0..100_000 {
        let mut words = kept().to_words();
        for _ in 0..1 + next() % 3 {
            words[3 + (next() % 12) as usize] ^= next() & (u32::MAX << (next() % 32));
        }
        words[15] = crc_of(&words[..15]);
        let found = Calibration::<3>::from_words(&words).unwrap();
        if let Ok(device) = DEVICE.calibrated(&found) {
            taken += 1;
            assert_eq!(device.check(), Ok(()));
        }
        // And words as they come.
        let words = core::array::from_fn(|_| next());
        assert_eq!(Calibration::<3>::from_words(&words), Err(CalibrationError::Damaged));
    }
    assert!(taken > 1_000, "{taken} of 100,000");
}

#[test]
fn a_calibration_that_makes_the_arm_stiffer_or_stronger_than_its_limits_is_refused() {
    // 600 of 1,000 N/m, 2 of 8 N·s/m, 3 of 5 N.
    let gains = Gains { stiffness_n_per_m: 600.0, damping_n_s_per_m: 2.0, force_n: 3.0 };
    let with = |encoder: f32, torque: f32, gains: Gains| {
        let mut found = kept();
        found.0[0].radians_per_count *= encoder;
        found.0[2].torque_at_full_n_m /= torque;
        found.check_gains(&DEVICE, &gains)
    };
    assert_eq!(with(1.0, 1.0, gains), Ok(()));
    assert_eq!(with(-0.25, -0.5, gains), Ok(()), "softer and weaker");
    // Five times and twice, each within what one joint may be off: 6,000 N/m, 20 N·s/m, 6 N.
    assert_eq!(with(5.0, 2.0, gains), Err(CalibrationError::Force { joint: 2 }));
    assert_eq!(with(-5.0, 1.0, gains), Err(CalibrationError::Stiffness));
    assert_eq!(with(5.0, 1.0, Gains { stiffness_n_per_m: 100.0, ..gains }), Err(CalibrationError::Damping));
    // 600 N/m by 1.1 · 1,000 / 600, and 3 N by 1.1 · 5 / 3: the same number.
    for (scale, stiffness, force) in
        [(1.82, Ok(()), Ok(())), (1.85, Err(CalibrationError::Stiffness), Err(CalibrationError::Force { joint: 2 }))]
    {
        assert_eq!(with(scale, 1.0, gains), stiffness);
        assert_eq!(with(1.0, scale, gains), force);
    }
    // A host may ask for the limits themselves.
    assert_eq!(with(1.2, 1.0, Gains::of(&DEVICE)), Err(CalibrationError::Stiffness));
    assert_eq!(with(1.05, 1.0, Gains::of(&DEVICE)), Ok(()));
}
