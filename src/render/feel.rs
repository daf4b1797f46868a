//! The feel of a dial: the sum of detents, clicks, a texture, a spring and end stops.

use super::Detents;
use crate::math::{saturate, sin_cos};
use core::f32::consts::TAU;

/// A torque that repeats with every pitch: `−T sin(2π (θ − centre)/pitch)`. A coarse one is detents, a fine one a
/// texture. It comes from a potential: turned there and back it returns the energy that it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// From one detent to the next, radians.
    pub pitch_rad: f32,
    /// Maximum torque, `T`, a quarter of a pitch from a detent, N·m.
    pub torque_n_m: f32,
    /// Where one of the detents is, radians.
    pub centre_rad: f32,
}

/// A spring that turns the dial back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// N·m/rad.
    pub stiffness_n_m_per_rad: f32,
    /// Where it is at rest, radians.
    pub rest_rad: f32,
    /// Maximum torque, N·m: beyond, it is constant.
    pub max_torque_n_m: f32,
}

/// End stops: a spring and a damper beyond either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// Where they are, radians.
    pub between_rad: [f32; 2],
    /// N·m/rad.
    pub stiffness_n_m_per_rad: f32,
    /// N·m·s/rad; it only pushes, never holds.
    pub damping_n_m_s_per_rad: f32,
}

/// The feel of a dial. Its parts add up; start with [`Feel::FREE`]. Constant, in flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feel {
    /// Detents that one turns through smoothly.
    pub detents: Option<Wave>,
    /// Detents that snap, with hysteresis.
    pub clicks: Option<Detents>,
    /// Texture between detents.
    pub texture: Option<Wave>,
    /// A spring.
    pub spring: Option<Spring>,
    /// End stops.
    pub ends: Option<Ends>,
    /// Damping everywhere, N·m·s/rad.
    pub damping_n_m_s_per_rad: f32,
}

/// Which part of a feel is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeelError {
    /// A pitch that is not positive, or a number that is not finite.
    Detents,
    /// See [`super::DetentsError`].
    Clicks,
    /// As detents.
    Texture,
    /// A number that is negative or not finite.
    Spring,
    /// Ends that are not in order, or a number that is negative or not finite.
    Ends,
    /// A damping that is negative or not finite.
    Damping,
}

impl FeelError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Detents => "detents need a positive pitch, and a torque that is finite and not negative",
            Self::Clicks => "clicks need a positive pitch, finite forces, and detents in order",
            Self::Texture => "a texture needs a positive pitch, and a torque that is finite and not negative",
            Self::Spring => {
                "a spring needs a finite rest, a stiffness and a maximum torque that are finite and not negative"
            }
            Self::Ends => "end stops must be in order, with a stiffness and a damping that are finite and not negative",
            Self::Damping => "the damping must be finite and not negative",
        }
    }
}

crate::message::display!(FeelError);

/// Whether `0 ≤ x < ∞`; false for NaN.
const fn is_size(x: f32) -> bool {
    x >= 0.0 && x < f32::INFINITY
}

impl Wave {
    const fn is_valid(&self) -> bool {
        self.pitch_rad > 0.0
            && self.pitch_rad < f32::INFINITY
            && is_size(self.torque_n_m)
            && self.centre_rad.is_finite()
    }

    /// The torque at an angle, radians, N·m.
    #[inline]
    pub fn at(&self, angle: f32) -> f32 {
        self.at_after(0, angle)
    }

    /// The torque at an angle, radians, after whole turns, N·m.
    #[inline]
    fn at_after(&self, turns: i32, angle: f32) -> f32 {
        let mut pitches = (angle - self.centre_rad) / self.pitch_rad;
        if turns != 0 {
            pitches += self.phase_after(turns);
        }
        // The fraction of a pitch: the cast saturates.
        let (sine, _) = sin_cos((pitches - pitches as i32 as f32) * TAU);
        -self.torque_n_m * sine
    }

    /// The part of a pitch by which whole turns shift the wave: an integer product, which has no rounding to grow with
    /// the turns.
    #[inline(never)]
    fn phase_after(&self, turns: i32) -> f32 {
        let per_turn = TAU / self.pitch_rad;
        // The casts saturate.
        let part = per_turn - (per_turn + 0.5) as i32 as f32;
        // A whole number of pitches a turn, but for the rounding of the pitch, is meant to be one.
        let is_a_part = part.abs() > 4e-7 * per_turn;
        if !is_a_part {
            return 0.0;
        }
        let part = (part * 4_294_967_296.0) as i32;
        part.wrapping_mul(turns) as f32 * (1.0 / 4_294_967_296.0)
    }

    /// The steepest rise of the torque, N·m/rad.
    const fn stiffness(&self) -> f32 {
        self.torque_n_m * TAU / self.pitch_rad
    }
}

impl Feel {
    /// Nothing.
    pub const FREE: Self =
        Self { detents: None, clicks: None, texture: None, spring: None, ends: None, damping_n_m_s_per_rad: 0.0 };

    /// Checks the parts.
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self) -> Result<(), FeelError> {
        if let Some(wave) = &self.detents
            && !wave.is_valid()
        {
            return Err(FeelError::Detents);
        }
        if let Some(clicks) = self.clicks
            && clicks.try_new().is_err()
        {
            return Err(FeelError::Clicks);
        }
        if let Some(wave) = &self.texture
            && !wave.is_valid()
        {
            return Err(FeelError::Texture);
        }
        if let Some(Spring { stiffness_n_m_per_rad: stiffness, rest_rad: rest, max_torque_n_m: most }) = self.spring
            && !(is_size(stiffness) && is_size(most) && rest.is_finite())
        {
            return Err(FeelError::Spring);
        }
        if let Some(Ends {
            between_rad: [least, most],
            stiffness_n_m_per_rad: stiffness,
            damping_n_m_s_per_rad: damping,
        }) = self.ends
            && !(least < most && least.is_finite() && most.is_finite() && is_size(stiffness) && is_size(damping))
        {
            return Err(FeelError::Ends);
        }
        if is_size(self.damping_n_m_s_per_rad) { Ok(()) } else { Err(FeelError::Damping) }
    }

    /// The maximum total stiffness, N·m/rad.
    pub const fn stiffness(&self) -> f32 {
        let mut sum = 0.0;
        if let Some(wave) = &self.detents {
            sum += wave.stiffness();
        }
        if let Some(wave) = &self.texture {
            sum += wave.stiffness();
        }
        if let Some(clicks) = &self.clicks {
            sum += if clicks.wall_stiffness > clicks.stiffness { clicks.wall_stiffness } else { clicks.stiffness };
        }
        if let Some(spring) = &self.spring {
            sum += spring.stiffness_n_m_per_rad;
        }
        if let Some(ends) = &self.ends {
            sum += ends.stiffness_n_m_per_rad;
        }
        sum
    }

    /// The maximum total damping, N·m·s/rad.
    pub const fn greatest_damping(&self) -> f32 {
        let mut sum = self.damping_n_m_s_per_rad;
        if let Some(clicks) = &self.clicks {
            sum += clicks.damping;
        }
        if let Some(ends) = &self.ends {
            sum += ends.damping_n_m_s_per_rad;
        }
        sum
    }

    /// The maximum torque between the end stops, N·m, without damping.
    pub const fn torque_between_ends(&self) -> f32 {
        let mut sum = 0.0;
        if let Some(wave) = &self.detents {
            sum += wave.torque_n_m;
        }
        if let Some(wave) = &self.texture {
            sum += wave.torque_n_m;
        }
        if let Some(clicks) = &self.clicks {
            sum += clicks.max_force;
        }
        if let Some(spring) = &self.spring {
            sum += spring.max_torque_n_m;
        }
        sum
    }

    /// The torque at an angle (radians) and a rate (rad/s), N·m. `click` is the detent that was clicked into last. Not
    /// limited as a whole.
    #[inline]
    pub fn torque(&self, click: &mut i32, angle: f32, rate: f32) -> f32 {
        self.torque_after(0, click, angle, rate)
    }

    /// The same after whole turns of the dial, which are no part of the angle: waves stay as precise as in the first
    /// turn.
    #[inline]
    pub fn torque_after(&self, turns: i32, click: &mut i32, angle: f32, rate: f32) -> f32 {
        let mut torque = -self.damping_n_m_s_per_rad * rate;
        if let Some(wave) = &self.detents {
            torque += wave.at_after(turns, angle);
        }
        let whole = wound(turns, angle);
        if let Some(clicks) = &self.clicks {
            torque += clicks.force(click, whole, rate);
        }
        if let Some(wave) = &self.texture {
            torque += wave.at_after(turns, angle);
        }
        if let Some(spring) = &self.spring {
            torque += saturate(
                spring.stiffness_n_m_per_rad * (spring.rest_rad - whole),
                -spring.max_torque_n_m,
                spring.max_torque_n_m,
            );
        }
        if let Some(ends) = &self.ends {
            torque += ends.torque(whole, rate);
        }
        torque
    }
}

/// The whole angle, radians: for springs and stops, whose torque has a limit far from them.
#[inline]
pub(crate) fn wound(turns: i32, angle: f32) -> f32 {
    if turns == 0 { angle } else { turns as f32 * TAU + angle }
}

impl Ends {
    /// The torque of the end stops, N·m: zero between them, and never outwards.
    #[inline]
    fn torque(&self, angle: f32, rate: f32) -> f32 {
        let [least, most] = self.between_rad;
        if angle > most {
            let torque = self.stiffness_n_m_per_rad * (most - angle) - self.damping_n_m_s_per_rad * rate;
            if torque < 0.0 { torque } else { 0.0 }
        } else if angle < least {
            let torque = self.stiffness_n_m_per_rad * (least - angle) - self.damping_n_m_s_per_rad * rate;
            if torque > 0.0 { torque } else { 0.0 }
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DETENTS: Wave = Wave { pitch_rad: 0.25, torque_n_m: 0.03, centre_rad: 0.1 };
    const ENDS: Ends = Ends { between_rad: [-1.0, 1.0], stiffness_n_m_per_rad: 0.8, damping_n_m_s_per_rad: 1e-3 };
    const SPRING: Spring = Spring { stiffness_n_m_per_rad: 0.05, rest_rad: 0.2, max_torque_n_m: 0.02 };

    fn still(feel: &Feel, angle: f32) -> f32 {
        feel.torque(&mut 0, angle, 0.0)
    }

    #[test]
    fn a_wave_has_its_torque_a_quarter_of_a_pitch_from_each_detent() {
        let feel = Feel { detents: Some(DETENTS), ..Feel::FREE };
        for detent in -40..40 {
            let centre = 0.1 + 0.25 * detent as f32;
            // Roundings of 10 rad by a slope of 0.75 N·m/rad.
            assert!(still(&feel, centre).abs() < 1e-6, "{detent}");
            assert!((still(&feel, centre + 0.0625) + 0.03).abs() < 1e-6, "{detent}");
            assert!((still(&feel, centre - 0.0625) - 0.03).abs() < 1e-6, "{detent}");
        }
    }

    #[test]
    fn a_spring_has_a_most_and_ends_only_push() {
        let feel = Feel { spring: Some(SPRING), ..Feel::FREE };
        for (angle, torque) in [(0.2, 0.0), (0.0, 0.01), (0.4, -0.01), (-3.0, 0.02), (3.0, -0.02)] {
            assert!((still(&feel, angle) - torque).abs() < 1e-7, "{angle}");
        }
        let feel = Feel { ends: Some(ENDS), ..Feel::FREE };
        for (angle, rate, torque) in [
            (0.9, 9.0, 0.0),
            (1.1, 0.0, -0.08),
            (-1.1, 0.0, 0.08),
            (1.1, 10.0, -0.09),
            (1.1, -200.0, 0.0),
            (-1.1, 200.0, 0.0),
        ] {
            assert!((feel.torque(&mut 0, angle, rate) - torque).abs() < 1e-6, "{angle} {rate}");
        }
    }

    #[test]
    fn parts_add_up_and_what_makes_no_sense_is_refused_by_name() {
        let all = Feel {
            detents: Some(DETENTS),
            texture: Some(DETENTS),
            spring: Some(SPRING),
            ends: Some(ENDS),
            clicks: None,
            damping_n_m_s_per_rad: 1e-3,
        };
        assert_eq!(all.check(), Ok(()));
        let sum = 2.0 * DETENTS.at(0.3) + 0.05 * -0.1 - 1e-3 * 2.0;
        assert!((all.torque(&mut 0, 0.3, 2.0) - sum).abs() < 1e-7);
        // 2 · 0.03 · 2π/0.25 + 0.05 + 0.8.
        assert!((all.stiffness() - 2.357_964).abs() < 1e-4 && (all.torque_between_ends() - 0.08).abs() < 1e-6);
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            let wave = Some(Wave { torque_n_m: bad, ..DETENTS });
            assert_eq!(Feel { detents: wave, ..all }.check(), Err(FeelError::Detents));
            assert_eq!(
                Feel { detents: Some(Wave { pitch_rad: bad, ..DETENTS }), ..all }.check(),
                Err(FeelError::Detents)
            );
            assert_eq!(Feel { texture: wave, ..all }.check(), Err(FeelError::Texture));
            assert_eq!(
                Feel { spring: Some(Spring { stiffness_n_m_per_rad: bad, ..SPRING }), ..all }.check(),
                Err(FeelError::Spring)
            );
            assert_eq!(
                Feel { ends: Some(Ends { damping_n_m_s_per_rad: bad, ..ENDS }), ..all }.check(),
                Err(FeelError::Ends)
            );
            assert_eq!(Feel { damping_n_m_s_per_rad: bad, ..all }.check(), Err(FeelError::Damping));
        }
        assert_eq!(Feel { ends: Some(Ends { between_rad: [1.0, -1.0], ..ENDS }), ..all }.check(), Err(FeelError::Ends));
    }
}
