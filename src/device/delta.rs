//! The three-legged delta of Stamper's kind, as in the Novint Falcon.

use super::device_error::{all_of, centre, is_unit, lengths, offsets, weights};
use super::{DeviceError, GRAVITY, Kinematics, ProbePose};
use crate::math::{Vec3, atan2, sin_cos, sqrt, vec3};

/// Newton steps after the closed-form start. On the Falcon, over its workspace, the start is off by 2.9 mm, and steps
/// leave 50 µm, then 20 nm, then roundings.
const REFINEMENTS: usize = 3;

/// Three legs about the z axis, each a thigh on a motor and a shin that is a parallelogram on two short stubs.
///
/// Joint angles, radians: each thigh's, zero when it points outward, positive towards +z, where the probe is. A leg's
/// own frame has u outward along its `direction`, v to the left of it seen from +z, and w along z; there, with the
/// probe at `(u, v, w)` of it, the leg closes when `√((u − reach − a cos θ)² + (w − a sin θ)²) = stub + √(b² − (v −
/// side)²)` (Stamper 1997). Without stubs that is a sphere about the knee, and three spheres meet in closed form; with
/// them the forward map starts there and takes a fixed number of Newton steps.
///
/// The Jacobian follows from the legs' unit shins `sᵢ`: `sᵢ · Ṗ = cᵢ θ̇ᵢ`, with `cᵢ` the shin's share of the knee's
/// speed.
///
/// The frame: z out of the base towards the probe, x and y as the legs' directions say, origin in the workspace centre.
///
/// ```
/// use palpate::device::{Delta, Kinematics as _, presets::NOVINT_FALCON};
/// use palpate::math::Vec3;
///
/// let delta: Delta = NOVINT_FALCON.kinematics;
/// let angles = delta.angles(Vec3::ZERO).expect("within reach");
/// let pose = delta.pose(angles).expect("within reach");
/// assert!(pose.position.length() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delta {
    /// Length of a thigh, `a`, metres.
    pub thigh_m: f32,
    /// Length of a shin, the long side of the parallelogram, `b`, metres.
    pub shin_m: f32,
    /// Length of both stubs together, metres.
    pub stub_m: f32,
    /// From the axis out to a hip, less the same from the probe to the end of a shin, metres.
    pub reach_m: f32,
    /// The same difference to the left of a leg, metres.
    pub side_m: f32,
    /// Cosine and sine of each leg's direction about z.
    pub directions: [[f32; 2]; 3],
    /// The centre of the workspace, metres from the middle of the base.
    pub workspace_centre_m: Vec3,
    /// Which way is up, a unit vector.
    pub up: Vec3,
    /// Mass that hangs on the probe, half the shins included, kg; zero if not known.
    pub carried_mass_kg: f32,
    /// Mass of a thigh, with the other half of its shin at the knee, times the distance of the centre from the hip,
    /// kg·m.
    pub thigh_moment_kg_m: f32,
}

/// A leg at one angle: the knee, moved in by the plate's stub, and its speed per radian.
#[derive(Clone, Copy)]
struct Leg {
    outward: Vec3,
    left: Vec3,
    knee: Vec3,
    turn: Vec3,
}

/// How far a leg is from closing, metres; its unit shin; and the speed of the probe along the shin per radian.
struct Gap {
    gap: f32,
    shin: Vec3,
    share: f32,
}

impl Delta {
    #[inline]
    fn leg(&self, [cosine, sine]: [f32; 2], angle: f32) -> Leg {
        let (outward, left) = (vec3(cosine, sine, 0.0), vec3(-sine, cosine, 0.0));
        let (sin, cos) = sin_cos(angle);
        Leg {
            outward,
            left,
            knee: outward * (self.reach_m + self.thigh_m * cos)
                + left * self.side_m
                + vec3(0.0, 0.0, self.thigh_m * sin),
            turn: vec3(0.0, 0.0, self.thigh_m * cos) - outward * (self.thigh_m * sin),
        }
    }

    /// Where three spheres about the knees meet on the far side; `None` where they do not.
    #[inline]
    fn meet(&self, [a, b, c]: [Vec3; 3]) -> Option<Vec3> {
        let (e, f) = (b - a, c - a);
        let normal = e.cross(f);
        let square = normal.length_squared();
        let to_middle = (normal.cross(e) * f.length_squared() + f.cross(normal) * e.length_squared()) / (2.0 * square);
        let radius = self.shin_m + self.stub_m;
        let height = (radius * radius - to_middle.length_squared()) / square;
        // Written so that NaN takes this branch too.
        if !(height > 0.0 && height < f32::INFINITY) {
            return None;
        }
        let rise = sqrt(height);
        Some(a + to_middle + normal * if normal.z < 0.0 { -rise } else { rise })
    }

    #[inline]
    fn gap(&self, leg: &Leg, probe: Vec3) -> Gap {
        let q = probe - leg.knee;
        let sideways = q.dot(leg.left);
        let plane = leg.outward * q.dot(leg.outward) + vec3(0.0, 0.0, q.z);
        let distance = sqrt(plane.length_squared());
        let forward = plane / distance;
        let span = sqrt(self.shin_m * self.shin_m - sideways * sideways);
        Gap {
            gap: (distance - self.stub_m - span) * (span / self.shin_m),
            shin: (forward * span + leg.left * sideways) / self.shin_m,
            share: forward.dot(leg.turn) * (span / self.shin_m),
        }
    }

    /// The joint angles that put the probe at a position of the device's frame, knees out; `None` where a leg does not
    /// reach. Closed form: cosine rule in each leg's plane.
    pub fn angles(&self, position: Vec3) -> Option<[f32; 3]> {
        let probe = position + self.workspace_centre_m;
        let mut angles = [0.0; 3];
        for (angle, [cosine, sine]) in angles.iter_mut().zip(self.directions) {
            let leg = self.leg([cosine, sine], 0.0);
            let (u, v) = (probe.dot(leg.outward) - self.reach_m, probe.dot(leg.left) - self.side_m);
            let distance = sqrt(u * u + probe.z * probe.z);
            let span = self.stub_m + sqrt(self.shin_m * self.shin_m - v * v);
            let cosine =
                (self.thigh_m * self.thigh_m + distance * distance - span * span) / (2.0 * self.thigh_m * distance);
            // Written so that NaN takes this branch too.
            if !(-1.0..=1.0).contains(&cosine) {
                return None;
            }
            *angle = atan2(probe.z, u) - atan2(sqrt(1.0 - cosine * cosine), cosine);
        }
        Some(angles)
    }
}

impl Delta {
    /// As [`Kinematics::check`], for constants.
    ///
    /// The weight of a joint: its thigh's, and all that hangs on the probe at the end of it, held out level. Towards a
    /// singularity a motor takes more: on the Falcon almost twice as much.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        let Self { thigh_m, shin_m, stub_m, reach_m, side_m, directions: [a, b, c], .. } = *self;
        if !(is_unit(&a) && is_unit(&b) && is_unit(&c)) {
            return Err(DeviceError::Mechanism("legs"));
        }
        if !is_unit(&self.up.to_array()) {
            return Err(DeviceError::Mechanism("up"));
        }
        if !(self.carried_mass_kg >= 0.0 && self.carried_mass_kg < f32::INFINITY) {
            return Err(DeviceError::Mass("carried_mass"));
        }
        let (out, moment) =
            (reach_m.abs() + side_m.abs(), self.carried_mass_kg * thigh_m + self.thigh_moment_kg_m.abs());
        all_of!(
            lengths(&[("thigh", thigh_m), ("shin", shin_m)]),
            offsets(&[("stub", stub_m), ("reach", reach_m), ("side", side_m)]),
            if stub_m >= 0.0 { Ok(()) } else { Err(DeviceError::Mechanism("stub")) },
            centre(&self.workspace_centre_m.to_array(), out + thigh_m + shin_m + stub_m),
            weights([moment; 3], holds_n_m)
        )
    }
}

impl Kinematics<3> for Delta {
    #[inline]
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        self.held_pose(angles).map(|(pose, _)| pose)
    }

    #[inline]
    fn held_pose(&self, [a, b, c]: [f32; 3]) -> Option<(ProbePose<3>, [f32; 3])> {
        let [to_a, to_b, to_c] = self.directions;
        let legs = [self.leg(to_a, a), self.leg(to_b, b), self.leg(to_c, c)];
        let mut probe = self.meet(legs.map(|leg| leg.knee))?;
        for _ in 0..REFINEMENTS {
            let [a, b, c] = legs.map(|leg| self.gap(&leg, probe));
            let (bc, ca, ab) = (b.shin.cross(c.shin), c.shin.cross(a.shin), a.shin.cross(b.shin));
            probe -= (bc * a.gap + ca * b.gap + ab * c.gap) / a.shin.dot(bc);
        }
        let [a, b, c] = legs.map(|leg| self.gap(&leg, probe));
        let (bc, ca, ab) = (b.shin.cross(c.shin), c.shin.cross(a.shin), a.shin.cross(b.shin));
        let volume = a.shin.dot(bc);
        if !probe.is_finite() || volume == 0.0 {
            return None;
        }
        let pose = ProbePose {
            position: probe - self.workspace_centre_m,
            jacobian: [bc * (a.share / volume), ca * (b.share / volume), ab * (c.share / volume)],
        };
        let mut torques = pose.torques(self.up * (GRAVITY * self.carried_mass_kg));
        for (torque, leg) in torques.iter_mut().zip(legs) {
            // A thigh's centre is lifted as its knee is.
            *torque += GRAVITY * self.thigh_moment_kg_m * (leg.turn.dot(self.up) / self.thigh_m);
        }
        Some((pose, torques))
    }

    fn check(&self, holds_n_m: [f32; 3]) -> Result<(), DeviceError> {
        Self::check(self, holds_n_m)
    }
}
