//! A device along one direction: what a wall's push has to move.

use crate::devices::ShippedDevice;
use crate::plant::{Amplifier, JointSettings, Vector, dot, inverse, scaled, times};
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
    /// Mass, friction and encoders are the simulated device's for a push that nothing guides sideways. Other
    /// directions may hold less: [`Self::weakest`]. The resolution is that of all joints together. On a bridge, back-EMF
    /// brakes as far as the preset does not make up for it. Limits are the preset's.
    ///
    /// # Panics
    /// If the device cannot be at the middle of its own workspace.
    pub fn of(device: &ShippedDevice) -> Self {
        let mut direction = [0.0; 3];
        direction[Self::axis(device)] = 1.0;
        Self::along(device, [0.0; 3], direction).expect("the middle of the workspace is within reach")
    }

    /// The index of the axis of [`Self::of`].
    pub fn axis(device: &ShippedDevice) -> usize {
        device.plant.mechanism(0.0).joints() - 1
    }

    /// The same at a position, m, along a unit vector; `None` out of reach, or where the device fades its force out.
    pub fn along(device: &ShippedDevice, position: Vector, direction: Vector) -> Option<Self> {
        let settings = device.plant;
        let mechanism = settings.mechanism(0.0);
        let angles = mechanism.angles(position)?;
        let is_within = |(joint, angle): (&JointSettings, &f64)| joint.stops[0] <= *angle && *angle <= joint.stops[1];
        if !settings.joints.iter().zip(&angles).take(mechanism.joints()).all(is_within)
            || device.preset.room(angles) < 1.0
        {
            return None;
        }
        let rows = mechanism.jacobian(angles);
        // Joint rates of a unit force along the direction, by its torques.
        let along: Vector = std::array::from_fn(|joint| (0..3).map(|axis| direction[axis] * rows[axis][joint]).sum());
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
        Some(slice)
    }

    /// Where an undamped wall of a device is weakest: position, direction and slice, over a grid of 30 mm and the 13
    /// directions to the sides, edges and corners of a cube.
    ///
    /// Ordered by the Coulomb friction's work in a swing of a count, against that of a delayed spring: the stiffness at
    /// which both are equal rises with `friction · √mass / count`.
    pub fn weakest(device: &ShippedDevice) -> Option<(Vector, Vector, Self)> {
        let joints = device.plant.mechanism(0.0).joints();
        let steps = |axis: usize, most: i32| if axis < joints { -most..=most } else { 0..=0 };
        let grid = |most: i32| {
            let x = steps(0, most).flat_map(move |x| steps(1, most).map(move |y| [x, y]));
            x.flat_map(move |[x, y]| steps(2, most).map(move |z| [x, y, z].map(f64::from)))
        };
        // One of each pair of opposite directions: the first number that is not zero is positive.
        let is_forward = |way: &Vector| way.iter().find(|number| **number != 0.0).is_some_and(|first| *first > 0.0);
        let directions: Vec<Vector> =
            grid(1).filter(is_forward).map(|way| scaled(way, dot(way, way).sqrt().recip())).collect();
        let all = grid(5).flat_map(|place| directions.iter().map(move |way| (scaled(place, 0.03), *way)));
        let known = all.filter_map(|(place, way)| Some((place, way, Self::along(device, place, way)?)));
        let rank = |slice: &Self| slice.coulomb * slice.mass.sqrt() / slice.resolution;
        known.min_by(|(.., one), (.., other)| rank(one).total_cmp(&rank(other)))
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
    use crate::devices::{BridgeEntry, DEVICES, OwnDevice, named, own_device};
    use crate::zwidth::{Loop, max_stiffness};
    use palpate::device::VelocityMethod;

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

    /// The stiffest walls that come to rest, with 0, 2 and 8 N·s/m, of an arm in MuJoCo: 16 to 32 kHz physics, a loop of 4 kHz
    /// with one period of delay. That arm also leaves its line, which a slice cannot: up to 14 % of its limit.
    #[test]
    fn the_walls_of_wooden_haptics_are_those_of_mujoco_in_each_direction() {
        let device = named("woodenhaptics-2016").unwrap();
        let servo =
            Loop { rate: 4_000.0, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };
        for (way, stiffest) in [
            ([1.0, 0.0, 0.0], [696.0, 4_948.0, 11_797.0]),
            ([0.0, 1.0, 0.0], [930.0, 5_290.0, 14_099.0]),
            ([0.0, 0.0, 1.0], [1_736.0, 6_183.0, 14_742.0]),
        ] {
            let slice = Slice::along(device, [0.0; 3], way).unwrap();
            for (damping, wanted) in [0.0, 2.0, 8.0].into_iter().zip(stiffest) {
                let found = max_stiffness(&slice, damping, &servo);
                println!("{way:?}, {damping} N·s/m: {found:.0} N/m, {wanted} in MuJoCo");
                assert!((0.98..1.14).contains(&(found / wanted)), "{way:?} {damping}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn the_weakest_direction_of_a_device_is_weaker_than_any_at_the_middle_of_its_workspace() {
        let servo =
            Loop { rate: 4_000.0, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };
        for device in DEVICES.iter().filter(|device| device.preset.feeds().len() > 1) {
            let undamped = |slice: &Slice| max_stiffness(slice, 0.0, &servo);
            let (place, way, slice) = Slice::weakest(device).unwrap();
            println!("{}: {:.0} N/m at {place:?} along {way:?}", device.name, undamped(&slice));
            for axis in 0..device.preset.feeds().len() {
                let mut way = [0.0; 3];
                way[axis] = 1.0;
                let middle = Slice::along(device, [0.0; 3], way).unwrap();
                // To two steps of the search.
                assert!(
                    undamped(&slice) <= 1.04 * undamped(&middle),
                    "{}: axis {axis}: {}",
                    device.name,
                    undamped(&middle)
                );
            }
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
    fn a_bridge_of_a_file_delays_by_the_inductance_that_it_states() {
        let mut file = named("woodenhaptics-2016").and_then(|device| device.file()).unwrap();
        for (stated, inductance) in [(None, 1e-3), (Some(1.2e-4), 1.2e-4)] {
            for joint in &mut file.joint {
                joint.motor.bridge =
                    Some(BridgeEntry { supply: 24.0, resistance: 0.7, inductance: stated, back_emf_share: 0.8 });
            }
            let own = OwnDevice::new(file.clone(), "arm.toml").unwrap();
            let slice = Slice::of(own_device(&own, ""));
            let servo = Loop {
                rate: 4_000.0,
                delay_periods: 1.0,
                velocity: VelocityMethod::LowPass,
                corner: 200.0,
                ease: None,
            };
            // b/(T/2 + d + L/R).
            let bound = slice.viscous / (1.25e-4 + 2.5e-4 + inductance / 0.7);
            let found = servo.passive_stiffness(&slice, 0.0);
            println!("{inductance} H: passive to {found:.0} N/m");
            assert!((found / bound - 1.0).abs() < 1e-6, "{found} {bound}");
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
