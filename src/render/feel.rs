//! The feel of a dial: the sum of detents, clicks, a texture, a spring and end stops.

use super::Detents;
use crate::math::{saturate, sin_cos};
use core::f32::consts::TAU;

/// A torque that repeats with every pitch: `−T sin(2π (θ − centre)/pitch)`. A coarse one is detents, a fine one a
/// texture. It comes from a potential: turned there and back it returns the energy that it took.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ends {
    /// Where they are, radians.
    pub between_rad: [f32; 2],
    /// N·m/rad.
    pub stiffness_n_m_per_rad: f32,
    /// N·m·s/rad; it only pushes, never holds.
    pub damping_n_m_s_per_rad: f32,
}

/// Dry friction on the dial.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DialFriction {
    /// Its torque, N·m.
    pub torque_n_m: f32,
    /// The rate from which on it is whole, rad/s; below, it is damping, which never moves the dial.
    pub whole_at_rad_per_s: f32,
}

/// A haptic click at one position: a single detent. Its torque comes from a potential and rises by at most
/// `2π T/width` for each radian.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Notch {
    /// Where it is, radians.
    pub at_rad: f32,
    /// From one side to the other, radians, at most half a turn; beyond, nothing.
    pub width_rad: f32,
    /// Maximum torque, `T`, a quarter of the width from its middle, N·m.
    pub torque_n_m: f32,
}

/// The feel of a dial. Its parts add up; start with [`Feel::FREE`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Feel {
    /// Detents that one turns through smoothly.
    pub detents: Option<Wave>,
    /// Detents that snap, with hysteresis: of [`Detents`]' units those of a dial, rad, N·m, N·m/rad and N·m·s/rad.
    pub clicks: Option<Detents>,
    /// Texture between detents.
    pub texture: Option<Wave>,
    /// A spring.
    pub spring: Option<Spring>,
    /// End stops.
    pub ends: Option<Ends>,
    /// Damping everywhere, N·m·s/rad.
    pub damping_n_m_s_per_rad: f32,
    /// Dry friction.
    pub friction: Option<DialFriction>,
    /// A click at one position.
    pub notch: Option<Notch>,
}

/// One part of a feel, as a host sets it; `None` takes the part away.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FeelPart {
    /// [`Feel::detents`].
    Detents(Option<Wave>),
    /// [`Feel::clicks`].
    Clicks(Option<Detents>),
    /// [`Feel::texture`].
    Texture(Option<Wave>),
    /// [`Feel::spring`].
    Spring(Option<Spring>),
    /// [`Feel::ends`].
    Ends(Option<Ends>),
    /// [`Feel::damping_n_m_s_per_rad`].
    Damping(f32),
    /// [`Feel::friction`].
    Friction(Option<DialFriction>),
    /// [`Feel::notch`].
    Notch(Option<Notch>),
    /// All parts at once: none is left.
    Free,
}

/// Which part of a feel is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeelError {
    /// A pitch that is not between 1e-4 rad and half a turn, a centre beyond a turn, or a number that is not finite.
    Detents,
    /// A pitch as of detents, or as [`super::DetentsError`] says.
    Clicks,
    /// As detents.
    Texture,
    /// A number that is negative or not finite.
    Spring,
    /// Ends that are not in order, or a number that is negative or not finite.
    Ends,
    /// A damping that is negative or not finite.
    Damping,
    /// A torque that is negative or not finite, or a rate that is not positive and finite.
    Friction,
    /// A width that is not between 1e-4 rad and half a turn, or a number that is negative or not finite.
    Notch,
}

impl FeelError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Detents => {
                "detents need a pitch from 1e-4 rad to half a turn, a centre within a turn, and no negative torque"
            }
            Self::Clicks => {
                "clicks need a pitch from 1e-4 rad to half a turn, a snap from 0.5 to 1, no negative force, first <= last"
            }
            Self::Texture => {
                "a texture needs a pitch from 1e-4 rad to half a turn, a centre within a turn, and no negative torque"
            }
            Self::Spring => {
                "a spring needs a finite rest, and a stiffness and maximum torque that are finite and not negative"
            }
            Self::Ends => "end stops must be in order, with a stiffness and a damping that are finite and not negative",
            Self::Damping => "the feel's damping must be finite and not negative",
            Self::Friction => "friction needs a torque that is finite and not negative, and a rate that is positive",
            Self::Notch => "a notch needs a finite place, a width from 1e-4 rad to half a turn, and no negative torque",
        }
    }
}

crate::message::display!(FeelError);

/// Whether `0 ≤ x < ∞`; false for NaN.
const fn is_size(x: f32) -> bool {
    x >= 0.0 && x < f32::INFINITY
}

/// The shortest pitch, radians, a quarter of a count of 14 bits. Of a shorter one the number of pitches in an angle no
/// longer has a fraction in single precision, and a constant torque would be left.
const MIN_PITCH_RAD: f32 = 1e-4;

impl Wave {
    /// Of a centre that is far, or a pitch that is long, a constant torque would be left.
    const fn is_valid(&self) -> bool {
        self.pitch_rad >= MIN_PITCH_RAD
            && self.pitch_rad <= 0.5 * TAU
            && is_size(self.torque_n_m)
            && self.centre_rad >= -TAU
            && self.centre_rad <= TAU
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

impl DialFriction {
    const fn damping(&self) -> f32 {
        self.torque_n_m / self.whole_at_rad_per_s
    }

    const fn is_valid(&self) -> bool {
        is_size(self.torque_n_m) && self.whole_at_rad_per_s > 0.0 && self.whole_at_rad_per_s < f32::INFINITY
    }
}

impl Notch {
    const fn wave(&self) -> Wave {
        Wave { pitch_rad: self.width_rad, torque_n_m: self.torque_n_m, centre_rad: self.at_rad }
    }

    const fn is_valid(&self) -> bool {
        Wave { centre_rad: 0.0, ..self.wave() }.is_valid() && self.at_rad.is_finite()
    }

    #[inline]
    fn at(&self, angle: f32) -> f32 {
        if (angle - self.at_rad).abs() < 0.5 * self.width_rad { self.wave().at(angle) } else { 0.0 }
    }
}

impl Feel {
    /// Nothing.
    pub const FREE: Self = Self {
        detents: None,
        clicks: None,
        texture: None,
        spring: None,
        ends: None,
        damping_n_m_s_per_rad: 0.0,
        friction: None,
        notch: None,
    };

    /// The same with another part.
    #[must_use]
    pub const fn with(mut self, part: FeelPart) -> Self {
        match part {
            FeelPart::Detents(detents) => self.detents = detents,
            FeelPart::Clicks(clicks) => self.clicks = clicks,
            FeelPart::Texture(texture) => self.texture = texture,
            FeelPart::Spring(spring) => self.spring = spring,
            FeelPart::Ends(ends) => self.ends = ends,
            FeelPart::Damping(damping) => self.damping_n_m_s_per_rad = damping,
            FeelPart::Friction(friction) => self.friction = friction,
            FeelPart::Notch(notch) => self.notch = notch,
            FeelPart::Free => self = Self::FREE,
        }
        self
    }

    /// The longest pitch, radians.
    pub(crate) fn longest_pitch(&self) -> f32 {
        let waves = [self.detents, self.texture].map(|wave| wave.map_or(0.0, |wave| wave.pitch_rad));
        waves[0].max(waves[1]).max(self.clicks.map_or(0.0, |clicks| clicks.pitch))
    }

    /// How far spring, end stops, the outer clicks and the notch are from leaving a dial at this angle where it is, radians.
    pub(crate) fn pull(&self, angle: f32) -> f32 {
        let mut far = 0.0_f32;
        let mut outside = |[least, most]: [f32; 2]| far = far.max(least - angle).max(angle - most);
        if let Some(spring) = &self.spring {
            outside([spring.rest_rad; 2]);
        }
        if let Some(ends) = &self.ends {
            outside(ends.between_rad);
        }
        if let Some(clicks) = &self.clicks {
            outside([clicks.first as f32 * clicks.pitch, clicks.last as f32 * clicks.pitch]);
        }
        if let Some(notch) = &self.notch {
            let off = (angle - notch.at_rad).abs();
            if off < 0.5 * notch.width_rad {
                far = far.max(off);
            }
        }
        far
    }

    /// Moves spring, end stops and the range of clicks by as little as leaves a dial at this angle where it is, and the
    /// notch to its turn.
    pub(crate) fn settle(&mut self, angle: f32) {
        if let Some(spring) = &mut self.spring {
            spring.rest_rad = angle;
        }
        if let Some(ends) = &mut self.ends {
            let [least, most] = ends.between_rad;
            let width = most - least;
            let below = saturate(angle - least, 0.0, width);
            // A width that is lost in the rounding of its place is none: the dial rests between equal stops.
            ends.between_rad = [angle - below, angle + (width - below)];
        }
        if let Some(clicks) = &mut self.clicks {
            let number = nearest(angle / clicks.pitch);
            let count = clicks.last.saturating_sub(clicks.first);
            let below = number.saturating_sub(clicks.first).min(count).max(0);
            clicks.first = number.saturating_sub(below);
            clicks.last = clicks.first.saturating_add(count);
        }
        if let Some(notch) = &mut self.notch {
            notch.at_rad = wound(nearest((angle - notch.at_rad) / TAU), notch.at_rad);
        }
    }

    /// The same feel by an angle without these turns.
    pub(crate) fn unwind(&mut self, turns: i32) {
        let by = |angle: f32| wound(turns.wrapping_neg(), angle);
        if let Some(spring) = &mut self.spring {
            spring.rest_rad = by(spring.rest_rad);
        }
        if let Some(ends) = &mut self.ends {
            ends.between_rad = ends.between_rad.map(by);
        }
        if let Some(clicks) = &mut self.clicks {
            let pitches = nearest(turns as f32 * TAU / clicks.pitch);
            clicks.first = clicks.first.saturating_sub(pitches);
            clicks.last = clicks.last.saturating_sub(pitches);
        }
        if let Some(notch) = &mut self.notch {
            notch.at_rad = by(notch.at_rad);
        }
    }

    /// Whether it has no part at a place: the same in every turn.
    pub(crate) const fn is_endless(&self) -> bool {
        self.spring.is_none() && self.ends.is_none() && self.clicks.is_none() && self.notch.is_none()
    }

    /// The number of the detent, smooth or clicking, that is nearest to this angle.
    pub(crate) fn detent(&self, angle: f32) -> i32 {
        let (pitch, centre) = match (&self.clicks, &self.detents) {
            (Some(clicks), _) => (clicks.pitch, 0.0),
            (None, Some(wave)) => (wave.pitch_rad, wave.centre_rad),
            (None, None) => return 0,
        };
        let nearest = nearest((angle - centre) / pitch);
        self.clicks.map_or(nearest, |clicks| nearest.max(clicks.first).min(clicks.last))
    }

    /// Gives every word to a hash.
    pub(crate) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        let mut words = |is_there: bool, numbers: &[f32]| {
            take(u32::from(is_there));
            numbers.iter().for_each(|number| take(number.to_bits()));
        };
        let wave = |wave: Wave| [wave.pitch_rad, wave.torque_n_m, wave.centre_rad];
        for part in [self.detents, self.texture] {
            words(part.is_some(), &part.map_or([0.0; 3], wave));
        }
        let clicks = self
            .clicks
            .map_or([0.0; 6], |of| [of.pitch, of.stiffness, of.damping, of.snap, of.wall_stiffness, of.max_force]);
        words(self.clicks.is_some(), &clicks);
        let spring = self.spring.map_or([0.0; 3], |of| [of.stiffness_n_m_per_rad, of.rest_rad, of.max_torque_n_m]);
        words(self.spring.is_some(), &spring);
        let ends = self.ends.map_or([0.0; 4], |of| {
            [of.between_rad[0], of.between_rad[1], of.stiffness_n_m_per_rad, of.damping_n_m_s_per_rad]
        });
        words(self.ends.is_some(), &ends);
        words(true, &[self.damping_n_m_s_per_rad]);
        words(self.friction.is_some(), &self.friction.map_or([0.0; 2], |of| [of.torque_n_m, of.whole_at_rad_per_s]));
        words(self.notch.is_some(), &self.notch.map_or([0.0; 3], |of| wave(of.wave())));
        if let Some(clicks) = &self.clicks {
            take(clicks.first as u32);
            take(clicks.last as u32);
        }
    }

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
            && (clicks.try_new().is_err() || clicks.pitch < MIN_PITCH_RAD || clicks.pitch > 0.5 * TAU)
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
            && !(least < most
                && most - least < f32::INFINITY
                && least.is_finite()
                && most.is_finite()
                && is_size(stiffness)
                && is_size(damping))
        {
            return Err(FeelError::Ends);
        }
        if !is_size(self.damping_n_m_s_per_rad) {
            return Err(FeelError::Damping);
        }
        if let Some(friction) = &self.friction
            && !friction.is_valid()
        {
            return Err(FeelError::Friction);
        }
        if let Some(notch) = &self.notch
            && !notch.is_valid()
        {
            return Err(FeelError::Notch);
        }
        Ok(())
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
        if let Some(notch) = &self.notch {
            sum += notch.wave().stiffness();
        }
        sum
    }

    /// The damping everywhere that the feel needs, N·m·s/rad, where its torque comes late by `lag_s`: a late stiffness
    /// drives the dial like a negative damping, of their product. Clicks and end stops have damping of their own. Friction
    /// is not counted: what it takes from a swing does not grow as that does.
    pub(crate) const fn needed_damping(&self, lag_s: f32) -> f32 {
        let (mut stiffness, mut in_clicks) = (self.stiffness(), 0.0);
        if let Some(clicks) = &self.clicks {
            let stiffest =
                if clicks.wall_stiffness > clicks.stiffness { clicks.wall_stiffness } else { clicks.stiffness };
            stiffness -= stiffest;
            // Limited with their torque: a surplus is not counted for other parts.
            let lacks = lag_s * stiffest - clicks.damping;
            in_clicks = if lacks > 0.0 { lacks } else { 0.0 };
        }
        let mut at_ends = 0.0;
        if let Some(ends) = &self.ends {
            at_ends = lag_s * stiffness - ends.damping_n_m_s_per_rad;
            stiffness -= ends.stiffness_n_m_per_rad;
        }
        let between = lag_s * stiffness;
        in_clicks + if at_ends > between { at_ends } else { between }
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
        if let Some(friction) = &self.friction {
            sum += friction.damping();
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
        if let Some(friction) = &self.friction {
            sum += friction.torque_n_m;
        }
        if let Some(notch) = &self.notch {
            sum += notch.torque_n_m;
        }
        sum
    }

    /// The torque at an angle (radians) and a rate (rad/s), N·m. `click` is the detent that was clicked into last. Not
    /// limited as a whole.
    #[inline]
    pub fn torque(&self, click: &mut i32, angle: f32, rate: f32) -> f32 {
        self.torque_after(0, angle, click, angle, rate)
    }

    /// The same after whole turns of the dial, which are no part of the angle: waves stay as precise as in the first
    /// turn. `whole` is the angle with these turns.
    #[inline]
    pub(crate) fn torque_after(&self, turns: i32, whole: f32, click: &mut i32, angle: f32, rate: f32) -> f32 {
        let mut torque = -self.damping_n_m_s_per_rad * rate;
        if let Some(wave) = &self.detents {
            torque += wave.at_after(turns, angle);
        }
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
        if let Some(friction) = &self.friction {
            torque += saturate(-friction.damping() * rate, -friction.torque_n_m, friction.torque_n_m);
        }
        if let Some(notch) = &self.notch {
            torque += notch.at(whole);
        }
        torque
    }
}

/// The nearest whole number. The cast saturates.
#[inline]
pub(crate) fn nearest(number: f32) -> i32 {
    (number + if number < 0.0 { -0.5 } else { 0.5 }) as i32
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
            damping_n_m_s_per_rad: 1e-3,
            ..Feel::FREE
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
