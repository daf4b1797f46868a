//! Limits of a device's motors and joints beyond [`super::Device`]: for a loop that protects them.

/// Thermal rating of a motor's winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Endurance {
    /// Continuous torque limit, as a fraction of full duty: continuous current over current at full duty. Above 1 the
    /// amplifier cannot overheat the winding.
    pub continuous: f32,
    /// Thermal time constant of the winding, s. The housing's is left out: it is minutes, and counting on it would burn
    /// a motor that was warm at the start.
    ///
    /// If the data sheet does not state it, choose a short one: the model then never lets the winding exceed the
    /// temperature of `continuous`; too long a constant would.
    pub time_constant_s: f32,
}

impl Endurance {
    /// Of a motor with three phases with a continuous current of `phase_current` each, A, effective, as in data sheets.
    /// `current_at_full` is in the scale that keeps the power ([`super::drive::VoltageFeed::three_phase`]).
    ///
    /// The field of a rotor at rest is at rest: one phase then carries the whole amplitude, as direct current, and has
    /// twice the heat of a turning rotor. So the amplitude may be as large as the effective current: no phase is then
    /// warmer than on its data sheet, however little of its heat the other two take over. While the rotor turns, the
    /// model overestimates its temperature.
    pub const fn three_phase(phase_current: f32, current_at_full: f32, time_constant: f32) -> Self {
        // The amplitude of a phase is √(2/3) of that scale's current.
        Self { continuous: phase_current * 1.224_744_9 / current_at_full, time_constant_s: time_constant }
    }
}

/// The supply voltages within which force is given.
///
/// Two places can use a range. A guarded servo latches a fault on a supply that is out of its range or not measured.
/// The bench boards' loop *holds* instead: without a supply the motors are off, and force fades in once the supply is
/// back and enable was released, because an emergency stop removes the supply without a fault. That loop has the range
/// in its own settings; leave it `None` in the protection of its servo, which would latch a fault because that loop
/// passes no measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SupplyRange {
    /// Millivolts.
    pub min_mv: u32,
    /// Millivolts: above it a braking hand has pumped the supply up.
    pub max_mv: u32,
}

impl SupplyRange {
    /// Of a supply of 24 V that is on, does not break down, and is not pumped up.
    pub const TWENTY_FOUR: Self = Self { min_mv: 20_000, max_mv: 30_000 };

    /// Whether a voltage is above the range, V.
    #[inline]
    pub fn is_above(self, volts: f32) -> bool {
        volts * 1e3 > self.max_mv as f32
    }

    /// Whether a voltage is within, V. One that is not a number is not.
    #[inline]
    pub fn holds(self, volts: f32) -> bool {
        let millivolts = volts * 1e3;
        self.min_mv as f32 <= millivolts && millivolts <= self.max_mv as f32
    }
}

/// The polarity check: detects an encoder mounted against its motor; see `servo/guard/polarity.rs` for the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolarityCheck<const JOINTS: usize> {
    /// Moment of inertia that turns with each joint, kg·m², about that in the middle of the workspace: drum, links and
    /// rotor seen through its transmission.
    pub inertia_kg_m2: [f32; JOINTS],
}

/// Limits that protect a device's motors and the user's hand. Constant, in flash.
///
/// ```
/// use palpate::device::{Endurance, Protection, SupplyRange};
///
/// const PROTECTION: Protection<1> = Protection {
///     // Continuous current over current at full duty.
///     motors: [Endurance { continuous: 1.2 / 3.0, time_constant_s: 16.0 }],
///     max_joint_rates_rad_per_s: [20.0],
///     max_probe_speed_m_per_s: 1.5,
///     supply: Some(SupplyRange::TWENTY_FOUR),
///     polarity: None,
/// };
/// assert!(PROTECTION.supply.is_some_and(|range| range.holds(24.0) && !range.holds(12.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protection<const JOINTS: usize> {
    /// Each motor's thermal rating.
    pub motors: [Endurance; JOINTS],
    /// Maximum speed of each joint while a contact gives force, and for 50 ms after, rad/s.
    pub max_joint_rates_rad_per_s: [f32; JOINTS],
    /// The same of the probe, m/s.
    pub max_probe_speed_m_per_s: f32,
    /// The supply's range; `None` where no voltage is measured.
    pub supply: Option<SupplyRange>,
    /// The watch over encoders that count against their motors, whose inertias also tell a pressed probe that was let go;
    /// `None` where they are not known.
    pub polarity: Option<PolarityCheck<JOINTS>>,
}
