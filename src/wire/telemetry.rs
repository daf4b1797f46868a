//! Telemetry that does not disturb the loop: a queue of fixed capacity from the servo's interrupt to a sender below it.
//!
//! [`Recorder`] runs in the interrupt, after the duties are applied: a few comparisons a tick, and now and then one
//! record copied into the queue. It never waits. A full queue drops records, and counts them, but costs no time. The
//! code at the other end packs and sends them ([`super::frame::pack`]), or logs them, at low priority.

use super::Record;
use crate::device::Duty;
use crate::servo::{Fault, Phase, Remembered, ServoState, Tracked};
use crate::track::{BoundaryMode, Contact};

/// The queue's type, for those who make one: `Queue<Record, N>` holds `N − 1` records.
pub use heapless::spsc::{Consumer, Producer, Queue};

/// The fields whose change is reported at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct DeviceMessage {
    phase: Phase,
    hold: u8,
    fault: Option<Fault>,
    feature: u16,
    mode: BoundaryMode,
    contact: Contact,
}

/// The interrupt's end of the queue.
///
/// ```
/// use palpate::wire::Record;
/// use palpate::wire::telemetry::{Queue, Recorder};
///
/// let mut queue = Queue::<Record, 16>::new();
/// let (producer, mut consumer) = queue.split();
/// // A counter of 170 MHz, and a record every 40 ticks. Call `note` at the end of each tick's interrupt.
/// let recorder = Recorder::new(producer, 170_000_000, 40);
/// # let _ = recorder;
/// // In the idle loop: pack and send the records.
/// while let Some(record) = consumer.dequeue() {
///     // …
/// #   let _ = record;
/// }
/// ```
pub struct Recorder<'a> {
    queue: Producer<'a, Record>,
    clock: u32,
    every: u32,
    number: u32,
    /// Ticks since the last record.
    waited: u32,
    told: Option<DeviceMessage>,
    /// The counter at the last tick's interrupt.
    began: Option<u32>,
    shortest: u32,
    longest: u32,
    took: u32,
    dropped: u32,
    bridged: u32,
    bad_frames: u16,
    gains: [u8; 3],
    hold: u8,
}

impl<'a> Recorder<'a> {
    /// A recorder that makes a record every `every` ticks, and in between whenever phase, fault, feature, boundary mode
    /// or contact changes. `clock` is the frequency of the board's counter, Hz.
    pub const fn new(queue: Producer<'a, Record>, clock: u32, every: u32) -> Self {
        Self {
            queue,
            clock,
            every,
            number: 0,
            waited: 0,
            told: None,
            began: None,
            shortest: u32::MAX,
            longest: 0,
            took: 0,
            dropped: 0,
            bridged: 0,
            bad_frames: 0,
            gains: [0; 3],
            hold: 0,
        }
    }

    /// Values that only the board knows: bad frames bridged so far, and the reasons that keep the motors off
    /// ([`super::hold`]). It goes into the records from the next tick's on.
    #[inline]
    pub const fn set_board(&mut self, bridged: u32, hold: u8) {
        (self.bridged, self.hold) = (bridged, hold);
    }

    /// The health of the sensors: bad frames in 10,000, and the gain of each magnetic sensor.
    #[inline]
    pub fn set_sensors(&mut self, bad_frames: u16, gains: &[u8]) {
        self.bad_frames = bad_frames;
        for (kept, gain) in self.gains.iter_mut().zip(gains) {
            *kept = *gain;
        }
    }

    /// Takes note of a tick that is done: the counter of 32 bits, which wraps, at its interrupt and at its end.
    #[inline]
    pub fn note<const JOINTS: usize, W: Tracked, G: Remembered>(
        &mut self,
        state: &ServoState<JOINTS, W, G>,
        began: u32,
        ended: u32,
    ) {
        if let Some(last) = self.began.replace(began) {
            let period = began.wrapping_sub(last);
            self.shortest = self.shortest.min(period);
            self.longest = self.longest.max(period);
        }
        self.took = self.took.max(ended.wrapping_sub(began));
        self.waited = self.waited.saturating_add(1);

        let now = DeviceMessage {
            phase: state.phase(),
            hold: self.hold,
            fault: state.fault().map(|(fault, _)| fault),
            feature: state.witness().feature(),
            mode: state.witness().witness().mode,
            contact: state.contact(),
        };
        if self.waited < self.every && self.told == Some(now) {
            return;
        }
        if self.queue.enqueue(self.record(state, began)).is_err() {
            // The change stays due: the next tick tries again.
            self.dropped = self.dropped.saturating_add(1);
            return;
        }
        self.number = self.number.wrapping_add(1);
        (self.told, self.waited) = (Some(now), 0);
        (self.shortest, self.longest, self.took) = (u32::MAX, 0, 0);
    }

    fn record<const JOINTS: usize, W: Tracked, G: Remembered>(
        &self,
        state: &ServoState<JOINTS, W, G>,
        began: u32,
    ) -> Record {
        let (fault, fault_tick) = state.fault().map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        Record {
            tick: state.ticks().wrapping_sub(1),
            number: self.number,
            clock: self.clock,
            began,
            // Before the second tick there is no period.
            shortest: self.shortest.min(self.longest),
            longest: self.longest,
            took: self.took,
            dropped: self.dropped,
            phase: state.phase() as u8,
            fault,
            fault_tick,
            reset: state.reset() as u8,
            overruns: state.overruns(),
            bridged: self.bridged,
            bad_frames: self.bad_frames,
            gains: self.gains,
            hold: self.hold,
            feature: state.witness().feature(),
            mode: state.witness().witness().mode as u8,
            contact: state.contact() as u8,
            gap: state.gap(),
            probe: state.probe().to_array(),
            force: state.force().to_array(),
            duties: first_three(&state.duties()),
        }
    }
}

/// The duties of up to three joints; the rest zero.
pub(super) fn first_three(duties: &[Duty]) -> [i16; 3] {
    let mut three = [0; 3];
    for (said, Duty(duty)) in three.iter_mut().zip(duties) {
        *said = *duty;
    }
    three
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Counts, presets::WOODEN_HAPTICS_2016};
    use crate::math::vec3;
    use crate::patch::{Patch, SecondDerivativeBounds, SurfacePoint};
    use crate::servo::{Config, Event, Input, OnePatch, Servo, Settings};

    /// A plane under the device.
    struct Plane;

    impl Patch for Plane {
        fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
            SurfacePoint {
                point: vec3(u - 0.5, v - 0.5, -0.05),
                tangent_u: vec3(1.0, 0.0, 0.0),
                tangent_v: vec3(0.0, 1.0, 0.0),
            }
        }

        fn bounds(&self) -> SecondDerivativeBounds {
            SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }
        }

        fn orientation(&self) -> f32 {
            1.0
        }

        fn size(&self) -> f32 {
            1.0
        }
    }

    const SETTINGS: Settings = Settings {
        rate_hz: 4_000.0,
        stiffness_n_per_m: 600.0,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.1,
        body_origin_m: vec3(0.0, 0.0, 0.0),
    };
    const PERIOD: u32 = 1_000;

    /// Ticks so many times from the tick at hand, each a period apart and 300 counts long.
    fn ticks(recorder: &mut Recorder<'_>, state: &mut ServoState<3>, ticks: u32) {
        let servo =
            Servo::new(&WOODEN_HAPTICS_2016, &OnePatch(Plane), Config { settings: SETTINGS, ..Config::DEFAULT });
        for _ in 0..ticks {
            // Near the end of the counter, so that it wraps.
            let began = (u32::MAX - 5 * PERIOD).wrapping_add(state.ticks() * PERIOD);
            let _ = servo.tick(state, Input::Sensors { counts: [Counts(0); 3], enable: false });
            recorder.note(state, began, began.wrapping_add(300));
        }
    }

    fn start() -> ServoState<3> {
        Servo::new(&WOODEN_HAPTICS_2016, &OnePatch(Plane), Config { settings: SETTINGS, ..Config::DEFAULT }).start()
    }

    #[test]
    fn a_record_comes_every_so_many_ticks_and_at_each_change() {
        let mut queue = Queue::<Record, 64>::new();
        let (producer, mut consumer) = queue.split();
        let (mut recorder, mut state) = (Recorder::new(producer, 4_000_000, 10), start());
        ticks(&mut recorder, &mut state, 100);
        let servo =
            Servo::new(&WOODEN_HAPTICS_2016, &OnePatch(Plane), Config { settings: SETTINGS, ..Config::DEFAULT });
        servo.note(&mut state, Event::Stop);
        ticks(&mut recorder, &mut state, 2);

        let records = core::iter::from_fn(|| consumer.dequeue());
        let mut phases = [0_u32; Phase::ALL.len()];
        let (mut last, mut before_last) = (None, 0);
        for record in records {
            phases[usize::from(record.phase)] += 1;
            before_last = last.map_or(0, |last: Record| last.tick);
            if let Some(last) = last {
                // All periods are alike, over the wrap too.
                assert_eq!([record.shortest, record.longest, record.took], [PERIOD, PERIOD, 300]);
                assert_eq!(record.began.wrapping_sub(last.began), (record.tick - last.tick) * PERIOD);
                assert!(record.tick - last.tick <= 10);
            } else {
                assert_eq!([record.tick, record.shortest, record.longest], [0, 0, 0]);
            }
            last = Some(record);
        }
        let last = last.unwrap();
        assert_eq!((last.tick, last.fault, last.fault_tick), (100, Fault::Stopped.code(), 100));
        assert!((90..100).contains(&before_last), "the fault is told at once: {before_last}");
        assert!(phases[Phase::Calibrate as usize] >= 1 && phases[Phase::Armed as usize] >= 10, "{phases:?}");
        assert_eq!((last.dropped, last.clock), (0, 4_000_000));
    }

    #[test]
    fn a_full_queue_costs_records_that_are_counted_and_nothing_else() {
        let mut queue = Queue::<Record, 4>::new();
        let (producer, mut consumer) = queue.split();
        let (mut recorder, mut state) = (Recorder::new(producer, 4_000_000, 1), start());
        ticks(&mut recorder, &mut state, 10);
        assert_eq!(core::iter::from_fn(|| consumer.dequeue()).count(), 3);
        ticks(&mut recorder, &mut state, 1);
        let record = consumer.dequeue().unwrap();
        assert_eq!((record.tick, record.number, record.dropped), (10, 3, 7));
        // Periods that were not told are not lost with the records.
        assert_eq!([record.shortest, record.longest], [PERIOD, PERIOD]);
    }

    #[test]
    fn duties_of_fewer_joints_are_followed_by_zeros() {
        assert_eq!(first_three(&[Duty(-7), Duty(300)]), [-7, 300, 0]);
        assert_eq!(first_three(&[Duty(1), Duty(2), Duty(3), Duty(4)]), [1, 2, 3]);
    }
}
