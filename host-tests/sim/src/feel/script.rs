//! Scripts of the hand: on a flat wall for every device, and over the edges of a body for devices that can reach them.

use super::hand::Legs;
use crate::plant::Vector;

/// Motion of a hand, and the window in which the force is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Name in tables.
    pub name: String,
    /// Its kind.
    pub deed: Deed,
    /// Path of the hand, m in the device's frame.
    pub path: Legs,
    /// Start and end of the window in which ripple is measured, s.
    pub looked_at: [f64; 2],
}

/// Kind of a script.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deed {
    /// Approaches the wall at this speed, m/s, stays, and leaves at the same speed.
    Approach(f64),
    /// Stays on the wall.
    Rest,
    /// Slides along it.
    Slide,
    /// Pulls along it about as hard as friction holds.
    Verge,
    /// Stays half a millimetre in front of it.
    Hover,
    /// Moves in free air.
    Air,
    /// Off the body over a convex edge or a corner at this speed, m/s.
    Off(f64),
    /// From a face to its neighbour; if they meet in an edge, with the directions of the force on both.
    Across(Option<[Vector; 2]>),
}

/// The hand and the wall that scripts are written for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// Joints of the device.
    pub joints: usize,
    /// Stiffness of the wall, N/m.
    pub stiffness: f64,
    /// Stiffness of the hand, N/m.
    pub hand: f64,
    /// The device's dry friction along the wall's normal, N: the hand overcomes it.
    pub dry: f64,
    /// The maximum force of the device, N.
    pub max_force: f64,
}

/// Distance of the hand from the wall at the start, m.
const AWAY: f64 = 0.02;
/// Waiting time at the start, s: the force is faded in.
const WAIT: f64 = 0.3;
/// Time to come to rest before ripple is measured, s.
const SETTLE: f64 = 0.5;
/// Maximum force of a script, as a fraction of the device's maximum force.
const SHARE: f64 = 0.8;
/// Forces from light to firm, N.
const PUSHES: [f64; 3] = [0.3, 1.0, 3.0];

impl Stage {
    /// Depth that the hand aims at to press with a force, N: the sum of the deflections of its own spring and the
    /// wall's.
    pub fn aim(&self, push: f64) -> f64 {
        (push + self.dry) / self.hand + push / self.stiffness
    }

    /// The point at `height` over the wall and `along` it.
    fn at(&self, height: f64, along: f64) -> Vector {
        match self.joints {
            1 => [height, 0.0, 0.0],
            2 => [along, height, 0.0],
            _ => [along, 0.0, height],
        }
    }

    /// All scripts on the wall. Pushes that the device has not the force for are left out.
    pub fn on_the_wall(&self) -> Vec<Script> {
        let mut scripts: Vec<Script> = [0.05, 0.1, 0.3, 0.5].map(|speed| self.approach(speed)).to_vec();
        let pushes = PUSHES.into_iter().filter(|push| *push <= SHARE * self.max_force);
        scripts.extend(pushes.map(|push| self.rest(push)));
        if self.joints > 1 {
            scripts.extend([("light", 0.5), ("firm", 2.0)].map(|(name, push)| self.slide(name, push)));
            scripts.push(self.verge());
        }
        scripts.extend([self.hover(), self.air()]);
        scripts
    }

    fn above(&self, along: f64) -> Legs {
        Legs::from(self.at(AWAY, along)).wait(WAIT)
    }

    fn approach(&self, speed: f64) -> Script {
        let pressed = self.at(-self.aim(f64::min(1.0, SHARE * self.max_force)), 0.0);
        let arrived = self.above(0.0).at_speed(pressed, speed);
        let from = arrived.end() + SETTLE;
        let path = arrived.wait(SETTLE + 0.5).at_speed(self.at(AWAY, 0.0), speed).wait(0.1);
        Script {
            name: format!("approach {speed} m/s"),
            deed: Deed::Approach(speed),
            path,
            looked_at: [from, from + 0.4],
        }
    }

    fn rest(&self, push: f64) -> Script {
        let arrived = self.above(0.0).at_speed(self.at(-self.aim(push), 0.0), 0.05);
        let from = arrived.end() + SETTLE;
        Script {
            name: format!("rest {push} N"),
            deed: Deed::Rest,
            path: arrived.wait(SETTLE + 1.0),
            looked_at: [from, from + 1.0],
        }
    }

    /// 40 mm at 30 mm/s.
    fn slide(&self, name: &str, push: f64) -> Script {
        let depth = -self.aim(push.min(SHARE * self.max_force));
        let arrived = self.above(-0.02).at_speed(self.at(depth, -0.02), 0.05).wait(SETTLE);
        let from = arrived.end() + 0.1;
        let path = arrived.at_speed(self.at(depth, 0.02), 0.03);
        let until = path.end() - 0.1;
        Script { name: format!("slide {name}"), deed: Deed::Slide, path, looked_at: [from, until] }
    }

    /// Pressed with 1 N the hand's aim creeps along the wall, 1 mm a second: friction of 0.3 to 0.4 of it holds, gives
    /// way, and holds again.
    fn verge(&self) -> Script {
        let depth = -self.aim(f64::min(1.0, SHARE * self.max_force));
        let arrived = self.above(0.0).at_speed(self.at(depth, 0.0), 0.05).wait(SETTLE);
        let from = arrived.end();
        let path = arrived.at_speed(self.at(depth, 0.003), 0.001);
        let until = path.end();
        Script { name: "stick-slip on wood".into(), deed: Deed::Verge, path, looked_at: [from, until] }
    }

    fn hover(&self) -> Script {
        let arrived = self.above(0.0).at_speed(self.at(0.0005 + self.dry / self.hand, 0.0), 0.02);
        let from = arrived.end() + SETTLE;
        Script {
            name: "hover 0.5 mm".into(),
            deed: Deed::Hover,
            path: arrived.wait(SETTLE + 1.0),
            looked_at: [from, from + 1.0],
        }
    }

    /// To and fro 10 mm in front of the wall at 100 mm/s; with one joint away from it and back.
    fn air(&self) -> Script {
        let [near, far] = if self.joints == 1 {
            [self.at(0.01, 0.0), self.at(0.03, 0.0)]
        } else {
            [-0.02, 0.02].map(|x| self.at(0.01, x))
        };
        let arrived = Legs::from(near).wait(WAIT);
        let from = arrived.end();
        let path = (0..3).fold(arrived, |path, _| path.at_speed(far, 0.1).at_speed(near, 0.1));
        let until = path.end();
        Script { name: "free air 0.1 m/s".into(), deed: Deed::Air, path, looked_at: [from, until] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::HandPath as _;

    const STAGE: Stage = Stage { joints: 3, stiffness: 1_000.0, hand: 300.0, dry: 0.1, max_force: 5.0 };

    #[test]
    fn a_hand_in_balance_pushes_as_hard_as_it_was_asked_to() {
        for push in PUSHES {
            // At the wall's depth the hand's spring is left with the push and the friction.
            let depth = push / STAGE.stiffness;
            assert!(((STAGE.aim(push) - depth) * STAGE.hand - push - STAGE.dry).abs() < 1e-12);
        }
    }

    #[test]
    fn every_script_is_looked_at_within_its_time_and_along_the_device_s_own_axis() {
        for joints in 1..=3 {
            for script in (Stage { joints, ..STAGE }).on_the_wall() {
                let [from, until] = script.looked_at;
                // Rounding of a sum of times.
                assert!(from > WAIT && until > from + 0.25 && until <= script.path.end() + 1e-9, "{script:?}");
                let start = script.path.target(0.0);
                assert!(start[joints - 1] > 0.005, "{script:?}");
                assert!((joints..3).all(|axis| start[axis] == 0.0), "{script:?}");
            }
        }
    }

    #[test]
    fn what_a_device_has_no_force_for_is_left_out() {
        let names = |max_force| (Stage { max_force, ..STAGE }).on_the_wall().len();
        assert_eq!(names(5.0), names(1.3) + 1);
    }
}
