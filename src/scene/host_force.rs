//! The host's own force in a scene, and its limit of the whole force.

use super::SceneError;
use super::limits::Limits;
use crate::math::Vec3;
use crate::render::limit;

/// Seconds for which a force of the host lasts. If it is not repeated within that time, it fades out.
pub const HOLD: f32 = 0.1;

/// A force from outside, which no body backs. It rises and falls at the scene's release rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HostForce {
    /// The requested force, N, and the ticks that are left of it.
    asked: Vec3,
    stands: u32,
    /// The part that is given now, N.
    given: Vec3,
    /// The requested maximum force of the whole scene, N, and the maximum now; infinite without a request.
    limit: f32,
    most: f32,
}

impl HostForce {
    /// Neither force nor limit.
    pub const NONE: Self =
        Self { asked: Vec3::ZERO, stands: 0, given: Vec3::ZERO, limit: f32::INFINITY, most: f32::INFINITY };

    /// Asks for a force, for [`HOLD`] seconds.
    pub fn push(&mut self, limits: &Limits, force: Vec3) -> Result<(), SceneError> {
        // Not finite is not within either.
        let is_within = force.length() <= limits.max_force_n;
        if is_within {
            // At most 10,000, at 100 kHz.
            (self.asked, self.stands) = (force, (HOLD * limits.rate_hz) as u32);
        }
        if is_within { Ok(()) } else { Err(SceneError::Force) }
    }

    /// Asks for another limit of all force.
    pub fn set_limit(&mut self, limits: &Limits, force: f32) -> Result<(), SceneError> {
        if !(force >= 0.0 && force <= limits.max_force_n) {
            return Err(SceneError::Force);
        }
        self.limit = force;
        // Two bodies and the host: more there never is.
        self.most = if self.most < f32::INFINITY { self.most } else { 3.0 * limits.max_force_n };
        Ok(())
    }

    /// The sum of the bodies' force and the host's, limited, where neither the host's nor the limit moves by more than
    /// `step` newtons.
    #[inline]
    pub fn step(&mut self, backed: Vec3, step: f32) -> Vec3 {
        if self.stands == 0 && self.given == Vec3::ZERO && self.most == f32::INFINITY {
            return backed;
        }
        self.add(backed, step)
    }

    #[inline(never)]
    fn add(&mut self, backed: Vec3, step: f32) -> Vec3 {
        let asked = if self.stands > 0 { self.asked } else { Vec3::ZERO };
        self.stands = self.stands.saturating_sub(1);
        self.given += limit::saturated(asked - self.given, step);
        if self.most == f32::INFINITY {
            return backed + self.given;
        }
        let rest = self.limit - self.most;
        self.most = if rest.abs() <= step { self.limit } else { self.most + step.copysign(rest) };
        limit::saturated(backed + self.given, self.most)
    }

    pub fn for_each_word(&self, mut take: impl FnMut(u32)) {
        let Self { asked, stands, given, limit, most } = *self;
        for number in asked.to_array().into_iter().chain(given.to_array()).chain([limit, most]) {
            take(number.to_bits());
        }
        take(stands);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    const LIMITS: Limits = Limits {
        max_stiffness_n_per_m: 1e3,
        max_damping_n_s_per_m: 5.0,
        max_force_n: 4.0,
        release_n_per_s: 80.0,
        rate_hz: 4_000.0,
        max_speed_m_per_s: 2.0,
    };
    /// What may change in a tick, N.
    const STEP: f32 = LIMITS.release_n_per_s / LIMITS.rate_hz;

    #[test]
    fn a_force_comes_stands_and_goes_without_a_step() {
        let mut host = HostForce::NONE;
        let backed = vec3(0.0, 0.0, 1.0);
        assert_eq!(host.step(backed, STEP), backed);
        host.push(&LIMITS, vec3(3.0, 0.0, 0.0)).unwrap();
        let (mut last, mut stood) = (backed, 0);
        for tick in 0..1_000 {
            let force = host.step(backed, STEP);
            // Rounding of some 3 N.
            assert!((force - last).length() <= STEP + 1e-6, "{tick}");
            stood += u32::from(force == backed + vec3(3.0, 0.0, 0.0));
            last = force;
        }
        // 3 N at 0.02 N a tick, both ways; what was asked for stands for 400 ticks.
        assert!((249..=252).contains(&stood), "{stood}");
        assert_eq!(last, backed);
    }

    #[test]
    fn a_limit_holds_all_of_it_and_comes_without_a_step() {
        let mut host = HostForce::NONE;
        let backed = vec3(0.0, 3.0, 0.0);
        host.set_limit(&LIMITS, 1.0).unwrap();
        let mut last = backed;
        for _ in 0..1_000 {
            host.push(&LIMITS, vec3(0.0, 4.0, 0.0)).unwrap();
            let force = host.step(backed, STEP);
            assert!((force - last).length() <= STEP + 1e-5, "{force} after {last}");
            last = force;
        }
        assert!((last.length() - 1.0).abs() < 1e-6, "{last}");
    }

    #[test]
    fn what_no_device_has_is_refused_and_changes_nothing() {
        let mut host = HostForce::NONE;
        for bad in [f32::NAN, f32::INFINITY, 4.1, -4.1] {
            assert_eq!(host.push(&LIMITS, vec3(0.0, bad, 0.0)), Err(SceneError::Force));
        }
        for bad in [f32::NAN, f32::INFINITY, 4.1, -0.1] {
            assert_eq!(host.set_limit(&LIMITS, bad), Err(SceneError::Force));
        }
        assert_eq!(host, HostForce::NONE);
    }
}
