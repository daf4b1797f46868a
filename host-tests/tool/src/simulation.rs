//! The closed loop: a servo loop at one end of a link, the simulated device and hand at the other, in lockstep.

use crate::firmware::{Link, LinkError};
use palpate::device::{Counts, Kinematics};
use palpate::servo::{Event, Guard, Input, Servo, ServoState, Surface, Unguarded};
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::{Report, Sensors};
use palpate_sim::plant::Plant;
use std::time::Duration;

/// The servo loop compiled for the host, behind the same link as the firmware: the frames and the way from a frame to
/// an input are those of the board.
pub struct HostLoop<'a, S: Surface, K, G: Guard<3> = Unguarded> {
    servo: Servo<'a, S, K, 3, G>,
    state: ServoState<3, S::Witness, G::State>,
    receiver: Receiver<Sensors>,
    report: Option<Report>,
}

impl<'a, S: Surface, K: Kinematics<3>, G: Guard<3>> HostLoop<'a, S, K, G> {
    /// A loop in its state before the first tick.
    pub fn new(servo: Servo<'a, S, K, 3, G>) -> Self {
        let state = servo.start();
        Self { servo, state, receiver: Receiver::new(), report: None }
    }

    fn tick(&mut self, input: Input<3>) {
        let _ = self.servo.tick(&mut self.state, input);
        self.report = Some(Report::new(&self.state, 0));
    }
}

impl<S: Surface, K: Kinematics<3>, G: Guard<3>> Link for HostLoop<'_, S, K, G> {
    fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        for byte in bytes {
            let received = self.receiver.feed(*byte);
            if matches!(received, Some(Received::Message(_) | Received::Empty)) {
                self.servo.note(&mut self.state, Event::LinkAlive);
            }
            match received {
                Some(Received::Message(sensors)) if sensors.tick == self.state.ticks() => {
                    self.tick(Input::Sensors { counts: sensors.counts.map(Counts), enable: sensors.enable });
                }
                Some(Received::Message(_) | Received::Empty) => self.tick(Input::Lost),
                Some(Received::Damaged) => self.tick(Input::Damaged),
                None => {}
            }
        }
        Ok(())
    }

    fn stay_silent(&mut self) -> Result<(), LinkError> {
        self.tick(Input::Lost);
        Ok(())
    }

    fn receive(&mut self) -> Result<Report, LinkError> {
        self.report.take().ok_or(LinkError::Silent(Duration::ZERO))
    }
}

/// One tick as both ends saw it.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds since the start.
    pub time: f64,
    /// The sensors' values.
    pub sensors: Sensors,
    /// The loop's report.
    pub report: Report,
    /// True position of the simulated probe, metres, in the device's frame.
    pub probe: [f64; 3],
}

/// A recorded run.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Servo rate, Hz.
    pub rate: f64,
    /// One sample a tick.
    pub samples: Vec<Sample>,
}

/// Runs `ticks` ticks of a loop against a plant. Force is requested from tick `enable_at` on; before it the witness
/// point converges in standby. `progress` receives the number of each finished tick.
///
/// # Errors
/// An error of the link.
pub fn run(
    link: &mut dyn Link,
    plant: &mut Plant,
    rate: f64,
    ticks: u32,
    enable_at: u32,
    mut progress: impl FnMut(u32),
) -> Result<Trace, LinkError> {
    let mut samples = Vec::with_capacity(ticks as usize);
    for tick in 0..ticks {
        let sensors = Sensors { tick, counts: plant.counts(), enable: tick >= enable_at };
        let (time, probe) = (plant.time(), plant.position());
        let report = link.exchange(&sensors)?;
        samples.push(Sample { time, sensors, report, probe });
        plant.advance(report.duties);
        progress(tick + 1);
    }
    Ok(Trace { rate, samples })
}
