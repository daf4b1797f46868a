//! What a device's motors and joints bear, beyond what its [`super::Device`] says: for a loop that protects them.

/// What a motor's winding bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Endurance {
    /// The torque that it bears for ever, as a share of full duty: continuous current over current at full duty. Above
    /// 1 the amplifier cannot overheat it.
    pub continuous: f32,
    /// Thermal time constant of the winding, s. The housing's is left out: it is minutes, and counting on it would burn
    /// a motor that was warm before the loop began.
    ///
    /// Where nobody states it, take one that is too short: what the model then lets through never warms the winding
    /// beyond what `continuous` does, while one that is too long would.
    pub time_constant_s: f32,
}

impl Endurance {
    /// Of a motor with three phases, each of which bears `phase_current` for ever, A, effective, as data sheets have
    /// it. `current_at_full` is in the scale that keeps the power ([`super::drive::VoltageFeed::three_phase`]).
    ///
    /// A rotor that is held has a field that stands: one phase then carries the whole amplitude, as direct current, and
    /// has twice the heat of a rotor that turns. So the amplitude may be as large as the effective current: no phase is
    /// then warmer than on its data sheet, however little of its heat the other two take over. While the rotor turns,
    /// the model has it warmer than it is.
    pub const fn three_phase(phase_current: f32, current_at_full: f32, time_constant: f32) -> Self {
        // The amplitude of a phase is √(2/3) of that scale's current.
        Self { continuous: phase_current * 1.224_744_9 / current_at_full, time_constant_s: time_constant }
    }
}

/// The supply voltages within which force is given.
///
/// Two may look at it, each in its way. A servo that is guarded makes a fault of a supply that is out of its range, or
/// that nobody measures: a fault is latched. The loop of the boards for the bench *holds*: without a supply the motors
/// are off, and force comes back softly once the supply is there and enable was released, for an emergency stop takes
/// the supply away without anything being wrong. Its range is told in its own settings, and the protection of its servo
/// has none, so that only one of the two looks: a range told there is a fault, for that loop measures none for it.
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

    /// Whether a voltage is within, V. One that is not a number is not.
    #[inline]
    pub fn holds(self, volts: f32) -> bool {
        let millivolts = volts * 1e3;
        self.min_mv as f32 <= millivolts && millivolts <= self.max_mv as f32
    }
}

/// When an encoder counts as mounted against its motor; see `servo/guard/sign.rs` for what is watched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolarityCheck<const JOINTS: usize> {
    /// What turns with each joint, kg·m², about as much as at the middle of the workspace: drum, links and rotor seen
    /// through its transmission.
    pub inertia_kg_m2: [f32; JOINTS],
}

/// What protects a device's motors, and the hand from them. Constant, in flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protection<const JOINTS: usize> {
    /// What each motor bears.
    pub motors: [Endurance; JOINTS],
    /// The greatest speed of each joint while force is given, rad/s.
    pub max_joint_rates_rad_per_s: [f32; JOINTS],
    /// The greatest speed of the probe while force is given, m/s.
    pub max_probe_speed_m_per_s: f32,
    /// The supply's range; `None` where no voltage is measured.
    pub supply: Option<SupplyRange>,
    /// The watch over encoders that count against their motors; `None` where the inertias are not known.
    pub polarity: Option<PolarityCheck<JOINTS>>,
}
