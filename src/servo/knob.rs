//! A dial as a surface of the loop: a table of feels and one that a host sets, one of them active at a time.

use super::fault::Phase;
use super::knob_error::{DAMPING_PER_STIFFNESS_S, KnobError, MAX_RETURN_RAD, Sentence};
use super::surface::{BakedTables, Surface, Touched, Tracked, witness_words};
use crate::device::{Device, Dial, MARGIN_RIM};
use crate::math::{Vec3, saturate};
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::render::{Feel, FeelPart, nearest, wound};
use crate::track::{BoundaryMode, Contact, Controller, Probe, Witness};
use core::f32::consts::TAU;

/// The feel of a dial: a table of feels in flash, switched while it runs ([`super::Event::Chosen`]).
///
/// The loop is the same as on surfaces: phases, faults, soft start, limits and the gate. Only the surface is missing;
/// the force is a function of the dial's position ([`Tracked::own_force`]).
///
/// A switch never gives a step: the difference between the old feel's torque and the new one's decays at a constant
/// rate, N·m/s. The entry after the table's last is a feel that a host sets part by part ([`Self::set`]).
///
/// All parts count one angle, which [`Self::dial`] reports. Where force starts or a feel is chosen, a feel of the table
/// moves to the dial by whole turns if that brings it nearer: no spring or end stop turns the dial back further than half
/// a turn beyond its own place. The host's feel rests where the dial is then ([`Self::set`]).
///
/// ```
/// use palpate::device::{Dial, presets::GIMBAL_KNOB};
/// use palpate::render::{Feel, Wave};
/// use palpate::servo::{Config, Knob, Servo};
///
/// /// Free, and 24 detents a turn.
/// static FEELS: [Feel; 2] = [
///     Feel::FREE,
///     Feel {
///         detents: Some(Wave { pitch_rad: 0.2618, torque_n_m: 0.01, centre_rad: 0.0 }),
///         damping_n_m_s_per_rad: 2e-4,
///         ..Feel::FREE
///     },
/// ];
/// static KNOB: Knob = Knob::new(&GIMBAL_KNOB, &FEELS, 0.5);
/// static SERVO: Servo<Knob, Dial, 1> = Servo::new(&GIMBAL_KNOB, &KNOB, Config::DEFAULT);
/// assert_eq!(SERVO.start().witness().feel(), 0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knob {
    feels: &'static [Feel],
    radius: f32,
    /// N·m.
    most: f32,
    /// Whether that is the motor's torque at full duty, not the device's maximum force at the rim.
    motor_limits: bool,
    /// N·m/s.
    let_go: f32,
    /// N·m/rad and N·m·s/rad.
    max_stiffness: f32,
    max_damping: f32,
    /// Whether the encoder's count falls as the angle rises.
    reversed: bool,
}

/// The turns that an angle counts at most where no place of a table's feel is bound to them: its rounding, 1e-4 rad, is
/// below a count of 14 bits.
const MAX_TURNS: u32 = 256;

/// The state of a knob between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnobWitness {
    witness: Witness,
    /// Which feel.
    feel: u8,
    /// Whether it was chosen since the last tick.
    switched: bool,
    /// The detent that was clicked into last.
    click: i32,
    /// Whole turns of the dial that are no part of the probe's place.
    turns: i32,
    /// The turn from which the active feel counts its angle.
    base: i32,
    /// The same of the host's feel.
    own_base: i32,
    /// The angle that the active feel counts, radians; not known before the first tick.
    whole: Option<f32>,
    /// Whether force starts with the next tick, or a feel was chosen: feel and dial are brought together.
    rebased: bool,
    /// Whether force starts with the next tick.
    starts: bool,
    /// The host's feel.
    own: Option<Feel>,
    /// The torque now, N·m.
    torque: f32,
    /// The torque left over from another feel, N·m.
    left_over: f32,
    /// The force at the rim, N.
    force: f32,
    /// Distance to the nearer end stop at the rim, metres; negative beyond. Zero without end stops.
    gap: f32,
}

impl KnobWitness {
    /// The index of the active feel, from 0.
    pub const fn feel(&self) -> u8 {
        self.feel
    }

    /// The torque on the dial by the feel, N·m, before soft start and limits.
    pub const fn torque(&self) -> f32 {
        self.torque
    }

    /// The dial's angle by which the active feel's parts are placed, radians ([`DialState::angle_rad`]). `None` before the
    /// first tick.
    pub const fn angle(&self) -> Option<f32> {
        self.whole
    }

    /// The turn from which this angle is counted ([`DialState::turns`]).
    pub const fn base(&self) -> i32 {
        self.base
    }

    /// The feel that a host has set.
    pub const fn own(&self) -> Option<&Feel> {
        self.own.as_ref()
    }

    /// Counts the angle from another turn.
    fn count_from(&mut self, base: i32) {
        let turns = self.base.wrapping_sub(base);
        (self.base, self.whole) = (base, self.whole.map(|whole| wound(turns, whole)));
    }

    /// The turn from which the angle is counted, and the angle, where the joint is at one: at first within half a turn.
    #[inline]
    fn place(&self, angle: f32) -> (i32, f32) {
        let base = match self.whole {
            Some(_) => self.base,
            None => self.turns.wrapping_add(nearest(angle / TAU)),
        };
        (base, wound(self.turns.wrapping_sub(base), angle))
    }
}

impl Knob {
    /// The feels of a dial, checked against its device. `let_go` is the release rate of the old torque after a switch,
    /// N·m/s.
    ///
    /// # Errors
    /// The first number that is refused.
    pub const fn try_new(device: &Device<Dial, 1>, feels: &'static [Feel], let_go: f32) -> Result<Self, KnobError> {
        match Self::checked(device, feels, let_go) {
            Ok(knob) => Ok(knob),
            Err((error, _)) => Err(error),
        }
    }

    /// [`Self::try_new`]; a refusal of a feel has its index.
    const fn checked(
        device: &Device<Dial, 1>,
        feels: &'static [Feel],
        let_go: f32,
    ) -> Result<Self, (KnobError, Option<usize>)> {
        let radius = device.kinematics.radius_m;
        let (limit, full) = (device.max_force_n * radius, device.motors[0].torque_at_full_n_m.abs());
        if feels.is_empty() || feels.len() > 255 {
            return Err((KnobError::Feels, None));
        }
        let is_whole = device.min_margin_m_per_rad * (1.0 + MARGIN_RIM) <= radius * (1.0 + 4.0 * f32::EPSILON);
        if !is_whole {
            return Err((KnobError::Margin, None));
        }
        let knob = Self {
            feels,
            radius,
            most: if limit <= full { limit } else { full },
            motor_limits: full < limit,
            let_go,
            max_stiffness: device.max_stiffness_n_per_m * radius * radius,
            max_damping: device.max_damping_n_s_per_m * radius * radius,
            reversed: device.encoders[0].radians_per_count < 0.0,
        };
        let mut index = 0;
        while index < feels.len() {
            if let Err(error) = knob.bears(&feels[index]) {
                return Err((error, Some(index)));
            }
            index += 1;
        }
        if let_go > 0.0 && let_go < f32::INFINITY { Ok(knob) } else { Err((KnobError::LetGo, None)) }
    }

    /// Whether the device bears a feel.
    const fn bears(&self, feel: &Feel) -> Result<(), KnobError> {
        if let Err(error) = feel.check() {
            return Err(KnobError::Feel(error));
        }
        let [stiffness, damping, torque] = [feel.stiffness(), feel.greatest_damping(), feel.torque_between_ends()];
        // The limits are products: a number equal to one but for their rounding is within it. Written so that NaN is
        // refused.
        const ROUNDED: f32 = 1.0 + 4.0 * f32::EPSILON;
        let bears_stiffness = stiffness <= self.max_stiffness * ROUNDED;
        let bears_damping = damping <= self.max_damping * ROUNDED;
        let bears_torque = torque <= self.most * ROUNDED;
        if !bears_stiffness {
            return Err(KnobError::Stiffness { asked_n_m_per_rad: stiffness, limit_n_m_per_rad: self.max_stiffness });
        }
        if !bears_damping {
            return Err(KnobError::Damping { asked_n_m_s_per_rad: damping, limit_n_m_s_per_rad: self.max_damping });
        }
        if !bears_torque {
            let (asked_n_m, limit_n_m) = (torque, self.most);
            return Err(if self.motor_limits {
                KnobError::Motor { asked_n_m, limit_n_m }
            } else {
                KnobError::Torque { asked_n_m, limit_n_m }
            });
        }
        let damped = feel.damping_n_m_s_per_rad;
        let needed = feel.needed_damping(DAMPING_PER_STIFFNESS_S);
        // Differences of stiffnesses leave a rounding.
        let rests = needed <= damped * ROUNDED + 4.0 * f32::EPSILON * DAMPING_PER_STIFFNESS_S * stiffness;
        if rests {
            Ok(())
        } else {
            Err(KnobError::Undamped { asked_n_m_s_per_rad: damped, needed_n_m_s_per_rad: needed })
        }
    }

    /// [`Self::try_new`] for a `static`: invalid numbers are compile errors.
    ///
    /// # Panics
    /// At compile time, naming the feel by its index, and the numbers.
    pub const fn new(device: &Device<Dial, 1>, feels: &'static [Feel], let_go: f32) -> Self {
        match Self::checked(device, feels, let_go) {
            Ok(knob) => knob,
            Err((error, Some(index))) => panic!("{}", Sentence::of(error, index).as_str()),
            Err((error, None)) => panic!("{}", error.message()),
        }
    }

    /// The feels of the table.
    pub const fn feels(&self) -> &'static [Feel] {
        self.feels
    }

    /// Sets a part of the host's feel between two ticks, and makes that the active one, or changes nothing. The first
    /// part changes a copy of the feel that was active. The old torque is let go of as after a switch.
    ///
    /// Where force starts the host's spring, end stops and range of clicks are moved by as little as leaves the dial
    /// where it is, and the notch to its turn. While the dial's place is known they are taken within [`MAX_RETURN_RAD`]
    /// of it only.
    ///
    /// # Errors
    /// The number that is refused.
    pub fn set(&self, state: &mut KnobWitness, part: FeelPart) -> Result<(), KnobError> {
        let feel = self.active(state).with(part);
        self.bears(&feel)?;
        // A detent turns the dial by half a pitch.
        let part = Feel::FREE.with(part);
        let pull = state.whole.map_or(0.0, |angle| part.pull(angle)).max(0.5 * part.longest_pitch());
        // Written so that NaN is refused.
        let near = pull <= MAX_RETURN_RAD;
        if !near {
            return Err(KnobError::Far { asked_rad: pull });
        }
        // New clicks hold the dial in the detent that is nearest, whichever held it before.
        if part.clicks.is_some() {
            state.click = feel.detent(state.whole.unwrap_or(0.0));
        }
        (state.own, state.own_base) = (Some(feel), state.base);
        (state.feel, state.switched) = (self.feels.len() as u8, true);
        Ok(())
    }

    /// Starts with a feel that a host has set before, as the active one, or changes nothing. Before the first tick only.
    ///
    /// # Errors
    /// The number that is refused.
    pub fn restore(&self, state: &mut KnobWitness, feel: Feel) -> Result<(), KnobError> {
        if state.whole.is_some() {
            return Err(KnobError::Late);
        }
        self.bears(&feel)?;
        (state.own, state.feel, state.rebased) = (Some(feel), self.feels.len() as u8, true);
        Ok(())
    }

    #[inline]
    fn active(&self, state: &KnobWitness) -> Feel {
        self.feels.get(usize::from(state.feel)).copied().or(state.own).unwrap_or(Feel::FREE)
    }

    fn is_own(&self, state: &KnobWitness) -> bool {
        usize::from(state.feel) == self.feels.len()
    }

    /// Brings a feel of the table to the dial by whole turns, if that is nearer; the host's then rests where it is.
    #[cold]
    fn rebase(&self, state: &mut KnobWitness) {
        let whole = state.whole.unwrap_or(0.0);
        if let Some(feel) = self.feels.get(usize::from(state.feel)) {
            let turns = nearest(whole / TAU);
            let places = Feel { notch: None, ..*feel };
            let [stays, moves] = [whole, wound(turns.wrapping_neg(), whole)].map(|angle| places.pull(angle));
            // A notch is in each turn of the dial.
            if moves < stays || feel.notch.is_some() && moves <= stays {
                state.count_from(state.base.wrapping_add(turns));
            }
        } else if let Some(own) = &mut state.own {
            own.settle(whole);
        }
        state.click = self.active(state).detent(state.whole.unwrap_or(0.0));
        // It is not felt before force fades in.
        if state.starts {
            (state.left_over, state.switched) = (0.0, false);
        }
        (state.rebased, state.starts) = (false, false);
    }

    /// Keeps the angle precise: takes whole turns out of it and of the host's feel, without a step of the torque.
    #[cold]
    fn unwind(&self, state: &mut KnobWitness) {
        let turns = state.turns.wrapping_sub(state.base);
        let is_own = self.is_own(state);
        if state.whole.is_none() || turns.unsigned_abs() <= MAX_TURNS || !(is_own || self.active(state).is_endless()) {
            return;
        }
        state.count_from(state.turns);
        if is_own && let Some(own) = &mut state.own {
            own.unwind(turns);
            state.own_base = state.base;
        }
        (state.click, state.switched) = (self.active(state).detent(state.whole.unwrap_or(0.0)), true);
    }
}

/// The dial as a host sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DialState {
    /// Whole turns that the angle does not count: those by which a feel of the table moved to the dial, those before the
    /// first tick, and those that were taken out beyond 256. Both together never jump.
    pub turns: i32,
    /// The angle by which the active feel's parts are placed, and those that a host sets, radians.
    pub angle_rad: f32,
    /// The torque of the feel, N·m, before soft start and limits; 0 unless the loop is [`Phase::Running`].
    pub torque_n_m: f32,
    /// Which feel is active.
    pub feel: u8,
    /// The number of the detent or click that is nearest to the angle.
    pub detent: i32,
    /// Whether the dial is beyond an end stop: −1 below, 1 above, 0 between them.
    pub end: i8,
}

impl Knob {
    /// The dial as it is, for a host, where its joint is at an angle, radians: without force there is no torque, and the
    /// angle goes on, before the rotor is aligned too.
    pub fn dial(&self, state: &KnobWitness, joint_rad: f32, phase: Phase) -> DialState {
        let feel = self.active(state);
        let (turns, placed) = state.place(joint_rad);
        let whole = state.whole.unwrap_or(placed);
        let beyond = |[least, most]: [f32; 2]| i8::from(whole > most) - i8::from(whole < least);
        DialState {
            turns,
            angle_rad: whole,
            torque_n_m: if matches!(phase, Phase::Running) { state.torque } else { 0.0 },
            feel: state.feel,
            detent: feel.detent(whole),
            end: feel.ends.map_or(0, |ends| beyond(ends.between_rad)),
        }
    }
}

impl Surface for Knob {
    type Witness = KnobWitness;

    fn rest(&self) -> KnobWitness {
        let nowhere = SurfacePoint { point: Vec3::ZERO, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        KnobWitness {
            witness: Witness {
                parameters: [0.0; 2],
                surface: nowhere,
                second: SecondDerivatives::NONE,
                mode: BoundaryMode::Interior,
                is_free: true,
                halvings: 0,
            },
            feel: 0,
            switched: false,
            click: 0,
            turns: 0,
            base: 0,
            own_base: 0,
            whole: None,
            rebased: false,
            starts: false,
            own: None,
            torque: 0.0,
            left_over: 0.0,
            force: 0.0,
            gap: 0.0,
        }
    }

    #[inline]
    fn follow(&self, _: &Controller, state: &mut KnobWitness, probe: Probe, period: f32) -> Touched {
        let inverse = 1.0 / self.radius;
        let (angle, rate) = (probe.position.x * inverse, probe.velocity.x * inverse);
        self.stopped(state, probe.position);
        if state.rebased {
            self.rebase(state);
        }
        let (turns, whole) = (state.turns.wrapping_sub(state.base), state.whole.unwrap_or(0.0));
        if let Some(feel) = self.feels.get(usize::from(state.feel)).or(state.own.as_ref()) {
            let wanted = feel.torque_after(turns, whole, &mut state.click, angle, rate);
            // No feel that passes its check gives another; a torque that is no number must not become the maximum.
            let wanted = if wanted.is_finite() { saturate(wanted, -self.most, self.most) } else { 0.0 };
            if state.switched {
                state.left_over = state.torque - wanted;
                state.switched = false;
            }
            let step = self.let_go * period;
            state.left_over -= saturate(state.left_over, -step, step);
            state.torque = saturate(wanted + state.left_over, -self.most, self.most);
            state.gap = match &feel.ends {
                Some(ends) => {
                    let [below, above] = [whole - ends.between_rad[0], ends.between_rad[1] - whole];
                    self.radius * if below < above { below } else { above }
                }
                None => 0.0,
            };
        }
        state.force = state.torque * inverse;
        state.witness.surface.point = probe.position;
        Touched { normal: Vec3::ZERO, rejected: false, unexplained: false }
    }

    fn release(&self, _: &mut KnobWitness) {}

    fn choose(&self, state: &mut KnobWitness, index: u8) {
        let is_own = usize::from(index) == self.feels.len() && state.own.is_some();
        if (usize::from(index) < self.feels.len() || is_own) && index != state.feel {
            (state.feel, state.switched, state.rebased) = (index, true, true);
            if is_own {
                state.count_from(state.own_base);
            }
            self.unwind(state);
        }
    }

    #[inline]
    fn start_force(&self, state: &mut KnobWitness) {
        (state.rebased, state.starts) = (true, true);
    }

    fn turn(&self, state: &mut KnobWitness, turns: i32) {
        // The encoder may count the other way.
        state.turns = if self.reversed { turns.wrapping_neg() } else { turns };
        self.unwind(state);
    }

    #[inline]
    fn stopped(&self, state: &mut KnobWitness, probe: Vec3) {
        let (base, whole) = state.place(probe.x / self.radius);
        if state.whole.is_none() {
            (state.base, state.own_base) = (base, base);
        }
        state.whole = Some(whole);
    }
}

/// None: the feels are part of the program.
impl BakedTables for Knob {}

impl Tracked for KnobWitness {
    fn witness(&self) -> &Witness {
        &self.witness
    }

    fn gap(&self) -> f32 {
        self.gap
    }

    fn contact(&self) -> Contact {
        Contact::InFront
    }

    /// The index of the active feel.
    fn feature(&self) -> u16 {
        u16::from(self.feel)
    }

    #[inline]
    fn own_force(&self) -> Option<Vec3> {
        Some(Vec3::X * self.force)
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        witness_words(&self.witness, &mut take);
        let flags = [self.switched, self.rebased, self.starts, self.whole.is_some(), self.own.is_some()];
        take(flags.iter().fold(u32::from(self.feel), |word, flag| word << 1 | u32::from(*flag)));
        take(self.click as u32);
        take(self.turns as u32);
        take(self.base as u32);
        take(self.own_base as u32);
        take(self.whole.unwrap_or(0.0).to_bits());
        if let Some(own) = &self.own {
            own.for_each_word(&mut take);
        }
        for number in [self.torque, self.left_over, self.force, self.gap] {
            take(number.to_bits());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::GIMBAL_KNOB;
    use crate::render::{Detents, Ends, FeelError, Notch, Spring, Wave};

    static FEELS: [Feel; 4] = [
        Feel::FREE,
        Feel {
            detents: Some(Wave { pitch_rad: 0.25, torque_n_m: 0.03, centre_rad: 0.0 }),
            damping_n_m_s_per_rad: 6e-4,
            ..Feel::FREE
        },
        Feel {
            spring: Some(Spring { stiffness_n_m_per_rad: 0.1, rest_rad: 0.0, max_torque_n_m: 0.05 }),
            damping_n_m_s_per_rad: 1e-4,
            ..Feel::FREE
        },
        Feel {
            ends: Some(Ends { between_rad: [-0.5, 0.5], stiffness_n_m_per_rad: 1.0, damping_n_m_s_per_rad: 1e-3 }),
            ..Feel::FREE
        },
    ];
    const LET_GO: f32 = 1.0;
    const PERIOD: f32 = 1e-3;
    const KNOB: Knob = Knob::new(&GIMBAL_KNOB, &FEELS, LET_GO);

    fn follow(state: &mut KnobWitness, angle: f32) -> f32 {
        KNOB.follow(&Controller::SecondOrder, state, Probe::at(Vec3::X * (angle * 0.02)), PERIOD);
        state.torque()
    }

    #[test]
    fn no_switch_changes_the_torque_by_more_than_is_let_go_of_in_a_tick_and_all_come_to_their_table() {
        for angle in [-0.6, -0.31, 0.0, 0.06, 0.55] {
            for from in 0..4 {
                for to in 0..4 {
                    let mut state = KNOB.rest();
                    KNOB.choose(&mut state, from);
                    (0..100).for_each(|_| {
                        follow(&mut state, angle);
                    });
                    let mut before = state.torque();
                    KNOB.choose(&mut state, to);
                    for _ in 0..200 {
                        let torque = follow(&mut state, angle);
                        // A rounding of 60 mN·m.
                        assert!((torque - before).abs() <= LET_GO * PERIOD + 1e-8, "{angle} {from} {to}");
                        before = torque;
                    }
                    let table = FEELS[usize::from(to)].torque(&mut 0, angle, 0.0).clamp(-KNOB.most, KNOB.most);
                    assert!((before - table).abs() < 1e-6, "{angle} {from} {to}: {before} {table}");
                }
            }
        }
    }

    #[test]
    fn a_feel_that_the_device_does_not_bear_is_refused_by_name() {
        extern crate std;
        fn refused(feel: Feel) -> KnobError {
            Knob::try_new(&GIMBAL_KNOB, std::boxed::Box::leak(std::boxed::Box::new([feel])), LET_GO).unwrap_err()
        }
        let wave = |pitch, torque| Some(Wave { pitch_rad: pitch, torque_n_m: torque, centre_rad: 0.0 });
        // 0.07 · 2π/0.25; 2.8 N and 4,000 N/m and 8 N·s/m at a radius of 20 mm.
        for (feel, says) in [
            (
                Feel { detents: wave(0.25, 0.07), ..Feel::FREE },
                "as stiff as 1759.29 mN·m/rad, and the device's limit is 1600.00 mN·m/rad (max_stiffness_n_per_m): weaken",
            ),
            (
                Feel { detents: wave(2.5, 0.07), ..Feel::FREE },
                "up to 70.00 mN·m, and the device's limit is 56.00 mN·m (max_force_n): weaken",
            ),
            (
                Feel { damping_n_m_s_per_rad: 4e-3, ..Feel::FREE },
                "damps by 4.00 mN·m·s/rad, and the device's limit is 3.20 mN·m·s/rad (max_damping_n_s_per_m): weaken",
            ),
        ] {
            let said = std::string::ToString::to_string(&refused(feel));
            assert!(said.contains(says), "{said}");
        }
        assert_eq!(refused(Feel { detents: wave(0.0, 0.01), ..Feel::FREE }), KnobError::Feel(FeelError::Detents));
        // A motor of 50 mN·m.
        let mut weaker = GIMBAL_KNOB;
        weaker.motors[0].torque_at_full_n_m = -0.05;
        let asked = Spring { stiffness_n_m_per_rad: 0.06, rest_rad: 0.0, max_torque_n_m: 0.052 };
        let feel = Feel { spring: Some(asked), damping_n_m_s_per_rad: 1e-4, ..Feel::FREE };
        let refused_by =
            |device| Knob::try_new(device, std::boxed::Box::leak(std::boxed::Box::new([feel])), LET_GO).err();
        assert_eq!(refused_by(&GIMBAL_KNOB), None);
        let motor = KnobError::Motor { asked_n_m: 0.052, limit_n_m: 0.05 };
        assert_eq!(refused_by(&weaker), Some(motor));
        let said = std::string::ToString::to_string(&motor);
        assert!(said.contains("up to 52.00 mN·m, and the motor's limit is 50.00 mN·m: weaken"), "{said}");
        assert_eq!(Knob::try_new(&GIMBAL_KNOB, &[], LET_GO), Err(KnobError::Feels));
        for (min_margin_m_per_rad, refusal) in
            [(0.016, None), (0.0161, Some(KnobError::Margin)), (f32::NAN, Some(KnobError::Margin))]
        {
            let device = Device { min_margin_m_per_rad, ..GIMBAL_KNOB };
            assert_eq!(Knob::try_new(&device, &FEELS, LET_GO).err(), refusal);
        }
        assert_eq!(Knob::try_new(&GIMBAL_KNOB, &FEELS, 0.0), Err(KnobError::LetGo));
    }

    #[test]
    fn no_part_of_a_host_holds_the_dial_with_a_constant_torque_or_takes_it_far() {
        let mut state = KNOB.rest();
        follow(&mut state, 1.5);
        // So short that an angle has no fraction of it left.
        let wave = Wave { pitch_rad: 1e-40, torque_n_m: 0.0, centre_rad: 0.0 };
        assert_eq!(KNOB.set(&mut state, FeelPart::Detents(Some(wave))), Err(KnobError::Feel(FeelError::Detents)));
        assert_eq!(KNOB.set(&mut state, FeelPart::Damping(1e-4)), Ok(()));
        // The dial is in it, far from its middle.
        let notch = Notch { at_rad: 0.0, width_rad: 3.1, torque_n_m: 1e-3 };
        assert_eq!(KNOB.set(&mut state, FeelPart::Notch(Some(notch))), Err(KnobError::Far { asked_rad: 1.5 }));
        let clicks = Detents {
            pitch: 1.4,
            stiffness: 1e-3,
            damping: 1e-6,
            snap: 1.0,
            first: -3,
            last: 3,
            wall_stiffness: 1e-3,
            max_force: 0.01,
        };
        assert_eq!(KNOB.set(&mut state, FeelPart::Clicks(Some(clicks))), Ok(()));
        assert_eq!(state.click, 1, "the nearest detent, not the one of a feel without clicks");
    }
}
