//! The mechanism of the simulated device: a turntable that carries a parallelogram of two links.
//!
//! Written from the drawing in double precision and independently of the library's f32 kinematics, so that the two
//! check each other. Joint angles, radians: `a` turns the table about the vertical, `b` tilts the first link from the
//! vertical, `c` tilts the second link down from the horizontal (absolute, not relative to `b`).

use super::vector::{Matrix, Vector, difference};

/// A rigid link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// From its axis to the next one, m.
    pub length: f64,
    /// Mass, kg.
    pub mass: f64,
    /// From its axis to its centre of mass, m.
    pub centre: f64,
    /// Moment of inertia about the centre of mass, across the link, kg·m². About its own length a link has none.
    pub inertia: f64,
}

impl Link {
    /// A link whose inertia about its centre of mass is that of a uniform thin rod, `m L²/12`.
    pub const fn rod(length: f64, mass: f64, centre: f64) -> Self {
        Self { length, mass, centre, inertia: mass * length * length / 12.0 }
    }
}

/// Geometry and inertia of the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Height of the first link's axis, m.
    pub base_height: f64,
    /// The first link, upright at zero.
    pub first: Link,
    /// The second link, level at zero.
    pub second: Link,
    /// The origin of probe positions, m from the foot of the turntable.
    pub workspace_centre: Vector,
    /// Moment that counterweights and drums add to each link, kg·m; their inertia is in `joint_inertia`.
    pub balance: [f64; 2],
    /// Inertia that turns with each joint alone, kg·m²: the turntable, and each rotor seen through its transmission.
    pub joint_inertia: Vector,
    /// Mass that moves with the probe but is carried by the hand, so that gravity does not load the arm with it, kg.
    pub tip_mass: f64,
    /// Acceleration of free fall along −z, m/s².
    pub gravity: f64,
}

impl Arm {
    /// The probe's position, m from the workspace centre.
    #[inline]
    pub fn position(&self, [a, b, c]: Vector) -> Vector {
        let reach = self.first.length * b.sin() + self.second.length * c.cos();
        let height = self.base_height + self.first.length * b.cos() - self.second.length * c.sin();
        difference([reach * a.cos(), reach * a.sin(), height], self.workspace_centre)
    }

    /// `∂position/∂angles` by rows, m/rad.
    #[inline]
    pub fn jacobian(&self, [a, b, c]: Vector) -> Matrix {
        let (first, second) = (self.first.length, self.second.length);
        let reach = first * b.sin() + second * c.cos();
        let (reach_b, reach_c) = (first * b.cos(), -second * c.sin());
        [
            [-reach * a.sin(), reach_b * a.cos(), reach_c * a.cos()],
            [reach * a.cos(), reach_b * a.sin(), reach_c * a.sin()],
            [0.0, -first * b.sin(), -second * c.cos()],
        ]
    }

    /// The joint angles that put the probe at `position`, elbow up (`|b − c| ≤ π/2`); none if it is out of reach.
    ///
    /// With `r` and `h` the probe's reach and height over the first axis, `r² + h² = B² + C² + 2BC sin(b − c)`; and
    /// `(r, h)` is `(C + B sin(b − c), B cos(b − c))` turned down by `c`.
    pub fn angles(&self, position: Vector) -> Option<Vector> {
        let [x, y, z]: Vector = core::array::from_fn(|i| position[i] + self.workspace_centre[i]);
        let (first, second) = (self.first.length, self.second.length);
        let (reach, height) = ((x * x + y * y).sqrt(), z - self.base_height);
        let sine = (reach * reach + height * height - first * first - second * second) / (2.0 * first * second);
        if !(-1.0..=1.0).contains(&sine) {
            return None; // also where `sine` is NaN
        }
        let cosine = (1.0 - sine * sine).sqrt();
        let c = (first * cosine).atan2(second + first * sine) - height.atan2(reach);
        Some([y.atan2(x), c + sine.atan2(cosine), c])
    }

    /// Masses on the second link: (mass, distance from its axis, inertia about the centre).
    fn riders(&self) -> [(f64, f64, f64); 2] {
        [(self.second.mass, self.second.centre, self.second.inertia), (self.tip_mass, self.second.length, 0.0)]
    }

    /// The joint-space mass matrix, kg·m²: the kinetic energy is `½ q̇ᵀ M q̇`.
    #[inline]
    pub fn mass_matrix(&self, [_, b, c]: Vector) -> Matrix {
        let first = self.first.length;
        let about_axis = self.first.mass * self.first.centre * self.first.centre + self.first.inertia;
        let [mut aa, mut bb, mut cc] = self.joint_inertia;
        let mut bc = 0.0;
        aa += about_axis * b.sin() * b.sin();
        bb += about_axis;
        for (mass, distance, inertia) in self.riders() {
            let reach = first * b.sin() + distance * c.cos();
            aa += mass * reach * reach + inertia * c.cos() * c.cos();
            bb += mass * first * first;
            cc += mass * distance * distance + inertia;
            bc += mass * first * distance * (b - c).sin();
        }
        [[aa, 0.0, 0.0], [0.0, bb, bc], [0.0, bc, cc]]
    }

    /// Coriolis and centrifugal torques `Ṁ q̇ − ½ ∂(q̇ᵀ M q̇)/∂q`, N·m, on the left of the equation of motion.
    #[inline(always)]
    pub fn velocity_torques(&self, [_, b, c]: Vector, [rate_a, rate_b, rate_c]: Vector) -> Vector {
        let first = self.first.length;
        let about_axis = self.first.mass * self.first.centre * self.first.centre + self.first.inertia;
        // How M_aa grows with b and c, and M_bc with b (with c it is the opposite).
        let mut aa_b = 2.0 * about_axis * b.sin() * b.cos();
        let (mut aa_c, mut bc_b) = (0.0, 0.0);
        for (mass, distance, inertia) in self.riders() {
            let reach = first * b.sin() + distance * c.cos();
            aa_b += 2.0 * mass * reach * first * b.cos();
            aa_c -= 2.0 * (mass * reach * distance + inertia * c.cos()) * c.sin();
            bc_b += mass * first * distance * (b - c).cos();
        }
        [
            (aa_b * rate_b + aa_c * rate_c) * rate_a,
            -bc_b * rate_c * rate_c - 0.5 * aa_b * rate_a * rate_a,
            bc_b * rate_b * rate_b - 0.5 * aa_c * rate_a * rate_a,
        ]
    }

    /// Static moment of each link: mass times distance from its axis, kg·m.
    fn lifted(&self) -> [f64; 2] {
        let first = self.first.mass * self.first.centre + self.second.mass * self.first.length;
        let second = self.second.mass * self.second.centre;
        [first + self.balance[0], second + self.balance[1]]
    }

    /// The torques gravity puts on the joints, N·m, on the right of the equation of motion.
    #[inline]
    pub fn gravity_torques(&self, [_, b, c]: Vector) -> Vector {
        let [lifted_by_first, lifted_by_second] = self.lifted();
        [0.0, self.gravity * lifted_by_first * b.sin(), self.gravity * lifted_by_second * c.cos()]
    }

    /// Energy of height, J, zero where all masses lie level with the first axis.
    pub fn height_energy(&self, [_, b, c]: Vector) -> f64 {
        let [lifted_by_first, lifted_by_second] = self.lifted();
        self.gravity * (lifted_by_first * b.cos() - lifted_by_second * c.sin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Mechanism;
    use crate::plant::PlantSettings;
    use crate::plant::vector::{add_scaled, norm, scaled, times};

    fn arm() -> Arm {
        PlantSettings::wooden_haptics_2016().arm(0.05)
    }

    /// Joint angles over the whole joint range, and rates that mix signs.
    fn poses() -> impl Iterator<Item = (Vector, Vector)> {
        (0..1_000).map(|n| {
            let [i, j, k] = [n % 10, n / 10 % 10, n / 100].map(|index| f64::from(index) / 9.0);
            let rates = [3.0 - 6.0 * j, 5.0 * k - 2.0, 4.0 * i - 1.5];
            ([-1.6 + 3.2 * i, -0.8 + 3.0 * j, -1.2 + 3.0 * k], rates)
        })
    }

    #[test]
    fn angles_undo_position() {
        for (angles, _) in poses().filter(|([_, b, c], _)| (b - c).abs() < 1.5) {
            let reach = arm().first.length * angles[1].sin() + arm().second.length * angles[2].cos();
            if reach < 0.02 {
                continue; // beyond the turntable's axis the same point is reached by turning round
            }
            let found = arm().angles(arm().position(angles)).unwrap();
            // Rounding, 1e-16, over the cosine of b − c, at least 0.07, and the reach.
            assert!(norm(difference(found, angles)) < 1e-12, "{angles:?} {found:?}");
        }
        assert_eq!(arm().angles([0.3, 0.0, 0.0]), None);
        assert_eq!(arm().angles([f64::NAN, 0.0, 0.0]), None);
    }

    #[test]
    fn jacobian_is_the_derivative_of_position() {
        for (angles, rates) in poses() {
            let step = 1e-5;
            let [ahead, behind] = [step, -step].map(|h| arm().position(add_scaled(angles, rates, h)));
            let moved = scaled(difference(ahead, behind), 0.5 / step);
            let velocity = times(&arm().jacobian(angles), rates);
            // The difference is off by step²/6 times a third derivative of about 0.45 m × 8³ rad³/s³: 4e-9; rounding
            // 1e-11.
            assert!(norm(difference(moved, velocity)) < 1e-8, "{angles:?}");
        }
    }

    /// Kinetic energy of many small masses along each link, their velocities by differences of their positions.
    fn energy_of_particles(arm: &Arm, angles: Vector, rates: Vector) -> f64 {
        const COUNT: usize = 400;
        let step = 1e-5;
        // A point `distance` along the first or the second link.
        let place = |[a, b, c]: Vector, on_second: bool, distance: f64| {
            let along_first = if on_second { arm.first.length } else { distance };
            let along_second = if on_second { distance } else { 0.0 };
            let radius = along_first * b.sin() + along_second * c.cos();
            [radius * a.cos(), radius * a.sin(), along_first * b.cos() - along_second * c.sin()]
        };
        let energy = |mass: f64, on_second: bool, distance: f64| {
            let [ahead, behind] = [step, -step].map(|h| place(add_scaled(angles, rates, h), on_second, distance));
            let speed = norm(difference(ahead, behind)) / (2.0 * step);
            0.5 * mass * speed * speed
        };
        let mut sum = energy(arm.tip_mass, true, arm.second.length);
        for (joint, inertia) in arm.joint_inertia.into_iter().enumerate() {
            sum += 0.5 * inertia * rates[joint] * rates[joint];
        }
        for (on_second, link) in [(false, arm.first), (true, arm.second)] {
            // A rod of the link's length, centred on its centre of mass.
            for index in 0..COUNT {
                let offset = ((index as f64 + 0.5) / COUNT as f64 - 0.5) * link.length;
                sum += energy(link.mass / COUNT as f64, on_second, link.centre + offset);
            }
        }
        sum
    }

    #[test]
    fn mass_matrix_gives_the_energy_of_the_moving_particles() {
        for (angles, rates) in poses().step_by(7) {
            let (closed, summed) = (arm().kinetic_energy(angles, rates), energy_of_particles(&arm(), angles, rates));
            // COUNT particles stand for a rod to 1/COUNT² = 6e-6 of its own inertia.
            assert!((closed / summed - 1.0).abs() < 1e-5, "{angles:?} {closed} {summed}");
        }
    }

    #[test]
    fn velocity_torques_follow_from_the_mass_matrix() {
        for (angles, rates) in poses() {
            let step = 1e-6;
            let momentum = |h: f64| times(&arm().mass_matrix(add_scaled(angles, rates, h)), rates);
            let drift = scaled(difference(momentum(step), momentum(-step)), 0.5 / step);
            let expected: Vector = core::array::from_fn(|joint| {
                let mut unit = [0.0; 3];
                unit[joint] = 1.0;
                let energy = |h: f64| arm().kinetic_energy(add_scaled(angles, unit, h), rates);
                drift[joint] - (energy(step) - energy(-step)) / (2.0 * step)
            });
            // Rounding of energies of 0.1 J over the step: 1e-11; truncation is of the same order.
            assert!(norm(difference(arm().velocity_torques(angles, rates), expected)) < 1e-9, "{angles:?}");
        }
    }

    #[test]
    fn gravity_torques_follow_from_the_energy_of_height() {
        for (angles, _) in poses() {
            for joint in 0..3 {
                let mut unit = [0.0; 3];
                unit[joint] = 1.0;
                let energy = |h: f64| arm().height_energy(add_scaled(angles, unit, h));
                let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
                // Rounding of 0.3 J over the step.
                assert!((arm().gravity_torques(angles)[joint] + slope).abs() < 1e-10);
            }
        }
    }
}
