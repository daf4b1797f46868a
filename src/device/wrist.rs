//! A gimbal on an arm: the orientation of the handle.

use super::{Counts, Delta, Encoder, Kinematics, LinkageArm, SerialArm};
use crate::math::{Vec3, product, quaternion, sin_cos, vec3};
use core::fmt;

/// An arm that a wrist can be mounted on: one that says how its last link is turned.
pub trait Mount<const JOINTS: usize>: Kinematics<JOINTS> {
    /// The orientation of the last link at these joint angles, radians, as a quaternion `(x, y, z, w)` of length 1 that
    /// takes its frame to the device's; `None` where the mechanism cannot be closed.
    fn last_link(&self, angles: [f32; JOINTS]) -> Option<[f32; 4]>;
}

/// The second link's frame: x along it, y its axis of tilt. Turned by `a` about z, then by `c` about y.
impl Mount<3> for SerialArm {
    fn last_link(&self, [a, _, c]: [f32; 3]) -> Option<[f32; 4]> {
        Some(product(&turn_about(Vec3::Z, a), &turn_about(Vec3::Y, c)))
    }
}

/// The first rod's frame, that of the probe: x along it, z up where it is level.
impl Mount<3> for LinkageArm {
    fn last_link(&self, [a, b, c]: [f32; 3]) -> Option<[f32; 4]> {
        let closed = self.linkage.close([b, c])?;
        let rod = self.linkage.tool(&closed).place - closed.elbows[0].place;
        let along = rod / rod.length();
        let tilt = quaternion(&[vec3(along.x, 0.0, along.y), Vec3::Y, vec3(-along.y, 0.0, along.x)]);
        Some(product(&turn_about(Vec3::Z, a), &tilt))
    }
}

/// The plate, which never turns.
impl Mount<3> for Delta {
    fn last_link(&self, _: [f32; 3]) -> Option<[f32; 4]> {
        Some([0.0, 0.0, 0.0, 1.0])
    }
}

/// Three axes one after another, which meet in the probe, with an encoder each.
///
/// The axes are those of the pose in which all angles are zero, in the frame of the arm's last link, where the handle's
/// frame is the link's. With `A` the link's orientation, the handle's is `A R₁(θ₁) R₂(θ₂) R₃(θ₃)`.
///
/// Because the axes meet in the probe, the handle's turns move no joint of the arm, and the arm's torques are those of
/// the force alone. A handle whose axes miss the probe needs the force moved to where they meet.
///
/// ```
/// use palpate::device::{Counts, Encoder, Mount as _, Wrist, WristState, presets::WOODEN_HAPTICS_2016 as ARM};
/// use palpate::math::Vec3;
///
/// /// Yaw, pitch and roll of a pen on the second link, 4,096 counts a turn.
/// const GIMBAL: Wrist = Wrist {
///     axes: [Vec3::Z, Vec3::Y, Vec3::X],
///     encoders: [Encoder::geared(4_096.0, 1.0, 0.0); 3],
///     range_rad: [[-2.5, 2.5], [-1.2, 1.2], [-2.6, 2.6]],
///     max_rate_rad_per_s: 40.0,
/// };
/// const { assert!(GIMBAL.is_valid()) };
///
/// let mut state = WristState::default();
/// let link = ARM.kinematics.last_link(ARM.angles_at_zero()).expect("within reach");
/// let turned = GIMBAL.orientation(&mut state, link, [Counts(512), Counts(0), Counts(0)], 1.0 / 4_000.0)?;
/// assert!((turned.iter().map(|number| number * number).sum::<f32>() - 1.0).abs() < 1e-5);
/// // An encoder whose count leaps.
/// let leapt = GIMBAL.orientation(&mut state, link, [Counts(900), Counts(0), Counts(0)], 1.0 / 4_000.0);
/// assert!(leapt.is_err());
/// # Ok::<(), palpate::device::WristError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrist {
    /// The axes, unit vectors, from the arm to the handle.
    pub axes: [Vec3; 3],
    /// One encoder an axis.
    pub encoders: [Encoder; 3],
    /// Minimum and maximum angle of each axis, radians: an angle outside is a sensor fault.
    pub range_rad: [[f32; 2]; 3],
    /// Maximum plausible speed of an axis, rad/s: a faster one is a sensor fault.
    pub max_rate_rad_per_s: f32,
}

/// The angles of a wrist in the last tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WristState {
    angles: Option<[f32; 3]>,
}

/// Why the angles of a wrist are not used. Send no [`crate::servo::Event::Oriented`] in this tick; contact ends once
/// the last orientation is old.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WristError {
    /// The angle of an axis, from 0, is out of its range.
    Range(u8),
    /// The angle of an axis, from 0, has changed faster than the wrist can turn.
    Jump(u8),
}

impl fmt::Display for WristError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(axis) => write!(formatter, "wrist axis {axis}: angle out of range; check encoder and zero"),
            Self::Jump(axis) => write!(formatter, "wrist axis {axis}: angle has jumped; check encoder and wiring"),
        }
    }
}

impl core::error::Error for WristError {}

impl Wrist {
    /// Whether the axes are unit vectors, of which no two successive ones are parallel, the ranges rising, and all
    /// numbers finite.
    pub const fn is_valid(&self) -> bool {
        let mut axis = 0;
        while axis < 3 {
            let Vec3 { x, y, z } = self.axes[axis];
            let squared = x * x + y * y + z * z;
            let Encoder { radians_per_count, angle_at_zero_rad } = self.encoders[axis];
            let [least, most] = self.range_rad[axis];
            let is_axis = squared > 0.999 && squared < 1.001;
            let counts = radians_per_count.is_finite() && radians_per_count != 0.0 && angle_at_zero_rad.is_finite();
            if !(is_axis && counts && least.is_finite() && most.is_finite() && least < most) {
                return false;
            }
            if axis > 0 {
                let before = self.axes[axis - 1];
                let cosine = before.x * x + before.y * y + before.z * z;
                if cosine.abs() > 0.9 {
                    return false;
                }
            }
            axis += 1;
        }
        self.max_rate_rad_per_s > 0.0 && self.max_rate_rad_per_s < f32::INFINITY
    }

    /// The handle's orientation in the device's frame, a quaternion `(x, y, z, w)`, from that of the arm's last link
    /// ([`Mount::last_link`]) and the counts, `period_s` after those before.
    ///
    /// # Errors
    /// An axis out of its range or faster than it can turn. The state then keeps the angles before, and the next counts
    /// are compared with those: after a glitch of one tick it goes on.
    pub fn orientation(
        &self,
        state: &mut WristState,
        last_link: [f32; 4],
        counts: [Counts; 3],
        period_s: f32,
    ) -> Result<[f32; 4], WristError> {
        let mut angles = [0.0; 3];
        let max_turn = self.max_rate_rad_per_s * period_s;
        for (axis, (angle, [least, most])) in angles.iter_mut().zip(&self.range_rad).enumerate() {
            *angle = self.encoders[axis].angle(counts[axis]);
            if !(*least <= *angle && *angle <= *most) {
                return Err(WristError::Range(axis as u8));
            }
            let turned = state.angles.map_or(0.0, |before| (*angle - before[axis]).abs());
            // A count is no jump, however short the tick.
            if turned > max_turn + 1.5 * self.encoders[axis].radians_per_count.abs() {
                return Err(WristError::Jump(axis as u8));
            }
        }
        state.angles = Some(angles);
        let mut orientation = last_link;
        for (axis, angle) in self.axes.into_iter().zip(angles) {
            orientation = product(&orientation, &turn_about(axis, angle));
        }
        Ok(orientation)
    }
}

impl WristState {
    /// The angles of the axes, radians; `None` before the first good counts.
    pub const fn angles(&self) -> Option<[f32; 3]> {
        self.angles
    }
}

/// The quaternion of a turn about a unit vector.
fn turn_about(axis: Vec3, angle: f32) -> [f32; 4] {
    let (sine, cosine) = sin_cos(0.5 * angle);
    [axis.x * sine, axis.y * sine, axis.z * sine, cosine]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::{POLHEM_V2, WOODEN_HAPTICS_2016};

    const GIMBAL: Wrist = Wrist {
        axes: [Vec3::Z, Vec3::Y, Vec3::X],
        encoders: [Encoder { radians_per_count: 1e-3, angle_at_zero_rad: 0.0 }; 3],
        range_rad: [[-2.5, 2.5], [-1.2, 1.2], [-2.6, 2.6]],
        max_rate_rad_per_s: 40.0,
    };

    fn turned(q: &[f32; 4], v: Vec3) -> Vec3 {
        let [x, y, z, _] = product(&product(q, &[v.x, v.y, v.z, 0.0]), &[-q[0], -q[1], -q[2], q[3]]);
        vec3(x, y, z)
    }

    /// The last link points where a longer one would bring the probe, and turns about the axis of the first joint.
    fn assert_link<K: Mount<3>>(arm: &K, longer: &K, angles: [f32; 3]) {
        let q = arm.last_link(angles).expect("within reach");
        let pose = arm.pose(angles).expect("within reach");
        let along = longer.pose(angles).expect("within reach").position - pose.position;
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turned(&q, axis));
        // A difference of some centimetres between numbers of some decimetres.
        assert!((x - along / along.length()).length() < 3e-6, "{angles:?}: {x} {along}");
        let round = pose.jacobian[0] / pose.jacobian[0].length();
        assert!((y - round).length() < 2e-6, "{angles:?}: {y} {round}");
        assert!((z - x.cross(y)).length() < 1e-6);
    }

    #[test]
    fn the_last_link_points_along_itself() {
        let serial = WOODEN_HAPTICS_2016.kinematics;
        let longer = SerialArm { second_link_m: serial.second_link_m + 0.1, ..serial };
        let linkage = POLHEM_V2.kinematics;
        let mut reaching = linkage;
        reaching.linkage.tool_m *= 1.5;
        for step in 0..60 {
            let swing = |size: f32, pace: f32| size * (pace * step as f32).sin();
            assert_link(&serial, &longer, [swing(1.2, 0.9), swing(0.6, 0.7), swing(0.7, 1.3)]);
            let [a, b, c] = [0.0, 0.912_695, 2.360_105];
            assert_link(&linkage, &reaching, [a + swing(1.0, 0.9), b + swing(0.2, 0.7), c + swing(0.2, 1.3)]);
        }
    }

    /// Entries of `Rz(ψ) Ry(θ) Rx(φ)`, as every textbook has them.
    #[test]
    fn a_yaw_pitch_roll_gimbal_has_its_rotation_matrix() {
        for counts in [[0, 0, 0], [700, -400, 1_300], [-2_100, 1_100, -900], [1_570, 0, 2_000]] {
            let [yaw, pitch, roll] = counts.map(|count| count as f32 * 1e-3);
            let q = GIMBAL
                .orientation(&mut WristState::default(), [0.0, 0.0, 0.0, 1.0], counts.map(Counts), 2.5e-4)
                .expect("in range");
            let [x, y] = [turned(&q, Vec3::X), turned(&q, Vec3::Y)];
            let expected = vec3(yaw.cos() * pitch.cos(), yaw.sin() * pitch.cos(), -pitch.sin());
            // Some ten roundings.
            assert!((x - expected).length() < 2e-6, "{counts:?}: {x} {expected}");
            assert!((y.z - pitch.cos() * roll.sin()).abs() < 2e-6, "{counts:?}");
        }
    }

    #[test]
    fn an_axis_out_of_range_and_one_that_jumps_are_named() {
        let mut state = WristState::default();
        let mut ask = |counts: [i32; 3]| {
            GIMBAL.orientation(&mut state, [0.0, 0.0, 0.0, 1.0], counts.map(Counts), 2.5e-4).map(|_| ())
        };
        assert_eq!(ask([0, 1_300, 0]), Err(WristError::Range(1)));
        assert_eq!(ask([0, 0, 2_000]), Ok(()));
        // 10 mrad in a tick are 40 rad/s, and a count and a half of 1 mrad more are rounding.
        assert_eq!(ask([11, 0, 2_000]), Ok(()));
        assert_eq!(ask([11, 0, 1_980]), Err(WristError::Jump(2)));
        // The glitch is over.
        assert_eq!(ask([11, 0, 2_001]), Ok(()));
    }

    #[test]
    fn axes_that_are_none_are_refused() {
        assert!(GIMBAL.is_valid());
        for axes in [[Vec3::Z, Vec3::Y, Vec3::ZERO], [Vec3::Z, Vec3::Z, Vec3::X], [Vec3::Z, Vec3::NAN, Vec3::X]] {
            assert!(!Wrist { axes, ..GIMBAL }.is_valid(), "{axes:?}");
        }
        for range in [[1.0, -1.0], [f32::NAN, 1.0], [-1.0, f32::INFINITY]] {
            assert!(!Wrist { range_rad: [range; 3], ..GIMBAL }.is_valid(), "{range:?}");
        }
        for rate in [0.0, f32::NAN, f32::INFINITY] {
            assert!(!Wrist { max_rate_rad_per_s: rate, ..GIMBAL }.is_valid(), "{rate}");
        }
    }
}
