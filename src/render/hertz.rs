//! Local compliance: the dent of a contact that is small beside the body, as a spring of the penalty.

use crate::math::{cube_root, sqrt, square_root};

/// Hertz's contact of a ball and an elastic half-space, without adhesion: `f = 4/3 E* √R d^1.5`, a potential.
///
/// `E*` is of both: `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`. The stiffness rises with the depth; the loop's is that at the
/// maximum force, so that the check of a wall's stiffness refuses one that the device does not bear:
///
/// ```
/// use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
/// use palpate::render::Hertz;
/// use palpate::servo::{Settings, SettingsError};
///
/// // A finger's tip, a ball of 8 mm, on foam of 50 kPa and on rubber of 5 MPa.
/// let settings = |contact: Hertz| Settings {
///     stiffness_n_per_m: contact.steepest_n_per_m(Settings::DEFAULT.max_force_n),
///     ..Settings::DEFAULT
/// };
/// let check = |contact| settings(contact).check(DEVICE.max_stiffness_n_per_m, DEVICE.max_damping_n_s_per_m);
/// assert_eq!(check(Hertz::new(5e4, 0.008)), Ok(()));
/// assert_eq!(check(Hertz::new(5e6, 0.008)), Err(SettingsError::Stiffness));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    modulus_pa: f32,
    radius_m: f32,
    /// `2 E* √R`, N/m^1.5.
    slope: f32,
}

impl Hertz {
    /// Of a modulus `E*`, Pa, and a ball's radius, metres. Unless both are above 0 and finite its stiffness is no number,
    /// which no check of a wall takes.
    pub const fn new(modulus_pa: f32, radius_m: f32) -> Self {
        let is_valid = modulus_pa > 0.0 && modulus_pa < f32::INFINITY && radius_m > 0.0 && radius_m < f32::INFINITY;
        let modulus_pa = if is_valid { modulus_pa } else { f32::NAN };
        Self { modulus_pa, radius_m, slope: 2.0 * modulus_pa * square_root(radius_m) }
    }

    /// The stiffness at a force, N/m, the steepest of all weaker ones: `∛(6 E*² R f)`.
    pub const fn steepest_n_per_m(&self, force_n: f32) -> f32 {
        cube_root(6.0 * self.modulus_pa * self.radius_m * force_n * self.modulus_pa)
    }

    /// The stiffness of a flat punch, N/m, of this radius, metres, on a modulus `E*`, Pa: `2 E* a`, that of a wall.
    pub const fn flat_punch_n_per_m(modulus_pa: f32, radius_m: f32) -> f32 {
        2.0 * modulus_pa * radius_m
    }

    /// Force, N, and stiffness, N/m, at a depth, metres: up to a maximum stiffness, and from there on straight.
    #[inline]
    pub fn at(&self, depth_m: f32, max_stiffness_n_per_m: f32) -> [f32; 2] {
        if depth_m <= 0.0 {
            return [0.0; 2];
        }
        let most = max_stiffness_n_per_m;
        let slope = self.slope * sqrt(depth_m);
        if slope <= most {
            return [2.0 / 3.0 * slope * depth_m, slope];
        }
        let bend = most / self.slope;
        [most * (depth_m - 1.0 / 3.0 * bend * bend), most]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Foam, rubber and a hard plastic under balls of 2 mm to 50 mm.
    const CONTACTS: [(f32, f32); 4] = [(5e4, 0.008), (2e5, 0.002), (5e6, 0.05), (2e9, 0.004)];

    #[test]
    fn force_and_stiffness_are_hertz_s() {
        for (modulus, radius) in CONTACTS {
            let contact = Hertz::new(modulus, radius);
            let [e, r] = [modulus, radius].map(f64::from);
            for depth in [1e-6_f32, 1e-5, 3e-4, 2e-3, 0.01] {
                let [force, slope] = contact.at(depth, f32::INFINITY).map(f64::from);
                let d = f64::from(depth);
                let expected = 4.0 / 3.0 * e * r.sqrt() * d.powf(1.5);
                // Roundings of two roots and three products.
                assert!((force / expected - 1.0).abs() < 1e-6, "{modulus} Pa, {depth} m: {force} N, {expected} N");
                assert!((slope / (1.5 * expected / d) - 1.0).abs() < 1e-6, "{modulus} Pa, {depth} m: {slope} N/m");
                // The steepest within a force is that at the force.
                let steepest = f64::from(contact.steepest_n_per_m(force as f32));
                assert!((steepest / slope - 1.0).abs() < 1e-6, "{modulus} Pa, {depth} m: {steepest}, {slope} N/m");
            }
        }
        assert!((Hertz::flat_punch_n_per_m(5e4, 0.005) - 500.0).abs() < 1e-3);
    }

    /// From the closed form of the energy, by Simpson's rule over ever deeper thirds; the bend is one of the borders.
    #[test]
    fn its_work_is_the_potential_and_beyond_the_limit_it_goes_on_straight() {
        for (modulus, radius) in CONTACTS {
            let contact = Hertz::new(modulus, radius);
            let [e, r] = [modulus, radius].map(f64::from);
            // The limit is met at 1 mm.
            let most = contact.at(1e-3, f32::INFINITY)[1];
            let potential = |d: f64| 8.0 / 15.0 * e * r.sqrt() * d.powf(2.5);
            let force = |d: f64| f64::from(contact.at(d as f32, most)[0]);
            let mut work = potential(1e-6);
            let steps = 3_000;
            for step in 0..steps {
                let [low, high] = [step, step + 1].map(|step| 1e-6 * 1e3_f64.powf(f64::from(step) / f64::from(steps)));
                work += (high - low) / 6.0 * (force(low) + 4.0 * force(0.5 * (low + high)) + force(high));
            }
            assert!((work / potential(1e-3) - 1.0).abs() < 1e-6, "{modulus} Pa: {work} J, {} J", potential(1e-3));
            let beyond = force(1e-3) + f64::from(most) * 2e-3;
            assert!((force(3e-3) / beyond - 1.0).abs() < 1e-6, "{modulus} Pa: {} N, {beyond} N", force(3e-3));
            assert_eq!(contact.at(3e-3, most)[1], most);
        }
    }

    #[test]
    fn what_is_no_contact_has_no_stiffness() {
        for (modulus, radius) in
            [(0.0, 0.01), (-1.0, 0.01), (f32::NAN, 0.01), (1e5, 0.0), (1e5, -1.0), (1e5, f32::INFINITY)]
        {
            assert!(Hertz::new(modulus, radius).steepest_n_per_m(5.0).is_nan(), "{modulus} {radius}");
        }
        assert_eq!(Hertz::new(1e5, 0.01).at(0.0, 1e3), [0.0; 2]);
        assert_eq!(Hertz::new(1e5, 0.01).at(-1.0, 1e3), [0.0; 2]);
        assert_eq!(Hertz::new(1e5, 0.01).steepest_n_per_m(0.0), 0.0);
    }
}
