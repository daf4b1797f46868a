//! The package's servo loop in Rust, with the arm that `examples/Servo/pc/main.c` simulates.

use crate::running::with_capped_box;
use palpate::device::Counts;
use palpate::device::presets::{WOODEN_HAPTICS_2016 as DEVICE, WOODEN_HAPTICS_2016_PROTECTION as PROTECTION};
use palpate::math::vec3;
use palpate::servo::recommended::{Recommended, WOODEN_HAPTICS_2016 as TOUCH};
use palpate::servo::{Config, Input, ResetReason, Servo, Settings};

/// Line that the example prints.
pub fn in_rust() -> String {
    let Recommended { settings, rendering } = TOUCH;
    let settings = Settings { body_origin_m: vec3(0.025, 0.0, 0.1935) - vec3(0.03, 0.02, 0.0335), ..settings };
    let inertia = PROTECTION.polarity.expect("a polarity check").inertia_kg_m2;
    with_capped_box(|body| {
        let config = Config { settings, rendering, ..Config::DEFAULT };
        let servo = Servo::try_protected(&DEVICE, body, PROTECTION, config).expect("a loop");
        let mut state = servo.start_after(ResetReason::Unknown);
        let (mut angles, mut speeds) = ([0.0_f32; 3], [0.0_f32; 3]);
        for tick in 0..8_000 {
            let count = |joint: usize| (angles[joint] / DEVICE.encoders[joint].radians_per_count).floor() as i32;
            let counts = core::array::from_fn(|joint| Counts(count(joint)));
            let _ = servo.tick(&mut state, Input::Sensors { counts, enable: tick >= 400 });
            let hand = [0.0, 0.0, if tick < 4_000 { 2e-5 * tick as f32 } else { 0.08 }];
            for (joint, duty) in state.duties().into_iter().enumerate() {
                let mut torque = f32::from(duty.0) / 32_767.0 * DEVICE.motors[joint].torque_at_full_n_m;
                torque += 10.0 * (hand[joint] - angles[joint]);
                torque -= 0.5 * speeds[joint];
                speeds[joint] += torque / inertia[joint] / settings.rate_hz;
                angles[joint] += speeds[joint] / settings.rate_hz;
            }
        }
        let (depth, force) = (-state.gap(), state.force().z);
        // At rest the wall is a spring.
        assert!((force - settings.stiffness_n_per_m * depth).abs() < 1e-4 && force > 0.5, "{force} N at {depth} m");
        assert_eq!(state.fault(), None);
        let depth = 1e3 * f64::from(depth);
        format!("fault: none; depth {depth:.4} mm, force {force:.4} N, state {:08x}\n", state.digest())
    })
}
