//! The closed loop: a servo loop at one end of a link, the simulated device and hand at the other, in lockstep.

use crate::firmware::{Link, LinkError};
use crate::shaped::{GIMBAL, ShapedTool};
use palpate::device::{Counts, Kinematics, Mount, WristState};
use palpate::servo::{Event, Guard, GuardState, Input, Servo, ServoState, Surface, Unguarded};
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::{Report, Sensors, WristSensors};
use palpate_sim::plant::Plant;
use serde::de::DeserializeOwned;
use std::any::Any;
use std::time::Duration;

/// The servo loop compiled for the host, behind the same link as the firmware: the frames and the way from a frame to
/// an input are those of the board.
pub struct HostLoop<'a, S: Surface, K, G: Guard<3> = Unguarded, F = Sensors> {
    servo: Servo<'a, S, K, 3, G>,
    state: ServoState<3, S::Witness, G::State>,
    receiver: Receiver<F>,
    wrist: WristState,
    report: Option<Report>,
}

impl<'a, S: Surface, K: Kinematics<3>, G: Guard<3>, F: Frame> HostLoop<'a, S, K, G, F> {
    /// A loop in its state before the first tick.
    pub fn new(servo: Servo<'a, S, K, 3, G>) -> Self {
        let state = servo.start();
        Self { servo, state, receiver: Receiver::new(), wrist: WristState::default(), report: None }
    }

    fn tick(&mut self, input: Input<3>) {
        let _ = self.servo.tick(&mut self.state, input);
        self.report = Some(Report::new(&self.state, 0));
    }
}

impl<S: Surface, K: Kinematics<3>, G: Guard<3, State: Any>, F: FrameTo<K>> Link for HostLoop<'_, S, K, G, F> {
    fn joints_seen(&self) -> Option<[bool; 3]> {
        let state: &dyn Any = self.state.guard();
        state.downcast_ref::<GuardState<3>>().map(GuardState::joints_seen)
    }

    fn contacts_lost(&self) -> Option<u32> {
        Some(self.state.contacts_lost())
    }

    fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        for byte in bytes {
            let received = self.receiver.feed(*byte);
            if matches!(received, Some(Received::Message(_) | Received::Empty)) {
                self.servo.note(&mut self.state, Event::LinkAlive);
            }
            match received {
                Some(Received::Message(frame)) if frame.arm().tick == self.state.ticks() => {
                    frame.orient(&self.servo, &mut self.state, &mut self.wrist);
                    let sensors = frame.arm();
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

/// A frame of sensors.
pub trait Frame: DeserializeOwned {
    /// Those of the arm.
    fn arm(&self) -> Sensors;
}

/// A frame for a loop on such a mechanism.
pub trait FrameTo<K>: Frame {
    /// Notes the handle's orientation, where the frame has the counts of a wrist.
    fn orient<S: Surface, G: Guard<3>>(
        &self,
        _servo: &Servo<'_, S, K, 3, G>,
        _state: &mut ServoState<3, S::Witness, G::State>,
        _wrist: &mut WristState,
    ) {
    }
}

impl Frame for Sensors {
    fn arm(&self) -> Sensors {
        *self
    }
}

impl<K> FrameTo<K> for Sensors {}

impl Frame for WristSensors {
    fn arm(&self) -> Sensors {
        self.arm
    }
}

impl<K: Mount<3>> FrameTo<K> for WristSensors {
    fn orient<S: Surface, G: Guard<3>>(
        &self,
        servo: &Servo<'_, S, K, 3, G>,
        state: &mut ServoState<3, S::Witness, G::State>,
        wrist: &mut WristState,
    ) {
        // As the board does: without an orientation there is no force.
        let _ = servo.orient(state, &GIMBAL, wrist, self.arm.counts.map(Counts), self.wrist.map(Counts));
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
    /// When the polarity check confirmed each joint, seconds since the start, where the link shows it.
    pub confirmed: Option<[Option<f64>; 3]>,
    /// Contacts released because they were too deep or no motion explained them, where the link shows it.
    pub contacts_lost: Option<u32>,
}

impl Trace {
    /// Counts the contacts that a board released, by the same loop on the host. After a fault there are none; where the
    /// states differ without one, nothing is counted.
    ///
    /// # Errors
    /// An error of the link.
    pub fn count_contacts_lost(&mut self, host: &mut dyn Link, tool: Option<ShapedTool>) -> Result<(), LinkError> {
        for sample in &self.samples {
            if exchange(host, &sample.sensors, tool, sample.time)?.digest != sample.report.digest {
                self.contacts_lost = self.contacts_lost.filter(|_| sample.report.fault != 0);
                break;
            }
            self.contacts_lost = host.contacts_lost();
        }
        Ok(())
    }
}

/// One tick of a loop, with a wrist's counts where the tool has a shape.
fn exchange(link: &mut dyn Link, sensors: &Sensors, tool: Option<ShapedTool>, time: f64) -> Result<Report, LinkError> {
    match tool {
        None => link.exchange(sensors),
        Some(tool) => link.exchange_with_wrist(&WristSensors { arm: *sensors, wrist: tool.counts(time) }),
    }
}

/// How long a run is, and how the hand turns the tool.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Servo rate, Hz.
    pub rate: f64,
    /// Ticks to run.
    pub ticks: u32,
    /// The tick from which on force is requested; before it the witness point converges in standby.
    pub enable_at: u32,
    /// A tool with a shape: the loop then takes a wrist's counts too.
    pub tool: Option<ShapedTool>,
}

/// Runs a loop against a plant. `progress` receives the number of each finished tick.
///
/// # Errors
/// An error of the link.
pub fn run(
    link: &mut dyn Link,
    plant: &mut Plant,
    span: Span,
    mut progress: impl FnMut(u32),
) -> Result<Trace, LinkError> {
    let Span { rate, ticks, enable_at, tool } = span;
    let mut samples = Vec::with_capacity(ticks as usize);
    let mut confirmed = link.joints_seen().map(|_| [None; 3]);
    for tick in 0..ticks {
        let sensors = Sensors { tick, counts: plant.counts(), enable: tick >= enable_at };
        let (time, probe) = (plant.time(), plant.position());
        let report = exchange(link, &sensors, tool, time)?;
        for (when, seen) in confirmed.iter_mut().flatten().zip(link.joints_seen().into_iter().flatten()) {
            *when = when.or(seen.then_some(time));
        }
        samples.push(Sample { time, sensors, report, probe });
        plant.advance(report.duties);
        progress(tick + 1);
    }
    Ok(Trace { rate, samples, confirmed, contacts_lost: link.contacts_lost() })
}
