//! Scripted hands: straight legs at steady speeds, rounded where they meet as a hand rounds them.

use crate::plant::{HandPath, Vector};

/// Over how long a hand changes its speed, s: about the time constant of a finger.
const ROUNDING: f64 = 0.03;

/// Straight legs from point to point, averaged over the last 30 ms: position, speed and their changes are continuous
/// but for the jumps of acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Legs {
    /// Time, s, and place, m, of each corner.
    corners: Vec<(f64, Vector)>,
    /// The integral of the place up to each corner, m·s.
    sums: Vec<Vector>,
}

impl Legs {
    /// A hand that waits here.
    pub fn from(place: Vector) -> Self {
        Self { corners: vec![(0.0, place)], sums: vec![[0.0; 3]] }
    }

    /// Moves to a place within `seconds`.
    pub fn to(mut self, place: Vector, seconds: f64) -> Self {
        let (time, last) = *self.corners.last().unwrap_or(&(0.0, place));
        let sum = *self.sums.last().unwrap_or(&[0.0; 3]);
        self.sums.push(core::array::from_fn(|axis| sum[axis] + 0.5 * (last[axis] + place[axis]) * seconds));
        self.corners.push((time + seconds, place));
        self
    }

    /// Moves to a place at `speed`, m/s.
    pub fn at_speed(self, place: Vector, speed: f64) -> Self {
        let from = self.corners.last().map_or(place, |corner| corner.1);
        let distance = (0..3).map(|axis| (place[axis] - from[axis]).powi(2)).sum::<f64>().sqrt();
        self.to(place, distance / speed)
    }

    /// Waits for `seconds`.
    pub fn wait(self, seconds: f64) -> Self {
        let place = self.corners.last().map_or([0.0; 3], |corner| corner.1);
        self.to(place, seconds)
    }

    /// When the last leg ends, s.
    pub fn end(&self) -> f64 {
        self.corners.last().map_or(0.0, |corner| corner.0) + ROUNDING
    }

    /// The place without rounding, and the integral of it from the start.
    fn at(&self, time: f64) -> (Vector, Vector) {
        let (first, last) = (self.corners[0], self.corners[self.corners.len() - 1]);
        if time <= 0.0 {
            return (first.1, first.1.map(|coordinate| coordinate * time));
        }
        if time >= last.0 {
            let sum = self.sums[self.sums.len() - 1];
            return (last.1, core::array::from_fn(|axis| sum[axis] + last.1[axis] * (time - last.0)));
        }
        let leg = self.corners.partition_point(|corner| corner.0 <= time) - 1;
        let ((from, here), (to, there)) = (self.corners[leg], self.corners[leg + 1]);
        let share = (time - from) / (to - from);
        let place: Vector = core::array::from_fn(|axis| here[axis] + share * (there[axis] - here[axis]));
        let sum = core::array::from_fn(|axis| self.sums[leg][axis] + 0.5 * (here[axis] + place[axis]) * (time - from));
        (place, sum)
    }
}

impl HandPath for Legs {
    fn target(&self, time: f64) -> Vector {
        let (now, before) = (self.at(time).1, self.at(time - ROUNDING).1);
        core::array::from_fn(|axis| (now[axis] - before[axis]) / ROUNDING)
    }

    fn velocity(&self, time: f64) -> Vector {
        let (now, before) = (self.at(time).0, self.at(time - ROUNDING).0);
        core::array::from_fn(|axis| (now[axis] - before[axis]) / ROUNDING)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legs() -> Legs {
        Legs::from([0.0, 0.0, 0.02]).wait(0.1).at_speed([0.0, 0.0, -0.004], 0.3).wait(0.2).to([0.03, 0.0, -0.004], 0.5)
    }

    #[test]
    fn it_keeps_its_speed_between_corners_and_ends_where_the_last_leg_does() {
        let legs = legs();
        assert_eq!(legs.target(0.0), [0.0, 0.0, 0.02]);
        // The middle of the way down, beyond the rounding of its start.
        let speed = legs.velocity(0.1 + 0.04);
        assert!((speed[2] + 0.3).abs() < 1e-12, "{speed:?}");
        let end = legs.target(legs.end());
        // Rounding of integrals over a second.
        assert!((end[0] - 0.03).abs() < 1e-12 && (end[2] + 0.004).abs() < 1e-12, "{end:?}");
    }

    #[test]
    fn velocity_is_the_slope_of_the_place_and_does_not_jump() {
        let legs = legs();
        for step in 1..1_000 {
            let time = f64::from(step) * 1.1e-3 + 3e-5;
            let slope = (legs.target(time + 1e-6)[2] - legs.target(time - 1e-6)[2]) / 2e-6;
            // A corner within the step: 0.3 m/s in 30 ms, over a microsecond; rounding of 1e-18/1e-6.
            assert!((slope - legs.velocity(time)[2]).abs() < 2e-5, "{time}: {slope}");
        }
    }
}
