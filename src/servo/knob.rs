//! A dial as a surface of the loop: a table of feels, one of them active at a time.

use super::surface::{BakedTables, Surface, Touched, Tracked, witness_words};
use crate::device::{Device, Dial};
use crate::math::{Vec3, saturate};
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::render::{Feel, FeelError, wound};
use crate::track::{BoundaryMode, Contact, Controller, Probe, Witness};

/// The feel of a dial: a table of feels in flash, switched while it runs ([`super::Event::Chosen`]).
///
/// The loop is the same as on surfaces: phases, faults, soft start, limits and the gate. Only the surface is missing;
/// the force is a function of the dial's position ([`Tracked::own_force`]).
///
/// A switch never gives a step: the difference between the old feel's torque and the new one's decays at a constant
/// rate, N·m/s.
///
/// ```
/// use palpate::device::{Dial, presets::GIMBAL_KNOB};
/// use palpate::render::{Feel, Wave};
/// use palpate::servo::{Config, Knob, Servo};
///
/// /// Free, and 24 detents a turn.
/// static FEELS: [Feel; 2] = [
///     Feel::FREE,
///     Feel { detents: Some(Wave { pitch_rad: 0.2618, torque_n_m: 0.01, centre_rad: 0.0 }), ..Feel::FREE },
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
    /// N·m/s.
    let_go: f32,
    /// Whether the encoder's count falls as the angle rises.
    reversed: bool,
}

/// Which number of a knob is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum KnobError {
    /// The table is empty, or has more than 256 entries.
    Feels,
    /// A feel makes no sense by itself.
    Feel(FeelError),
    /// A feel is stiffer than the device's limit.
    Stiffness,
    /// A feel has more damping than the device's limit.
    Damping,
    /// A feel has more torque than the device.
    Torque,
    /// The release rate is not positive and finite.
    LetGo,
}

impl KnobError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Feels => "a knob has 1 to 256 feels",
            Self::Feel(error) => error.message(),
            Self::Stiffness => "a feel is stiffer than the device's maximum stiffness times its radius squared",
            Self::Damping => "a feel damps more than the device's maximum damping times its radius squared",
            Self::Torque => "a feel requests more torque than the device's maximum force times its radius",
            Self::LetGo => "the torque released per second must be positive and finite",
        }
    }
}

crate::message::display!(KnobError);

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
    /// Whole turns of the dial that are no part of its angle.
    turns: i32,
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
}

impl Knob {
    /// The feels of a dial, checked against its device. `let_go` is the release rate of the old torque after a switch,
    /// N·m/s.
    ///
    /// # Errors
    /// The first number that is refused.
    pub const fn try_new(device: &Device<Dial, 1>, feels: &'static [Feel], let_go: f32) -> Result<Self, KnobError> {
        let radius = device.kinematics.radius_m;
        let most = device.max_force_n * radius;
        if feels.is_empty() || feels.len() > 256 {
            return Err(KnobError::Feels);
        }
        let mut index = 0;
        while index < feels.len() {
            let feel = &feels[index];
            if let Err(error) = feel.check() {
                return Err(KnobError::Feel(error));
            }
            // Written so that NaN is refused.
            let bears_stiffness = feel.stiffness() <= device.max_stiffness_n_per_m * radius * radius;
            let bears_damping = feel.greatest_damping() <= device.max_damping_n_s_per_m * radius * radius;
            let bears_torque = feel.torque_between_ends() <= most;
            if !bears_stiffness {
                return Err(KnobError::Stiffness);
            }
            if !bears_damping {
                return Err(KnobError::Damping);
            }
            if !bears_torque {
                return Err(KnobError::Torque);
            }
            index += 1;
        }
        if let_go > 0.0 && let_go < f32::INFINITY {
            let reversed = device.encoders[0].radians_per_count < 0.0;
            Ok(Self { feels, radius, most, let_go, reversed })
        } else {
            Err(KnobError::LetGo)
        }
    }

    /// [`Self::try_new`] for a `static`: invalid numbers are compile errors.
    ///
    /// # Panics
    /// At compile time, naming the number.
    pub const fn new(device: &Device<Dial, 1>, feels: &'static [Feel], let_go: f32) -> Self {
        match Self::try_new(device, feels, let_go) {
            Ok(knob) => knob,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// The feels.
    pub const fn feels(&self) -> &'static [Feel] {
        self.feels
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
        if let Some(feel) = self.feels.get(usize::from(state.feel)) {
            let wanted = saturate(feel.torque_after(state.turns, &mut state.click, angle, rate), -self.most, self.most);
            if state.switched {
                state.left_over = state.torque - wanted;
                state.switched = false;
            }
            let step = self.let_go * period;
            state.left_over -= saturate(state.left_over, -step, step);
            state.torque = saturate(wanted + state.left_over, -self.most, self.most);
            state.gap = match &feel.ends {
                Some(ends) => {
                    let angle = wound(state.turns, angle);
                    let [below, above] = [angle - ends.between_rad[0], ends.between_rad[1] - angle];
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
        if usize::from(index) < self.feels.len() && index != state.feel {
            (state.feel, state.switched) = (index, true);
        }
    }

    fn turn(&self, state: &mut KnobWitness, turns: i32) {
        // The encoder may count the other way.
        state.turns = if self.reversed { turns.wrapping_neg() } else { turns };
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
        take(u32::from(self.feel) | u32::from(self.switched) << 8);
        take(self.click as u32);
        take(self.turns as u32);
        for number in [self.torque, self.left_over, self.force, self.gap] {
            take(number.to_bits());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::GIMBAL_KNOB;
    use crate::render::{Ends, Spring, Wave};

    static FEELS: [Feel; 4] = [
        Feel::FREE,
        Feel {
            detents: Some(Wave { pitch_rad: 0.25, torque_n_m: 0.03, centre_rad: 0.0 }),
            damping_n_m_s_per_rad: 5e-4,
            ..Feel::FREE
        },
        Feel { spring: Some(Spring { stiffness_n_m_per_rad: 0.1, rest_rad: 0.0, max_torque_n_m: 0.05 }), ..Feel::FREE },
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
        fn refused(feel: Feel) -> KnobError {
            extern crate std;
            Knob::try_new(&GIMBAL_KNOB, std::boxed::Box::leak(std::boxed::Box::new([feel])), LET_GO).unwrap_err()
        }
        let wave = |pitch, torque| Some(Wave { pitch_rad: pitch, torque_n_m: torque, centre_rad: 0.0 });
        assert_eq!(refused(Feel { detents: wave(0.25, 0.07), ..Feel::FREE }), KnobError::Stiffness);
        assert_eq!(refused(Feel { detents: wave(2.5, 0.07), ..Feel::FREE }), KnobError::Torque);
        assert_eq!(refused(Feel { damping_n_m_s_per_rad: 4e-3, ..Feel::FREE }), KnobError::Damping);
        assert_eq!(refused(Feel { detents: wave(0.0, 0.01), ..Feel::FREE }), KnobError::Feel(FeelError::Detents));
        assert_eq!(Knob::try_new(&GIMBAL_KNOB, &[], LET_GO), Err(KnobError::Feels));
        assert_eq!(Knob::try_new(&GIMBAL_KNOB, &FEELS, 0.0), Err(KnobError::LetGo));
    }
}
