//! Motion of a touching hand: its place on the surface and its height over it, drawn from a seed.

use crate::plant::random::Random;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Where a hand starts and lifts off to over the surface, m.
pub(super) const HEIGHT: f64 = 0.010;

/// Settings of the hand's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchingSettings {
    /// Duration, s; afterwards the hand stays.
    pub duration: f64,
    /// Number of touches in that time.
    pub touches: u32,
    /// Height over the surface at the start, m; later it lifts off by a third to all of this.
    pub start_height: f64,
    /// Minimum and maximum depth below the surface that the hand aims at, m. The surface limits the probe's depth.
    pub press_depth: [f64; 2],
    /// Reach towards the borders while the hand slides and presses, 0 (the middle) to 1 (border to border). In the air
    /// it moves up to the borders.
    pub pressed_reach: f64,
    /// Maximum speed of the point aimed at, m/s. Sliding is slowed down to keep it.
    pub greatest_speed: f64,
}

impl Default for TouchingSettings {
    /// 5 s, 6 touches from 10 mm, aiming 3 to 8 mm deep (with 300 N/m, 1 to 2.5 N), at most 0.5 m/s.
    fn default() -> Self {
        Self {
            duration: 5.0,
            touches: 6,
            start_height: HEIGHT,
            press_depth: [0.003, 0.008],
            pressed_reach: 1.0,
            greatest_speed: 0.5,
        }
    }
}

/// Where on the surface, and how high over it: smooth functions of time drawn from a seed.
pub(super) struct Motion {
    settings: TouchingSettings,
    /// For u and v: frequency, Hz; phase; the ratio and phase of the slower wobble that bends the figure.
    slides: [[f64; 4]; 2],
    /// Height after each touch, and depth of each, m.
    heights: Vec<f64>,
    depths: Vec<f64>,
}

impl Motion {
    pub(super) fn draw(settings: TouchingSettings, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut uniform = |low, high| random.between(low, high);
        // About one sweep to and fro in two seconds, u and v at ratios that do not close the figure.
        let slides = [(); 2].map(|()| [uniform(0.35, 0.6), uniform(0.0, TAU), uniform(0.3, 0.6), uniform(0.0, TAU)]);
        let [least, most] = settings.press_depth;
        let mut heights = vec![settings.start_height];
        let mut depths = Vec::new();
        for _ in 0..settings.touches {
            depths.push(uniform(least, most));
            heights.push(settings.start_height * uniform(1.0 / 3.0, 1.0));
        }
        Self { settings, slides, heights, depths }
    }

    pub(super) fn duration(&self) -> f64 {
        self.settings.duration
    }

    /// A parameter in [0, 1]. The outer sine lingers at the ends, along the border, without stopping short.
    pub(super) fn parameter(&self, axis: usize, time: f64, pace: f64) -> f64 {
        const WOBBLE: f64 = 0.8;
        let [frequency, phase, ratio, wobble_phase] = self.slides[axis];
        let turns = TAU * frequency * pace * time;
        let wave = (turns + phase + WOBBLE * (ratio * turns + wobble_phase).sin()).sin();
        // A hand that starts on the surface is never aloft.
        let aloft = (self.height(time) / self.settings.start_height.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let pressed = self.settings.pressed_reach;
        let reach = pressed + (1.0 - pressed) * ease(aloft);
        0.5 + 0.5 * reach * (FRAC_PI_2 * wave).sin()
    }

    /// Height over the surface, m, negative where the hand presses. A touch is 30 % down, 40 % pressed, 30 % up.
    pub(super) fn height(&self, time: f64) -> f64 {
        let touches = time / self.settings.duration * f64::from(self.settings.touches);
        let index = (touches as usize).min(self.depths.len() - 1);
        let share = (touches - index as f64).min(1.0);
        let (from, depth, to) = (self.heights[index], -self.depths[index], self.heights[index + 1]);
        if share < 0.3 {
            from + (depth - from) * ease(share / 0.3)
        } else if share < 0.7 {
            depth
        } else {
            depth + (to - depth) * ease((share - 0.7) / 0.3)
        }
    }
}

/// 0 to 1 without a jump of speed or acceleration.
fn ease(share: f64) -> f64 {
    share * share * share * (10.0 - share * (15.0 - 6.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_stay_on_the_patch_and_reach_its_borders() {
        let motion = Motion::draw(TouchingSettings { duration: 20.0, ..TouchingSettings::default() }, 9);
        for axis in 0..2 {
            let values: Vec<f64> = (0..20_000).map(|ms| motion.parameter(axis, f64::from(ms) * 1e-3, 1.0)).collect();
            assert!(values.iter().all(|value| (0.0..=1.0).contains(value)));
            let [least, most] =
                [values.iter().copied().fold(1.0, f64::min), values.iter().copied().fold(0.0, f64::max)];
            // At the end of a sweep the parameter is flat to fourth order; a knot is never 0.5 ms off it.
            assert!(least < 1e-9 && most > 1.0 - 1e-9, "{least} {most}");
        }
    }

    #[test]
    fn height_goes_from_the_start_through_every_depth() {
        let settings = TouchingSettings::default();
        let motion = Motion::draw(settings, 9);
        assert_eq!(motion.height(0.0), settings.start_height);
        for touch in 0..settings.touches {
            let middle = (f64::from(touch) + 0.5) * settings.duration / f64::from(settings.touches);
            let depth = -motion.height(middle);
            assert!((settings.press_depth[0]..settings.press_depth[1]).contains(&depth), "{depth}");
        }
        let end = motion.height(settings.duration);
        assert!((settings.start_height / 3.0..settings.start_height).contains(&end), "{end}");
    }
}
