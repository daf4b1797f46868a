//! A device along one direction: what a wall's push has to move.

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
    /// The greatest force, N.
    pub greatest_force: f64,
    /// Time constant of the force source, s.
    pub time_constant: f64,
}

impl Slice {
    /// WoodenHaptics 2016 at the centre of its workspace, along the vertical: what the plant's mass matrix, friction
    /// and encoders come to for a wall's push that nothing guides sideways, which is the lightest the probe can be. The
    /// resolution is that of both links together.
    pub const WOODEN_HAPTICS_2016: Self = Self {
        name: "wooden-haptics-2016",
        mass: 0.0624,
        viscous: 0.018_51,
        coulomb: 0.0757,
        resolution: 57.6e-6,
        greatest_force: 5.0,
        time_constant: 1.5e-4,
    };

    /// Hapkit, at the handle. Published: 16 µm, 8 N. Assumed: 50 g at the handle (sector, handle and a small motor's
    /// rotor through 17:1), 0.1 N·s/m and 0.3 N of friction, a voltage drive with an electrical time constant of 0.2
    /// ms.
    pub const HAPKIT: Self = Self {
        name: "hapkit",
        mass: 0.050,
        viscous: 0.1,
        coulomb: 0.3,
        resolution: 16e-6,
        greatest_force: 8.0,
        time_constant: 2e-4,
    };

    /// Novint Falcon. Published: friction 1.2 N along two axes, 38–65 µm, 8 N. Assumed: 0.2 kg, 1 N·s/m (20 N·s/m of
    /// wall damping are in use on it), a drive of 0.2 ms.
    pub const FALCON: Self = Self {
        name: "falcon",
        mass: 0.2,
        viscous: 1.0,
        coulomb: 1.2,
        resolution: 50e-6,
        greatest_force: 8.0,
        time_constant: 2e-4,
    };

    /// Every slice.
    pub const ALL: [Self; 3] = [Self::WOODEN_HAPTICS_2016, Self::HAPKIT, Self::FALCON];

    /// The slice of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|slice| slice.name == name)
    }

    /// What the library's bounds want to know.
    pub fn friction(&self) -> DeviceFriction {
        DeviceFriction {
            viscous: self.viscous as f32,
            coulomb: self.coulomb as f32,
            resolution: self.resolution as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Mechanism as _;
    use crate::plant::{PlantSettings, Vector};

    /// Solves the 3 × 3 system by elimination.
    fn solve(mut m: [[f64; 3]; 3], mut b: Vector) -> Vector {
        for i in 0..3 {
            let pivot = (i..3).max_by(|p, q| m[*p][i].abs().total_cmp(&m[*q][i].abs())).unwrap();
            m.swap(i, pivot);
            b.swap(i, pivot);
            for row in 0..3 {
                if row != i {
                    let factor = m[row][i] / m[i][i];
                    let pivot_row = m[i];
                    m[row].iter_mut().zip(pivot_row).for_each(|(entry, above)| *entry -= factor * above);
                    b[row] -= factor * b[i];
                }
            }
        }
        core::array::from_fn(|i| b[i] / m[i][i])
    }

    #[test]
    fn wooden_haptics_is_what_the_plant_comes_to() {
        let settings = PlantSettings::wooden_haptics_2016();
        let arm = settings.arm(0.0);
        let angles = arm.angles([0.0; 3]).unwrap();
        let jacobian = arm.jacobian(angles);
        // What an impulse along z does when nothing guides the probe sideways: joint rates, scaled to 1 m/s along z.
        let impulse = [0, 1, 2].map(|joint| jacobian[2][joint]);
        let rates = solve(arm.mass_matrix(angles), impulse);
        let speed: f64 = (0..3).map(|joint| jacobian[2][joint] * rates[joint]).sum();
        let rates = rates.map(|rate| rate / speed);
        let mass = 2.0 * arm.kinetic_energy(angles, rates);
        let viscous: f64 = (0..3).map(|j| settings.joints[j].viscous_friction * rates[j] * rates[j]).sum();
        let coulomb: f64 = (0..3).map(|j| settings.joints[j].coulomb_friction * rates[j].abs()).sum();
        let resolution: f64 = (0..3).map(|j| (jacobian[2][j] / settings.encoders()[j].counts_per_radian).abs()).sum();
        let slice = Slice::WOODEN_HAPTICS_2016;
        for (found, stated) in [
            (mass, slice.mass),
            (viscous, slice.viscous),
            (coulomb, slice.coulomb),
            (resolution, slice.resolution),
            (settings.current_time_constant, slice.time_constant),
        ] {
            // Stated to about three digits.
            assert!((found / stated - 1.0).abs() < 0.005, "{found} {stated}");
        }
    }
}
