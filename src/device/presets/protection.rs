//! Protection of the devices that ship.
//!
//! The continuous currents and time constants are those of motors with the torque constants that the sources state,
//! from memory of their data sheets and not checked against these; inertias are those of the simulated devices at the
//! middle of their workspaces. Check yours against your motors' data sheets. The maximum speeds are ours: a hand that
//! touches a surface stays below them, one that is let go from deep in a wall is found by its energy, too.

use crate::device::{Endurance, PolarityCheck, Protection};

/// A Maxon RE 30 of 24 V: 3.4 A continuous, 16 s; the device's amplifiers give 3 A.
const RE_30_24_V: Endurance = Endurance { continuous: 1.1, time_constant_s: 16.0 };
/// A Maxon RE 30 of 48 V: 1.66 A of 3 A.
const RE_30_48_V: Endurance = Endurance { continuous: 0.55, time_constant_s: 16.0 };
/// A Maxon RE 40 of 48 V: 3.1 A of 3 A.
const RE_40_48_V: Endurance = Endurance { continuous: 1.03, time_constant_s: 41.0 };
/// A Maxon RE 25 of 24 V: the published nominal 0.0286 of 0.129 N·m.
const RE_25_24_V: Endurance = Endurance { continuous: 0.22, time_constant_s: 12.0 };

/// Of [`super::WOODEN_HAPTICS_2016`].
pub const WOODEN_HAPTICS_2016_PROTECTION: Protection<3> = Protection {
    motors: [RE_30_24_V; 3],
    max_joint_rates_rad_per_s: [15.0; 3],
    max_probe_speed_m_per_s: 1.5,
    supply: None,
    polarity: Some(PolarityCheck { inertia_kg_m2: [4.8e-3, 6.1e-3, 1.9e-3] }),
};

/// Of [`super::POLHEM_V2`].
pub const POLHEM_V2_PROTECTION: Protection<3> = Protection {
    motors: [RE_40_48_V, RE_30_48_V, RE_30_48_V],
    max_joint_rates_rad_per_s: [20.0, 20.0, 30.0],
    max_probe_speed_m_per_s: 1.5,
    supply: None,
    polarity: Some(PolarityCheck { inertia_kg_m2: [5.1e-3, 4.8e-3, 5.6e-4] }),
};

/// Of [`super::PHANTOM_PREMIUM`]. Its continuous 1.4 N is the rating of a Phantom Premium 1.5.
pub const PHANTOM_PREMIUM_PROTECTION: Protection<3> = Protection {
    motors: [RE_25_24_V; 3],
    max_joint_rates_rad_per_s: [15.0; 3],
    max_probe_speed_m_per_s: 1.5,
    supply: None,
    polarity: Some(PolarityCheck { inertia_kg_m2: [3.0e-3, 2.9e-3, 1.0e-3] }),
};

/// Of [`super::NOVINT_FALCON`]: motors assumed, for no source states them.
pub const NOVINT_FALCON_PROTECTION: Protection<3> = Protection {
    motors: [Endurance { continuous: 0.5, time_constant_s: 20.0 }; 3],
    max_joint_rates_rad_per_s: [40.0; 3],
    max_probe_speed_m_per_s: 1.5,
    supply: None,
    polarity: Some(PolarityCheck { inertia_kg_m2: [3.7e-4; 3] }),
};
