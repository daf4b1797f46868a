//! A body, seeded numbers, and rigid motions in double precision.

use glam::{DMat3, DVec3};
use palpate::body::{Body, Soft};
use palpate::field::{Modal, Mode};
use palpate::math::{Vec3, vec3};
use palpate::scene::{Limits, Material, Motion, Part, Sphere};
use palpate::servo::SoftBody;
use palpate::track::Placement;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

mod capped_box {
    include!("../../../../boards/bodies/capped_box.rs");
}

/// Six faces, one of them a dome; 60 × 40 × 34 mm.
pub static BOX: Body = capped_box::BODY;
/// Its middle, in its own frame.
pub const MIDDLE: DVec3 = DVec3::new(0.03, 0.02, 0.015);

pub const RATE: f32 = 4_000.0;
pub const PERIOD: f32 = 1.0 / RATE;

pub const LIMITS: Limits = Limits {
    max_stiffness_n_per_m: 2_000.0,
    max_damping_n_s_per_m: 5.0,
    max_force_n: 5.0,
    release_n_per_s: 100.0,
    rate_hz: RATE,
    max_speed_m_per_s: 2.0,
};
pub const MATERIAL: Material = Material::new(600.0, 1.0);

/// The box, with the ball that holds it: half the diagonal of 60 × 40 × 34 mm about (30, 20, 17) mm is 39.9 mm.
pub const fn part(motion: Motion, material: Material) -> Part<'static, Body<'static>> {
    Part { sphere: Sphere { centre_m: vec3(0.03, 0.02, 0.017), radius_m: 0.04 }, ..Part::new(&BOX, motion, material) }
}

mod deformed {
    include!("../../../../boards/bodies/capped_box_modes.rs");
}

/// How many modes the foam has.
pub const MODES: usize = 4;
/// Their motion.
pub static MOTION: [Modal; MODES] = *deformed::MOTION.first_chunk().unwrap();
/// The box of a foam, held at its bottom.
pub static FOAM: SoftBody = deforming(deformed::MODES.first_chunk::<MODES>().unwrap(), &MOTION);
/// The box without modes, as it stands beside the foam in a scene.
pub static STIFF: SoftBody = deforming(&[], &[]);

const fn deforming(modes: &'static [Mode], motion: &[Modal]) -> SoftBody<'static> {
    let Ok(soft) = Soft::new(BOX, modes) else { panic!() };
    let Ok(body) = SoftBody::new(soft, motion, RATE) else { panic!() };
    body
}

/// One of the two, with the ball of [`part`] and the motion of its surface.
pub fn soft(body: &'static SoftBody<'static>, motion: Motion, material: Material) -> Part<'static, SoftBody<'static>> {
    let Sphere { centre_m, radius_m } = part(motion, material).sphere;
    let of_modes: f32 = body.soft().modes().iter().map(|mode| mode.limit * mode.bounds.motion).sum();
    Part { sphere: Sphere { centre_m, radius_m: radius_m + of_modes }, ..Part::soft(body, motion, material) }
}

/// Seeded numbers.
pub struct Random(Pcg32);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::seed_from_u64(seed))
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let vector = self.vector(1.0);
            if (0.1..1.0).contains(&vector.length()) {
                return vector.normalize();
            }
        }
    }
}

pub fn single(vector: DVec3) -> Vec3 {
    vec3(vector.x as f32, vector.y as f32, vector.z as f32)
}

pub fn double(vector: Vec3) -> DVec3 {
    DVec3::new(vector.x.into(), vector.y.into(), vector.z.into())
}

/// A rigid motion: turning and going at rates that sway, up to the greatest ones.
pub struct Ride {
    pub axes: DMat3,
    pub origin: DVec3,
    pub velocity: DVec3,
    pub angular_velocity: DVec3,
    speeds: [DVec3; 2],
    rates: [f64; 2],
    time: f64,
}

impl Ride {
    /// At most `spin` rad/s and `speed` m/s.
    pub fn new(random: &mut Random, origin: DVec3, spin: f64, speed: f64) -> Self {
        Self {
            axes: DMat3::from_axis_angle(random.direction(), random.between(0.0, 3.0)),
            origin,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            speeds: [random.direction() * spin, random.direction() * speed],
            rates: [random.between(2.0, 20.0), random.between(20.0, 60.0)],
            time: 0.0,
        }
    }

    /// A tick later.
    pub fn advance(&mut self) {
        let period = f64::from(PERIOD);
        self.time += period;
        self.angular_velocity = self.speeds[0] * (self.rates[0] * self.time).cos();
        self.velocity = self.speeds[1] * (self.rates[1] * self.time).cos();
        let angle = self.angular_velocity.length() * period;
        if angle > 0.0 {
            self.axes = DMat3::from_axis_angle(self.angular_velocity.normalize(), angle) * self.axes;
        }
        self.origin += self.velocity * period;
    }

    pub fn placement(&self) -> Placement {
        Placement {
            axes: [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis].map(single),
            origin: single(self.origin),
            velocity: single(self.velocity),
            angular_velocity: single(self.angular_velocity),
        }
    }

    pub fn to_body(&self, point: DVec3) -> DVec3 {
        self.axes.transpose() * (point - self.origin)
    }
}
