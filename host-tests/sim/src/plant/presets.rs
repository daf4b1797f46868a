//! The devices that can be simulated, and where their numbers come from.
//!
//! Written out again rather than taken from the library, in f64. Friction that no source states is small on purpose:
//! too little is the safe side, for friction hides limit cycles. The delay of one period, where a tick's duty takes
//! effect at the next, the current loop of 0.15 ms (about 1 kHz) and the end stops are assumed for all.

use super::arm::Link;
use super::delta::DeltaSettings;
use super::five_bar::{FiveBarSettings, LinkLump, LinkageArmSettings};
use super::motor::{Amplifier, Winding};
use super::paddle::PaddleSettings;
use super::settings::{ArmSettings, Direction, JointSettings, MechanismSettings, PlantSettings};
use super::thermal::ThermalSettings;
use std::f64::consts::{FRAC_PI_2, PI};

const DEGREE: f64 = PI / 180.0;

const fn with_usual_timing(mechanism: MechanismSettings, joints: [JointSettings; 3]) -> PlantSettings {
    PlantSettings { mechanism, gravity: 9.81, joints, current_time_constant: 1.5e-4, delay_periods: 1.0, sub_steps: 20 }
}

impl PlantSettings {
    /// WoodenHaptics as published in 2016.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | lengths, workspace centre, ratios, counts, torque constant, currents | | the project's CHAI3D driver (woody-experimental, `cWoodenDevice`) |
    /// | link masses 0.170, 0.110 kg; centres 51, 91 mm | | the same; its gravity compensation |
    /// | directions of encoders and motors | | the same, its USB variant: the turntable's encoder counts against its motor |
    /// | link inertias | `m L²/12` | assumed: thin rods |
    /// | turntable | 2.0e-3 kg·m² | assumed: two motors of 0.24 kg at 50 mm, a disc of 0.25 kg and 160 mm |
    /// | rotor | 33.5 g·cm² | assumed: a Maxon RE 30 of 60 W has about this; not checked against its data sheet |
    /// | friction | 5e-4 N·m·s, 0.01 N·m | assumed: published for a Phantom Premium (Çavuşoğlu 2001), the same kind of arm |
    pub const fn wooden_haptics_2016() -> Self {
        const MOTOR: JointSettings = JointSettings {
            ratio: 12.0,
            counts_per_turn: 2_000.0,
            torque_constant: 0.0259,
            current_at_full: 3.0,
            current_limit: 3.0,
            rotor_inertia: 33.5e-7,
            viscous_friction: 5e-4,
            coulomb_friction: 0.01,
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::Arm(ArmSettings {
                base_height: 0.080,
                first_link: Link::rod(0.205, 0.170, 0.051),
                second_link: Link::rod(0.245, 0.110, 0.091),
                workspace_centre: [0.220, 0.0, 0.080],
                turntable_inertia: 2.0e-3,
                balance: [0.0; 2],
                balance_inertia: [0.0; 2],
            }),
            [
                JointSettings { ratio: 16.0, encoder_direction: Direction::Against, stops: [-1.55, 1.55], ..MOTOR },
                JointSettings {
                    encoder_direction: Direction::Against,
                    motor_direction: Direction::Against,
                    stops: [-0.75, 2.15],
                    ..MOTOR
                },
                JointSettings { stops: [-1.15, 1.75], ..MOTOR },
            ],
        )
    }

    /// A Phantom Premium's size of arm.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | lengths, ratios, torque constant, peak torque, rotor inertia, friction | | a public implementation of the model of Çavuşoğlu, Feygin and Tendick (2001), with its new measurements |
    /// | forearm, drums, counterweights | masses, centres, inertias | the same, converted to this arm's form: masses on a link's own axis become an inertia and a moment |
    /// | turntable | 1.7e-3 kg·m² | the same, without the small change with the pose |
    /// | counts | 4,000 | assumed: gives the published 0.03 mm |
    pub const fn phantom_premium() -> Self {
        const MOTOR: JointSettings = JointSettings {
            ratio: 11.2,
            counts_per_turn: 4_000.0,
            encoder_direction: Direction::Against,
            angle_at_zero: FRAC_PI_2,
            motor_direction: Direction::Against,
            torque_constant: 0.0234,
            current_at_full: 5.5,
            current_limit: 5.5,
            rotor_inertia: 1.08e-6,
            viscous_friction: 5e-4,
            coulomb_friction: 0.01,
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::Arm(ArmSettings {
                base_height: 0.0,
                first_link: Link { length: 0.20955, mass: 0.0, centre: 0.0, inertia: 0.0 },
                second_link: Link { length: 0.169545, mass: 0.02622, centre: 0.05237892, inertia: 6.004e-5 },
                workspace_centre: [0.20955, 0.0, -0.169545],
                turntable_inertia: 1.7e-3,
                // Motor and drum of one link balance it against the rod of the other.
                balance: [0.10477739 * 0.026146 - 0.03518875 * 0.26784, 0.03175 * 0.026146 - 0.05153541 * 0.21542],
                balance_inertia: [1.5723e-3, 7.567e-4],
            }),
            [
                JointSettings {
                    ratio: 13.3,
                    encoder_direction: Direction::With,
                    angle_at_zero: 0.0,
                    motor_direction: Direction::With,
                    stops: [-1.55, 1.55],
                    ..MOTOR
                },
                JointSettings { stops: [-0.48, 3.70], ..MOTOR },
                JointSettings { stops: [-2.13, 2.04], ..MOTOR },
            ],
        )
    }

    /// Polhem, second version.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | linkage, capstans, counts, torque constants, currents, directions, link masses and centres | | forsslund/hfabapi, `hfab_polhem.h` and the `polhem_v3` configuration |
    /// | links' inertia about their centres | `m L²/12` of the link's length | assumed |
    /// | turntable, rotors, friction | as WoodenHaptics | assumed |
    pub const fn polhem_v2() -> Self {
        const MOTOR: JointSettings = JointSettings {
            ratio: 0.100 / 0.0137281,
            counts_per_turn: 4_096.0,
            torque_constant: 0.0538,
            current_at_full: 3.0,
            current_limit: 3.0,
            rotor_inertia: 33.5e-7,
            viscous_friction: 5e-4,
            coulomb_friction: 0.01,
            ..JointSettings::NONE
        };
        const fn link(mass: f64, along: f64, across: f64, length: f64) -> LinkLump {
            LinkLump { mass, along, across, inertia: mass * length * length / 12.0 }
        }
        with_usual_timing(
            MechanismSettings::LinkageArm(LinkageArmSettings {
                linkage: FiveBarSettings {
                    second_pivot: -0.034,
                    cranks: [0.165, 0.025],
                    rods: [0.034, 0.190],
                    tool: -0.1308,
                    side: -1.0,
                    bends: [1.0, 1.0],
                    workspace_centre: [0.0; 2],
                    links: [
                        link(0.15764, 0.030123, 0.000484, 0.165),
                        link(0.07733, -0.004086, 0.001911, 0.025),
                        link(0.11265, 0.061701, 0.000576, 0.1308),
                        link(0.09767, 0.087765, 0.001978, 0.190),
                    ],
                    tool_mass: 0.0,
                },
                pivot_reach: 0.017,
                workspace_centre: [0.2045, 0.0, 0.0325],
                turntable_inertia: 2.0e-3,
            }),
            [
                JointSettings { ratio: 0.175 / 0.0288534, torque_constant: 0.0603, stops: [-2.15, 2.15], ..MOTOR },
                JointSettings {
                    ratio: 0.100 / 0.0136981,
                    encoder_direction: Direction::Against,
                    motor_direction: Direction::Against,
                    stops: [0.25, 2.35],
                    ..MOTOR
                },
                JointSettings { stops: [1.05, 4.25], ..MOTOR },
            ],
        )
    }

    /// Hapkit, the one-joint paddle, on a bridge.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | handle, sector, pulley, counts | | reitermarkus/hapkit, `constants.hpp` |
    /// | winding | 10 Ω, 0.025 N·m/A, 12 V | assumed: together the published 0.03 N·m |
    /// | inductance, rotor, paddle, friction | 1 mH, 5 g·cm², 60 g at 25 mm, 2e-4 N·m·s, 2e-3 N·m | assumed |
    pub const fn hapkit() -> Self {
        const RATIO: f64 = 0.073152 / 0.004191;
        let joint = JointSettings {
            ratio: RATIO,
            counts_per_turn: 726.6 * 36.0 / RATIO,
            amplifier: Amplifier::Voltage(Winding { supply: 12.0, resistance: 10.0, inductance: 1e-3 }),
            torque_constant: 0.025,
            current_at_full: 1.2,
            current_limit: 2.4,
            rotor_inertia: 5e-7,
            viscous_friction: 2e-4,
            coulomb_friction: 2e-3,
            stops: [-0.77, 0.77],
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::Paddle(PaddleSettings { handle: 0.065659, inertia: 1e-4, mass: 0.06, centre: 0.025 }),
            [joint, JointSettings::NONE, JointSettings::NONE],
        )
    }

    /// Haply 2diy, third version, flat on the table.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | lengths, counts, start angles (the stops behind), torque | | Haply's course material |
    /// | winding | 4 Ω, 3 A on 12 V, 1 mH; ratio 4,880/2,048 | assumed: together the stated 0.123 N·m |
    /// | cranks 20 g, rods 12 g, handle 25 g, rotor 5 g·cm², friction 1e-4 N·m·s, 2e-3 N·m | | assumed |
    pub const fn haply_2diy_v3() -> Self {
        const RATIO: f64 = 4_880.0 / 2_048.0;
        const JOINT: JointSettings = JointSettings {
            ratio: RATIO,
            counts_per_turn: 2_048.0,
            angle_at_zero: 168.0 * DEGREE,
            amplifier: Amplifier::Voltage(Winding { supply: 12.0, resistance: 4.0, inductance: 1e-3 }),
            torque_constant: 0.123 / 3.0 / RATIO,
            current_at_full: 3.0,
            current_limit: 6.0,
            rotor_inertia: 5e-7,
            viscous_friction: 1e-4,
            coulomb_friction: 2e-3,
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::FiveBar(pantograph(0.038, 0.07, 0.09, [0.019, 0.1])),
            [
                JointSettings { stops: [0.83, 168.0 * DEGREE], ..JOINT },
                JointSettings { angle_at_zero: 12.0 * DEGREE, stops: [12.0 * DEGREE, 2.27], ..JOINT },
                JointSettings::NONE,
            ],
        )
    }

    /// Haply development kit, first version, flat on the table. Sources as for the 2diy: HaplyHaptics/Haply-API; 1,024
    /// counts a turn of the motor, 12 Ω and 1 A are assumed, and the links' masses.
    pub const fn haply_kit_v1() -> Self {
        const JOINT: JointSettings = JointSettings {
            ratio: 13.5,
            counts_per_turn: 1_024.0,
            angle_at_zero: PI,
            amplifier: Amplifier::Voltage(Winding { supply: 12.0, resistance: 12.0, inductance: 1e-3 }),
            torque_constant: 0.123 / 13.5,
            current_at_full: 1.0,
            current_limit: 2.0,
            rotor_inertia: 1e-7,
            viscous_friction: 1e-4,
            coulomb_friction: 2e-3,
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::FiveBar(pantograph(0.02, 0.05, 0.07, [0.01, 0.075])),
            [
                JointSettings { stops: [0.83, 3.37], ..JOINT },
                JointSettings { angle_at_zero: 0.0, stops: [-0.27, 2.27], ..JOINT },
                JointSettings::NONE,
            ],
        )
    }

    /// Novint Falcon.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | lengths, leg directions, drum, counts, zero | | libnifalcon, `FalconGeometry.h` |
    /// | friction | 0.05 N·m a joint | its sum at the probe is of the size of the published 1.2 to 3.6 N (CHAI3D) |
    /// | torque | 0.53 N·m a joint, a current loop | assumed: 8.9 N in every direction at the workspace centre |
    /// | plate with grip 150 g, shins 15 g, thighs 60 g at 20 mm and 1.5e-4 kg·m², rotor 20 g·cm² | | assumed |
    pub const fn novint_falcon() -> Self {
        const RATIO: f64 = 0.110 / 0.01425;
        const JOINT: JointSettings = JointSettings {
            ratio: RATIO,
            counts_per_turn: 1_280.0,
            angle_at_zero: 35.0 * DEGREE,
            torque_constant: 0.53 / 2.0 / RATIO,
            current_at_full: 2.0,
            current_limit: 2.0,
            rotor_inertia: 2e-6,
            viscous_friction: 1e-3,
            coulomb_friction: 0.05,
            stops: [-0.72, 1.27],
            ..JointSettings::NONE
        };
        with_usual_timing(
            MechanismSettings::Delta(DeltaSettings {
                a: 0.060,
                b: 0.1025,
                c: 0.01443,
                d: 0.01125,
                e: 0.01125,
                f: -0.025,
                r: 0.040,
                s: -0.02309,
                legs: [105.0 * DEGREE, -15.0 * DEGREE, -135.0 * DEGREE],
                workspace_depth: 0.120,
                thigh_inertia: 1.5e-4,
                shin_mass: 0.015,
                plate_mass: 0.150,
                thigh_mass: 0.060,
                thigh_centre: 0.020,
            }),
            [JOINT; 3],
        )
    }
}

/// A symmetric pantograph whose handle is the hinge, bent outward: uniform rods for links.
const fn pantograph(second_pivot: f64, crank: f64, rod: f64, workspace_centre: [f64; 2]) -> FiveBarSettings {
    FiveBarSettings {
        second_pivot,
        cranks: [crank; 2],
        rods: [rod; 2],
        tool: rod,
        side: 1.0,
        bends: [1.0, -1.0],
        workspace_centre,
        links: [
            LinkLump::rod(0.020, crank),
            LinkLump::rod(0.020, crank),
            LinkLump::rod(0.012, rod),
            LinkLump::rod(0.012, rod),
        ],
        tool_mass: 0.025,
    }
}

/// Heat of each joint's motor. Data sheets of motors with these torque constants, from memory and not checked against
/// the sheets; for a device with an unknown motor the numbers are assumed, and marked as such.
impl PlantSettings {
    /// WoodenHaptics: a Maxon RE 30 of 24 V, 25.9 mN·m/A.
    pub const WOODEN_HAPTICS_HEAT: [ThermalSettings; 3] = [RE_30_24_V; 3];
    /// Polhem: 60.3 mN·m/A is a Maxon RE 40 of 48 V, 53.8 mN·m/A an RE 30 of 48 V.
    pub const POLHEM_HEAT: [ThermalSettings; 3] = [
        ThermalSettings {
            resistance: 1.16,
            winding_to_housing: 1.9,
            housing_to_air: 4.65,
            winding_time_constant: 41.5,
            housing_time_constant: 1_120.0,
            greatest: 155.0,
        },
        ThermalSettings { resistance: 2.52, ..RE_30_24_V },
        ThermalSettings { resistance: 2.52, ..RE_30_24_V },
    ];
    /// Phantom: 23.4 mN·m/A is a Maxon RE 25 of 24 V.
    pub const PHANTOM_HEAT: [ThermalSettings; 3] = [ThermalSettings {
        resistance: 2.32,
        winding_to_housing: 3.1,
        housing_to_air: 14.0,
        winding_time_constant: 12.4,
        housing_time_constant: 910.0,
        greatest: 125.0,
    }; 3];
    /// Falcon: assumed, a brushed motor of 37 mm.
    pub const FALCON_HEAT: [ThermalSettings; 3] = [ThermalSettings {
        resistance: 2.5,
        winding_to_housing: 4.0,
        housing_to_air: 10.0,
        winding_time_constant: 20.0,
        housing_time_constant: 800.0,
        greatest: 120.0,
    }; 3];
}

const RE_30_24_V: ThermalSettings = ThermalSettings {
    resistance: 0.611,
    winding_to_housing: 1.7,
    housing_to_air: 6.0,
    winding_time_constant: 16.2,
    housing_time_constant: 714.0,
    greatest: 125.0,
};
