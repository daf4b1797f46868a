//! A device along one direction: what a wall's push has to move.

use crate::devices::ShippedDevice;
use crate::plant::{Amplifier, JointSettings, dot, inverse, scaled, times};
use palpate::device::drive::Feed;
use palpate::render::bounds::DeviceFriction;

/// One mass with friction, an encoder and a force source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// The name on the command line.
    pub name: &'static str,
    /// Mass at the probe, kg.
    pub mass: f64,
    /// Viscous friction, N·s/m.
    pub viscous: f64,
    /// Coulomb friction, N.
    pub coulomb: f64,
    /// One encoder count, m at the probe.
    pub resolution: f64,
    /// The maximum force, N.
    pub max_force: f64,
    /// Time constant of the force source, s.
    pub time_constant: f64,
}

impl Slice {
    /// A device at the middle of its workspace: along z, the vertical (the Falcon's axis); of two joints along y, away
    /// from the pivots; of one along x.
    ///
    /// Mass, friction and encoders are the simulated device's for a push that nothing guides sideways, which is the
    /// lightest the probe can be. The resolution is that of all joints together. On a bridge, back-EMF brakes as far as
    /// the preset does not make up for it. Limits are the preset's.
    ///
    /// # Panics
    /// If the device cannot be at the middle of its own workspace.
    pub fn of(device: &ShippedDevice) -> Self {
        let settings = device.plant;
        let mechanism = settings.mechanism(0.0);
        let angles = mechanism.angles([0.0; 3]).expect("the middle of the workspace is within reach");
        let along = mechanism.jacobian(angles)[mechanism.joints() - 1];
        // An impulse along the direction, and what it does: joint rates, scaled to 1 m/s.
        let free = times(&inverse(&mechanism.mass_matrix(angles)), along);
        let mass = 1.0 / dot(along, free);
        let rates = scaled(free, mass);

        let mut slice = Self {
            name: device.name,
            mass,
            viscous: 0.0,
            coulomb: 0.0,
            resolution: 0.0,
            max_force: f64::from(device.preset.limits().force),
            time_constant: 0.0,
        };
        let joints = settings.joints.iter().zip(settings.encoders()).zip(device.preset.feeds());
        for (index, ((joint, encoder), feed)) in joints.enumerate() {
            let (constant, braking) = force_source(joint, feed, settings.current_time_constant);
            slice.viscous += (joint.viscous_friction + braking) * rates[index] * rates[index];
            slice.coulomb += joint.coulomb_friction * rates[index].abs();
            slice.resolution += (along[index] / encoder.counts_per_radian).abs();
            slice.time_constant = slice.time_constant.max(constant);
        }
        slice
    }

    /// The device's friction, as input of the library's bounds.
    pub fn friction(&self) -> DeviceFriction {
        DeviceFriction {
            viscous_n_s_per_m: self.viscous as f32,
            coulomb_n: self.coulomb as f32,
            resolution_m: self.resolution as f32,
        }
    }
}

/// The time constant of what feeds a joint, s, and how much of the motor's back-EMF is left to brake it, N·m·s.
fn force_source(joint: &JointSettings, feed: &Feed, current_loop: f64) -> (f64, f64) {
    match (joint.amplifier, feed) {
        (Amplifier::Voltage(winding), Feed::Voltage(feed)) => {
            let constant = joint.torque_constant * joint.ratio;
            let left = 1.0 - f64::from(feed.back_emf_fraction);
            (winding.inductance / winding.resistance, left * constant * constant / winding.resistance)
        }
        _ => (current_loop, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::{DEVICES, named};

    #[test]
    fn wooden_haptics_is_what_was_worked_out_from_its_drawing() {
        let slice = Slice::of(named("woodenhaptics-2016").unwrap());
        for (found, stated) in [
            (slice.mass, 0.0624),
            (slice.viscous, 0.018_51),
            (slice.coulomb, 0.0757),
            (slice.resolution, 57.6e-6),
            (slice.max_force, 5.0),
            (slice.time_constant, 1.5e-4),
        ] {
            // Stated to about three digits.
            assert!((found / stated - 1.0).abs() < 0.005, "{found} {stated}");
        }
    }

    #[test]
    fn the_paddle_is_a_lever() {
        let slice = Slice::of(named("hapkit").unwrap());
        let (handle, ratio) = (0.065_659_f64, 0.073_152_f64 / 0.004_191);
        let inertia = 1e-4 + 5e-7 * ratio * ratio;
        // A fifth of the back-EMF is left to brake; L/R = 1 mH / 10 Ω.
        let braking = 0.2 * (0.025 * ratio).powi(2) / 10.0;
        for (found, expected) in [
            (slice.mass, inertia / (handle * handle)),
            (slice.viscous, (2e-4 + braking) / (handle * handle)),
            (slice.coulomb, 2e-3 / handle),
            (slice.resolution, handle * std::f64::consts::PI / 18.0 / 726.6),
            (slice.time_constant, 1e-4),
        ] {
            // The preset's share is an f32.
            assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn no_slice_lacks_mass_or_friction() {
        for slice in DEVICES.iter().map(Slice::of) {
            assert!(slice.mass > 0.01 && slice.mass < 1.0, "{slice:?}");
            assert!(slice.viscous > 0.0 && slice.coulomb > 0.0 && slice.time_constant > 0.0, "{slice:?}");
            assert!(slice.resolution > 5e-6 && slice.resolution < 2e-4, "{slice:?}");
        }
    }
}
