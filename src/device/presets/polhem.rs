//! Polhem.

use crate::device::drive::Feed;
use crate::device::{Device, Encoder, FiveBar, LinkMass, LinkageArm, Motor, Reference};
use crate::math::{Vec2, vec3};

const RATIOS: [f32; 3] = [0.175 / 0.028_853_4, 0.100 / 0.013_698_1, 0.100 / 0.013_728_1];

const ENCODERS: [Encoder; 3] = {
    let [a, b, c] = RATIOS;
    [Encoder::geared(4_096.0, a, 0.0), Encoder::geared(4_096.0, -b, 0.0), Encoder::geared(4_096.0, c, 0.0)]
};

/// Polhem, second version: an arm whose second link hangs on a crank and a rod.
///
/// Not the plain arm its stated 100, 165 and 130.8 mm suggest: its own kinematics (forsslund/hfabapi, `hfab_polhem.h`)
/// is a five-bar on a turntable, with pivots 34 mm apart, cranks 165 and 25 mm, rods 34 and 190 mm, and the probe 130.8
/// mm out on the short rod's other side. Masses and centres with covers are from there too. Capstans 28.8534, 13.6981
/// and 13.7281 mm on bodies of 175, 100 and 100 mm; 4,096 counts, so 35 µm at the first link's end; 0.0603, 0.0538 and
/// 0.0538 N·m/A, 3 A; 5 N, 2,000 N/m; directions: the second motor turns against its body. The frame: x towards the
/// user at `a = 0`, z up, origin (204.5, 0, 32.5) mm from the pivots' middle. Assumed: maximum damping. A plain wall
/// of 2,000 N/m and 5 N·s/m at 4 kHz, pressed in simulation, gives stiffness times depth to 1 %, and no count moves;
/// [`crate::servo::recommended`] is softer, so that a hand feels no count either.
pub const POLHEM_V2: Device<LinkageArm, 3> = Device {
    kinematics: LinkageArm {
        linkage: FiveBar {
            second_pivot_m: -0.034,
            cranks_m: [0.165, 0.025],
            rods_m: [0.034, 0.190],
            side: -1.0,
            tool_m: -0.130_8,
            workspace_centre_m: Vec2::ZERO,
        },
        pivot_reach_m: 0.017,
        workspace_centre_m: vec3(0.204_5, 0.0, 0.032_5),
        masses: [
            LinkMass { mass_kg: 0.157_64, along_m: 0.030_123, across_m: 0.000_484 },
            LinkMass { mass_kg: 0.077_33, along_m: -0.004_086, across_m: 0.001_911 },
            LinkMass { mass_kg: 0.112_65, along_m: 0.061_701, across_m: 0.000_576 },
            LinkMass { mass_kg: 0.097_67, along_m: 0.087_765, across_m: 0.001_978 },
        ],
    },
    encoders: ENCODERS,
    motors: {
        let [a, b, c] = RATIOS;
        [
            Motor::current_driven(0.060_3, 3.0, a),
            Motor::current_driven(0.053_8, 3.0, -b),
            Motor::current_driven(0.053_8, 3.0, c),
        ]
    },
    feeds: [Feed::Current; 3],
    dry_friction_n_m: [0.01; 3],
    joint_range_rad: [[-2.2, 2.2], [0.2, 2.4], [1.0, 4.3]],
    min_margin_m_per_rad: 0.025,
    max_joint_rate_rad_per_s: 40.0,
    max_force_n: 5.0,
    max_stiffness_n_per_m: 2_000.0,
    max_damping_n_s_per_m: 5.0,
};

/// Where [`POLHEM_V2`] is put down to be calibrated: the source's offsets of 8,312, −10,366 and 19,764 counts, as
/// angles.
pub const POLHEM_V2_REFERENCE: Reference<3> = {
    let [a, b, c] = ENCODERS;
    Reference::Pose([8_312.0 * a.radians_per_count, -10_366.0 * b.radians_per_count, 19_764.0 * c.radians_per_count])
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Kinematics;

    /// Cranks that put the probe at the workspace centre, to a micrometre.
    const CENTRE: [f32; 3] = [0.0, 0.912_695, 2.360_105];

    #[test]
    fn the_reference_pose_is_within_the_joint_range() {
        let Reference::Pose(angles) = POLHEM_V2_REFERENCE else { panic!() };
        for (angle, [least, most]) in angles.into_iter().zip(POLHEM_V2.joint_range_rad) {
            assert!((least..most).contains(&angle), "{angles:?}");
        }
    }

    #[test]
    fn holding_torques_are_the_slope_of_the_height_of_the_masses() {
        let arm = POLHEM_V2.kinematics;
        // The centres' heights in f64, straight from the drawing: elbows, hinge by circles, then offsets.
        let energy = |b: f64, c: f64| {
            let (a1, a2) = ([0.165 * b.cos(), 0.165 * b.sin()], [-0.034 + 0.025 * c.cos(), 0.025 * c.sin()]);
            let (hx, hy) = (a2[0] - a1[0], a2[1] - a1[1]);
            let distance = hx.hypot(hy);
            let cosine = (0.034_f64.powi(2) + distance * distance - 0.19_f64.powi(2)) / (2.0 * 0.034 * distance);
            let forward = hy.atan2(hx) - cosine.acos();
            let hinge = [a1[0] + 0.034 * forward.cos(), a1[1] + 0.034 * forward.sin()];
            let rod = (hinge[1] - a2[1]).atan2(hinge[0] - a2[0]);
            let lambda = forward + core::f64::consts::PI;
            let up = |angle: f64, x: f64, y: f64| x * angle.sin() + y * angle.cos();
            9.81 * (0.157_64 * up(b, 0.030_123, 0.000_484)
                + 0.077_33 * up(c, -0.004_086, 0.001_911)
                + 0.097_67 * (a2[1] + up(rod, 0.087_765, 0.001_978))
                + 0.112_65 * (a1[1] + up(lambda, 0.061_701, 0.000_576)))
        };
        let pose = arm.pose(CENTRE);
        assert!(pose.unwrap().position.length() < 1e-5, "{}", pose.unwrap().position);
        for (db, dc) in [(0.0, 0.0), (0.2, 0.1), (-0.2, 0.3), (0.1, -0.3)] {
            let (b, c) = (0.912_695 + db, 2.360_105 + dc);
            let [_, first, second] = arm.holding_torques([0.3, b as f32, c as f32]);
            let slope =
                |step_b: f64, step_c: f64| (energy(b + step_b, c + step_c) - energy(b - step_b, c - step_c)) / 2e-5;
            // Torques of a few 0.1 N·m, rounded some ten times, on lengths that cancel to a tenth.
            assert!((f64::from(first) - slope(1e-5, 0.0)).abs() < 1e-5, "{first} {}", slope(1e-5, 0.0));
            assert!((f64::from(second) - slope(0.0, 1e-5)).abs() < 1e-5, "{second} {}", slope(0.0, 1e-5));
        }
    }
}
