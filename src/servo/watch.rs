//! Checks around the tick: bridged sensor frames, the tick's deadline, and stuck sensors.

use super::{Guard, Input, Phase, Servo, ServoState, StuckLimits, Surface};
use crate::device::sensor::ErrorRate;
use crate::device::{Counts, Kinematics};
use crate::math::Vec3;

/// Puts a prediction in the place of a few bad frames in a row: the last good counts, carried on at the rates estimated
/// then. The next bad one reaches the loop as it came, and is a fault in that tick. So does a bad frame while more than
/// 1 % of the frames are bad ([`Self::rate`]): single good frames between bad ones do not hide a failing cable.
///
/// **This is the one exception to "a fault in the same tick".** A motor's switching corrupts a frame of a digital
/// sensor now and then, and a loop that then drops its force hits the hand. For two ticks, half a millisecond at 4 kHz,
/// a hand at 1 m/s that brakes with 20 m/s² comes 2.5 µm nearer than predicted: less than a count. After a fault, and
/// before the first counts, nothing is bridged.
///
/// It stands before [`Servo::tick`]; a loop without it has no exception.
///
/// ```
/// use palpate::device::SerialArm;
/// use palpate::patch::SplinePatch;
/// use palpate::servo::{FrameBridge, Input, Output, Servo, State};
///
/// type App = Servo<'static, SplinePatch<'static>, SerialArm, 3>;
///
/// /// The timer's interrupt.
/// fn on_timer(
///     servo: &App,
///     state: &mut State<App>,
///     bridge: &mut FrameBridge<3>,
///     input: Input<3>,
///     enable: bool,
/// ) -> Output<3> {
///     let input = bridge.input(servo, state, input, enable);
///     servo.tick(state, input)
/// }
/// # let _ = on_timer;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameBridge<const JOINTS: usize> {
    max_in_a_row: u32,
    in_a_row: u32,
    total: u32,
    rate: ErrorRate<10>,
    /// The last good counts, and counts a tick.
    from: ([Counts; JOINTS], [f32; JOINTS]),
}

impl<const JOINTS: usize> FrameBridge<JOINTS> {
    /// How many bad frames in a row are bridged unless you choose.
    pub const DEFAULT_IN_A_ROW: u32 = 2;
    /// The maximum rate of bad frames, in 10,000.
    pub const MAX_RATE: u32 = 100;

    /// A bridge over at most `max_in_a_row` consecutive bad frames; 0 bridges none.
    pub const fn new(max_in_a_row: u32) -> Self {
        let from = ([Counts(0); JOINTS], [0.0; JOINTS]);
        Self { max_in_a_row, in_a_row: 0, total: 0, rate: ErrorRate::START, from }
    }

    /// Bad frames bridged so far.
    pub const fn total(&self) -> u32 {
        self.total
    }

    /// The rate of bad frames, over the last thousand or so.
    pub const fn rate(&self) -> ErrorRate<10> {
        self.rate
    }

    /// The input of the tick: `input` itself, or a prediction in its place, with `enable` as it is now.
    #[inline]
    pub fn input<S: Surface, K: Kinematics<JOINTS>, G: Guard<JOINTS>>(
        &mut self,
        servo: &Servo<'_, S, K, JOINTS, G>,
        state: &ServoState<JOINTS, S::Witness, G::State>,
        input: Input<JOINTS>,
        enable: bool,
    ) -> Input<JOINTS> {
        let is_good = matches!(input, Input::Sensors { .. });
        self.rate = self.rate.next(!is_good);
        if is_good {
            self.in_a_row = 0;
            return input;
        }
        let Some(counts) = state.counts() else { return input };
        let is_too_often = self.in_a_row >= self.max_in_a_row || self.rate.is_above(Self::MAX_RATE);
        if is_too_often || state.phase() == Phase::Fault {
            return input;
        }
        if self.in_a_row == 0 {
            let mut steps = state.rates();
            for (step, encoder) in steps.iter_mut().zip(&servo.core.device.encoders) {
                *step *= servo.core.period / encoder.radians_per_count;
            }
            self.from = (counts, steps);
        }
        self.in_a_row += 1;
        self.total = self.total.wrapping_add(1);
        let (mut counts, steps) = self.from;
        for (Counts(count), step) in counts.iter_mut().zip(steps) {
            let moved = step * self.in_a_row as f32;
            // To nearest: the cast truncates. It saturates, and makes a NaN 0.
            *count = count.wrapping_add((moved + if moved < 0.0 { -0.5 } else { 0.5 }) as i32);
        }
        Input::Sensors { counts, enable }
    }
}

/// The time a tick may take, in counts of the board's free-running counter (cycles, timer ticks).
///
/// ```
/// use palpate::servo::Deadline;
///
/// /// A cycle counter of 170 MHz, and a loop at 4 kHz.
/// const DEADLINE: Deadline = Deadline::of_period(170e6, 4_000.0);
/// assert_eq!(DEADLINE.counts, 42_500);
/// assert!(!DEADLINE.overrun(u32::MAX - 999, 20_000), "21,000 counts, over the counter's wrap");
/// assert!(DEADLINE.overrun(0, 42_501));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Deadline {
    /// The most counts from the tick's interrupt to the duties applied.
    pub counts: u32,
}

impl Deadline {
    /// The deadline of a loop at `rate` Hz timed by a counter of `frequency` Hz: one period.
    pub const fn of_period(frequency: f32, rate: f32) -> Self {
        Self { counts: (frequency / rate) as u32 }
    }

    /// Whether a tick was late, from the counts at its start and end. The counter may wrap once between.
    pub const fn overrun(self, began: u32, ended: u32) -> bool {
        ended.wrapping_sub(began) > self.counts
    }
}

/// The time from the start of one tick to the start of the next, in counts of the board's free-running counter: from
/// half a period to one and a half.
///
/// A tick that starts early is as much of a fault as one that starts late: the counter may stand still, and then
/// nothing that it times would ever be late again.
///
/// ```
/// use palpate::servo::PeriodWindow;
///
/// const WINDOW: PeriodWindow = PeriodWindow::of_period(170e6, 4_000.0);
/// assert!(WINDOW.contains(u32::MAX - 99, 42_400), "a period, over the counter's wrap");
/// assert!(!WINDOW.contains(7, 63_758), "more than one and a half");
/// assert!(!WINDOW.contains(7, 7), "the counter stands still");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeriodWindow {
    /// The minimum.
    pub min_counts: u32,
    /// The maximum.
    pub max_counts: u32,
}

impl PeriodWindow {
    /// The window of a loop at `rate` Hz timed by a counter of `frequency` Hz. The interrupts that a board masks delay
    /// a tick by far less than half a period.
    pub const fn of_period(frequency: f32, rate: f32) -> Self {
        Self { min_counts: (0.5 * frequency / rate) as u32, max_counts: (1.5 * frequency / rate) as u32 }
    }

    /// Whether a tick that starts at `began` comes in time after one that started at `last`.
    pub const fn contains(self, last: u32, began: u32) -> bool {
        let counts = began.wrapping_sub(last);
        self.min_counts <= counts && counts <= self.max_counts
    }
}

/// Decides whether the hardware watchdog may be fed: only where at least a given number of ticks has passed since
/// it was fed last. A watchdog with a window then finds a program that feeds it too early.
///
/// Feed it from the idle loop with this, never from the tick's own interrupt: then either of the two that hangs is
/// found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heartbeat {
    ticks: u32,
    apart: u32,
}

impl Heartbeat {
    /// Feeds once in this number of ticks at most.
    pub const fn every(ticks: u32) -> Self {
        Self { ticks: 0, apart: if ticks > 0 { ticks } else { 1 } }
    }

    /// Whether to feed, from [`super::ServoState::ticks`].
    pub const fn may_feed(&mut self, ticks: u32) -> bool {
        let beats = ticks.wrapping_sub(self.ticks) >= self.apart;
        if beats {
            self.ticks = ticks;
        }
        beats
    }
}

impl Default for Heartbeat {
    fn default() -> Self {
        Self::every(1)
    }
}

/// The state of the check for stuck sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stillness<const JOINTS: usize> {
    /// Whose turn it is: the probe's, or a joint's, counted from 1.
    pub turn: u8,
    /// Joints whose load at the end of the last piece is not counted yet.
    pub due: u8,
    /// How many straight pieces the probe has come since each joint moved by a count, while it carried a load.
    pub pieces: [u8; JOINTS],
    /// The time of the first of them, s/64.
    pub since: [u8; JOINTS],
    /// The last count of each joint.
    pub counts: [Counts; JOINTS],
    /// Start of the present piece, m.
    pub mark: Vec3,
}

/// Straight pieces of the travel that makes a sensor count as stuck; the first may be a part of one. Short, because the
/// loop sees less of the probe's way where the stuck joint is the one that moves.
const PIECES: u8 = 6;

/// The minimum time of the travel from its first piece on, s/64 for each metre: that of 40 mm/s. A fast slide is over before
/// a hand's unsteadiness shows in a joint that geometry keeps still; see [`StuckLimits`].
const LEAST: f32 = 64.0 / 0.04;
/// The same of any travel at most: half of the time after which `since` wraps.
const LONGEST: f32 = 128.0;

impl<const JOINTS: usize> Stillness<JOINTS> {
    /// Before the first tick.
    pub const START: Self = Self {
        turn: 0,
        due: 0,
        pieces: [0; JOINTS],
        since: [0; JOINTS],
        counts: [Counts(0); JOINTS],
        mark: Vec3::ZERO,
    };

    /// Checks the probe's way or the next joint, one per tick: whether it has not moved by a count under load while the probe came far.
    ///
    /// `felt` is the torque of the contact force on each joint, N·m, without gravity compensation, which the links'
    /// weight balances; `friction` is each joint's dry friction; `now` is the time, s/64. A joint whose friction is not
    /// known is not checked.
    #[inline]
    pub(super) fn is_broken(
        &mut self,
        limits: StuckLimits,
        now: impl Fn() -> u8,
        friction: &[f32; JOINTS],
        counts: &[Counts; JOINTS],
        probe: Vec3,
        felt: &[f32; JOINTS],
    ) -> bool {
        let turn = usize::from(self.turn);
        if turn == 0 || turn > JOINTS {
            self.turn = 1;
            let piece = limits.travel_m * (1.0 / PIECES as f32);
            if (probe - self.mark).length_squared() > piece * piece {
                (self.mark, self.due) = (probe, JOINTS as u8);
            }
            return false;
        }
        let joint = turn - 1;
        self.turn += 1;
        if self.due > 0 {
            self.due -= 1;
            let friction = friction[joint];
            let bears = felt[joint].abs() > limits.load * friction && friction > 0.0;
            if self.pieces[joint] == 0 {
                self.since[joint] = now();
            }
            self.pieces[joint] = self.pieces[joint].saturating_add(u8::from(bears));
        }
        if counts[joint] != self.counts[joint] {
            (self.counts[joint], self.pieces[joint]) = (counts[joint], 0);
        }
        if self.pieces[joint] <= PIECES {
            return false;
        }
        let least = limits.travel_m * LEAST;
        let least = if least < LONGEST { least } else { LONGEST };
        f32::from(now().wrapping_sub(self.since[joint])) >= least
    }
}

#[cfg(test)]
mod deadline_tests {
    use super::*;

    #[test]
    fn a_tick_is_late_beyond_its_period_also_where_the_counter_wraps() {
        let deadline = Deadline::of_period(168e6, 4_000.0);
        assert_eq!(deadline.counts, 42_000);
        assert!(!deadline.overrun(10, 42_010) && deadline.overrun(10, 42_011));
        assert!(!deadline.overrun(u32::MAX - 9, 41_990) && deadline.overrun(u32::MAX - 9, 41_991));
    }

    #[test]
    fn a_period_is_in_time_from_half_of_its_length_to_one_and_a_half() {
        // 42,500 cycles.
        let window = PeriodWindow::of_period(170e6, 4_000.0);
        for (counts, is_in_time) in [(0, false), (21_249, false), (21_250, true), (63_750, true), (63_751, false)] {
            for last in [0, u32::MAX - 30_000] {
                assert_eq!(window.contains(last, last.wrapping_add(counts)), is_in_time, "{counts} from {last}");
            }
        }
    }

    #[test]
    fn the_watchdog_starves_when_ticks_stop() {
        let mut heartbeat = Heartbeat::default();
        assert!(heartbeat.may_feed(5) && heartbeat.may_feed(6));
        assert!(!heartbeat.may_feed(6));
        let mut slow = Heartbeat::every(8);
        let fed = [7, 8, 15, 16, 16, 30].map(|ticks| slow.may_feed(ticks));
        assert_eq!(fed, [false, true, false, true, false, true]);
    }
}

#[cfg(test)]
mod stuck_tests {
    use super::*;

    const LIMITS: StuckLimits = StuckLimits { load: 2.0, travel_m: 0.06 };

    /// The tick at which it is found, the second joint drawing the probe to and fro over `stroke` m, a third of a
    /// millimetre a tick, and the first as told.
    fn found(first: impl Fn(u32) -> i32, stroke: f32, felt: f32, friction: f32) -> Option<u32> {
        // 40 mm/s.
        found_at(120.0, first, stroke, felt, friction)
    }

    /// At a rate, Hz.
    fn found_at(rate: f32, first: impl Fn(u32) -> i32, stroke: f32, felt: f32, friction: f32) -> Option<u32> {
        let mut stillness = Stillness::<2>::START;
        let ticks = (stroke * 3_000.0) as u32;
        (1..3_000).find(|tick| {
            let way = if (tick / ticks).is_multiple_of(2) { tick % ticks } else { ticks - tick % ticks };
            let counts = [Counts(first(*tick)), Counts(way as i32)];
            let probe = Vec3::X * (way as f32 / 3_000.0);
            stillness.is_broken(
                LIMITS,
                || (*tick as f32 / rate * 64.0) as u32 as u8,
                &[friction; 2],
                &counts,
                probe,
                &[felt; 2],
            )
        })
    }

    #[test]
    fn a_joint_that_stands_still_under_load_while_another_moves_is_stuck() {
        // After 60 mm at least and 80 at most, and at every second tick; over and back just as straight on.
        for stroke in [0.9, 0.045] {
            assert!(matches!(found(|_| 500, stroke, -0.3, 0.1), Some(180..=250)), "{stroke}");
        }
        assert_eq!(found(|_| 500, 0.008, 0.3, 0.1), None, "a count that flickers is no travel");
        assert_eq!(found(|_| 500, 0.9, 0.19, 0.1), None, "what friction holds may rest");
        assert_eq!(found(|_| 500, 0.9, 0.3, 0.0), None, "friction that is not known may hold anything");
        assert_eq!(
            found(|tick| if tick % 150 < 75 { 500 } else { 501 }, 0.9, 0.3, 0.1),
            None,
            "a count now and then is life"
        );
    }

    #[test]
    fn a_fast_slide_is_given_the_time_of_one_at_forty_millimetres_a_second() {
        // Ten times as fast: 60 mm are over in 0.15 s, and count in 1.5 s at least.
        let alive = |tick: u32| 500 + i32::from(tick % 1_200 < 600);
        assert_eq!(found_at(1_200.0, alive, 0.045, 0.3, 0.1), None, "a count in half a second is life");
        assert!(matches!(found_at(1_200.0, |_| 500, 0.045, 0.3, 0.1), Some(1_800..=1_900)));
    }
}
