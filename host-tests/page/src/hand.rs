//! The hand that holds the device: it wants to be where the pointer is, and the device pushes back.

use palpate::math::Vec3;

/// How a hand holds a handle.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    /// Mass of hand and handle, kg.
    pub mass: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
}

impl Grip {
    /// A light grip: 50 g, pulled to the pointer by 400 N/m and critically damped, `2 √(k m)`.
    pub const LIGHT: Self = Self { mass: 0.05, stiffness: 400.0, damping: 8.944_272 };
}

/// Where the handle is, and how fast.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hand {
    /// Metres.
    pub position: Vec3,
    /// m/s.
    pub velocity: Vec3,
}

/// The longest step of the integration, s.
const STEP: f32 = 1.25e-4;

impl Hand {
    /// Moves on by a period, s, towards a place that itself moves on to `to`, under the device's force, N, which it
    /// holds for so long. Semi-implicit Euler.
    pub fn advance(&mut self, grip: &Grip, [from, to]: [Vec3; 2], force: Vec3, period: f32) {
        let steps = (period / STEP) as u32 + 1;
        let step = period / steps as f32;
        let wanted = (to - from) / period;
        for index in 0..steps {
            let place = from + (to - from) * ((index + 1) as f32 / steps as f32);
            let pull = (place - self.position) * grip.stiffness + (wanted - self.velocity) * grip.damping;
            self.velocity += (pull + force) * (step / grip.mass);
            self.position += self.velocity * step;
        }
    }
}
