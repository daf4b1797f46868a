/// The simulated stand-in for your hardware: a light wheel with some friction, and a finger that turns it.
#[derive(Default)]
struct Wheel {
    angle: f32,
    speed: f32,
}

impl Wheel {
    /// A period under this duty and this torque of the finger, N·m.
    fn turn(&mut self, duty: Duty, finger: f32) {
        const INERTIA: f32 = 2e-5;
        const FRICTION: f32 = 2e-3;
        let torque = duty.fraction() * MOTOR.torque_at_full_n_m + finger - FRICTION * self.speed;
        self.speed += torque / INERTIA / RATE;
        self.angle += self.speed / RATE;
    }
}
