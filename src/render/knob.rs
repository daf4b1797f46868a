//! Forces for a device with one joint: detents and end walls. Angles and torques, or lengths and forces: any consistent
//! pair.

/// Detents at every `pitch`, numbered from `first` to `last`, with a wall beyond either end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Detents {
    /// From one detent to the next, m; rad on a dial.
    pub pitch: f32,
    /// Force per distance from the detent, N/m; N·m/rad on a dial.
    pub stiffness: f32,
    /// Force per speed, N·s/m; N·m·s/rad on a dial.
    pub damping: f32,
    /// How far out of a detent the next one takes over, in pitches: ½, or more for a click that stays put (hysteresis).
    pub snap: f32,
    /// Number of the first detent; detent 0 is at position 0.
    pub first: i32,
    /// Number of the last detent.
    pub last: i32,
    /// Force per distance beyond the first and the last, N/m; N·m/rad on a dial.
    pub wall_stiffness: f32,
    /// Maximum force, N; maximum torque, N·m, on a dial.
    pub max_force: f32,
}

/// Which parameter is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DetentsError {
    /// The pitch is not positive and finite.
    #[error("the pitch must be positive and finite")]
    Pitch,
    /// A stiffness, the damping or the maximum force is negative or not finite.
    #[error("stiffnesses, damping and maximum force must be finite and not negative")]
    Force,
    /// The snap is not between ½ and 1.
    #[error("the snap must be between one half and one pitch")]
    Snap,
    /// The first detent comes after the last.
    #[error("the first detent must not come after the last")]
    Order,
}

impl Detents {
    /// Checks the parameters.
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn try_new(self) -> Result<Self, DetentsError> {
        if !(self.pitch > 0.0 && self.pitch < f32::INFINITY) {
            return Err(DetentsError::Pitch);
        }
        let forces = [self.stiffness, self.damping, self.wall_stiffness, self.max_force];
        let mut index = 0;
        while index < forces.len() {
            if !(forces[index] >= 0.0 && forces[index] < f32::INFINITY) {
                return Err(DetentsError::Force);
            }
            index += 1;
        }
        if !(self.snap >= 0.5 && self.snap <= 1.0) {
            return Err(DetentsError::Snap);
        }
        if self.first > self.last { Err(DetentsError::Order) } else { Ok(self) }
    }

    /// The force, N, at a position, m, and velocity, m/s; on a dial the torque, N·m, at an angle, rad, and rate, rad/s.
    /// Writes the detent it is in (`detent` is the last one). Not more than `max_force` either way; 0 where an input is
    /// not finite.
    #[inline]
    pub fn force(&self, detent: &mut i32, position: f32, velocity: f32) -> f32 {
        let distance = |detent: i32| position - detent as f32 * self.pitch;
        if distance(*detent).abs() > self.snap * self.pitch {
            let turns = position / self.pitch;
            let nearest = (turns + if turns < 0.0 { -0.5 } else { 0.5 }) as i32;
            // Not `clamp`, which panics where the constructor was passed by.
            let nearest = if nearest < self.first { self.first } else { nearest };
            *detent = if nearest > self.last { self.last } else { nearest };
        }
        let away = distance(*detent);
        let beyond = (*detent == self.first && away < 0.0) || (*detent == self.last && away > 0.0);
        let stiffness = if beyond { self.wall_stiffness } else { self.stiffness };
        let force = -stiffness * away - self.damping * velocity;
        if force.is_finite() { crate::math::saturate(force, -self.max_force, self.max_force) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIAL: Detents = Detents {
        pitch: 0.2,
        stiffness: 0.5,
        damping: 0.0,
        snap: 0.6,
        first: -3,
        last: 3,
        wall_stiffness: 2.0,
        max_force: 0.3,
    };

    #[test]
    fn it_holds_each_detent_until_it_snaps() {
        let mut detent = 0;
        assert_eq!(DIAL.force(&mut detent, 0.05, 0.0), -0.025);
        // 0.119 is beyond the half and short of 0.6 pitches.
        assert!((DIAL.force(&mut detent, 0.119, 0.0) + 0.0595).abs() < 1e-6 && detent == 0);
        assert!((DIAL.force(&mut detent, 0.121, 0.0) - 0.0395).abs() < 1e-6 && detent == 1);
        // On the way back the first detent takes over later.
        assert!(DIAL.force(&mut detent, 0.09, 0.0) > 0.0 && detent == 1);
        DIAL.force(&mut detent, 0.079, 0.0);
        assert_eq!(detent, 0);
    }

    #[test]
    fn the_ends_are_walls_and_nothing_exceeds_the_greatest_force() {
        let mut detent = 0;
        assert!((DIAL.force(&mut detent, 0.7, 0.0) + 0.2).abs() < 1e-6 && detent == 3);
        assert_eq!(DIAL.force(&mut detent, 1e30, 0.0), -0.3);
        assert_eq!(DIAL.force(&mut detent, -1e30, 0.0), 0.3);
        assert_eq!(detent, -3);
        for (position, velocity) in [(f32::NAN, 0.0), (0.0, f32::NAN), (f32::INFINITY, 0.0), (0.0, f32::NEG_INFINITY)] {
            assert_eq!(Detents { damping: 1.0, ..DIAL }.force(&mut detent, position, velocity), 0.0);
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused_by_name() {
        assert_eq!(DIAL.try_new(), Ok(DIAL));
        assert_eq!(Detents { pitch: f32::NAN, ..DIAL }.try_new(), Err(DetentsError::Pitch));
        assert_eq!(Detents { damping: -1.0, ..DIAL }.try_new(), Err(DetentsError::Force));
        assert_eq!(Detents { snap: 0.4, ..DIAL }.try_new(), Err(DetentsError::Snap));
        assert_eq!(Detents { first: 4, ..DIAL }.try_new(), Err(DetentsError::Order));
    }
}
