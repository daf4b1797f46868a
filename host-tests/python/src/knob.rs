//! A knob: its feel set part by part, and its dial read; a simulated one, or one at a serial port.

use crate::arrays::line;
use crate::refusal::Refusal;
use palpate_link::{Device, Dial, DialFriction, Error, FeelPart, Line, Notch, Port, Spring, Wave};
use palpate_sim::knob::{DIAL_ZERO, KnobFlash, SEARCH, SharedKnob, SimulatedKnob, dial};
use palpate_sim::plant::Fingers;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::f64::consts::TAU;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// How long to wait before looking at Python's signals, and how long the device is read at a time: a program that was
/// interrupted must not keep it alive.
const LOOK: Duration = Duration::from_millis(100);

type Held = Device<Box<dyn Line>>;
type Job = Box<dyn FnOnce(&mut Held) + Send>;

/// A knob in a thread of its own, which only does what it is asked for: between two calls the device hears nothing.
#[pyclass(frozen, module = "palpate")]
pub struct Knob {
    jobs: Mutex<Option<Sender<Job>>>,
    /// The dial, its button and a hand, of a simulated one.
    simulated: Option<SharedKnob>,
}

/// Waits for a result of the thread.
fn wait<T: Send>(py: Python<'_>, hear: Receiver<Result<T, Error>>) -> PyResult<T> {
    let hear = Mutex::new(hear);
    loop {
        let heard = py.detach(|| hear.lock().ok().map(|hear| hear.recv_timeout(LOOK)));
        match heard {
            Some(Ok(result)) => return Ok(result.map_err(refusal)?),
            Some(Err(RecvTimeoutError::Timeout)) => py.check_signals()?,
            Some(Err(RecvTimeoutError::Disconnected)) | None => return Err(closed().into()),
        }
    }
}

fn closed() -> Refusal {
    Refusal::Link("the knob is closed: open it again".to_owned())
}

/// A refusal of the device is a setting's error; any other error is the line's.
fn refusal(error: Error) -> Refusal {
    let is_refused = matches!(error, Error::Refused { .. });
    let cause = std::error::Error::source(&error).map_or_else(String::new, |cause| format!(": {cause}"));
    let says = format!("{error}{cause}");
    if is_refused { Refusal::Settings(says) } else { Refusal::Link(says) }
}

/// Lets time pass.
fn spend(device: &mut Held, seconds: f64) -> Result<(), Error> {
    let began = device.now();
    while (device.now() - began).as_secs_f64() < seconds {
        device.tend()?;
    }
    Ok(())
}

/// Released, held until the rotor is aligned, released, held: force.
fn start(device: &mut Held, knob: &SharedKnob) -> Result<(), Error> {
    let aligns = f64::from(SEARCH.ticks()) / f64::from(device.hello().rate) + 0.1;
    for (enable, seconds) in [(false, 0.1), (true, aligns), (false, 0.1), (true, 0.5)] {
        knob.world().enable = enable;
        spend(device, seconds)?;
    }
    Ok(())
}

/// The same through a reset of the device, which is greeted again.
fn spend_through(device: &mut Held, seconds: f64) -> Result<(), Error> {
    match spend(device, seconds) {
        Err(Error::BeganAnew { .. }) => device.greet().map(|_| ()),
        other => other,
    }
}

impl Knob {
    /// Opens a line in a thread of its own, where it stays.
    fn over(
        py: Python<'_>,
        simulated: Option<SharedKnob>,
        open: impl FnOnce() -> Result<Held, Error> + Send + 'static,
    ) -> PyResult<Self> {
        let (jobs, todo) = channel::<Job>();
        let (say, hear) = channel();
        std::thread::spawn(move || match open() {
            Ok(mut device) => {
                let _ = say.send(Ok(()));
                todo.into_iter().for_each(|job| job(&mut device));
            }
            Err(error) => {
                let _ = say.send(Err(error));
            }
        });
        wait(py, hear)?;
        Ok(Self { jobs: Mutex::new(Some(jobs)), simulated })
    }

    /// Does something with the device.
    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Held) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let (say, hear) = channel();
        let jobs = self.jobs.lock().ok().and_then(|jobs| jobs.clone()).ok_or_else(closed)?;
        let job: Job = Box::new(move |device| {
            // A caller that was interrupted no longer listens.
            let _ = say.send(job(device));
        });
        jobs.send(job).map_err(|_| closed())?;
        wait(py, hear)
    }

    fn world(&self) -> Result<&SharedKnob, Refusal> {
        let says = "only a simulated knob has a hand and a trace: use Knob.simulated()";
        self.simulated.as_ref().ok_or_else(|| Refusal::Settings(says.to_owned()))
    }
}

/// A part of a feel by its name; without numbers it is taken away.
fn part(name: &str, numbers: Option<&[f64]>) -> Option<FeelPart> {
    // The casts saturate; what is not finite is the device's to refuse.
    let numbers: Option<Vec<f32>> = numbers.map(|numbers| numbers.iter().map(|number| *number as f32).collect());
    let wave = |numbers: &[f32]| {
        let [pitch_rad, torque_n_m, centre_rad] = *numbers.first_chunk()?;
        Some(Wave { pitch_rad, torque_n_m, centre_rad })
    };
    let clicks = |numbers: &[f32]| {
        let [pitch, max_force, first, last, snap] = *numbers.first_chunk()?;
        let outer = [first, last].map(|number| number as i32);
        Some(palpate_link::clicks(pitch, max_force, outer, snap, numbers.get(5).copied()))
    };
    let spring = |numbers: &[f32]| {
        let [stiffness_n_m_per_rad, max_torque_n_m, rest_rad] = *numbers.first_chunk()?;
        Some(Spring { stiffness_n_m_per_rad, rest_rad, max_torque_n_m })
    };
    let ends = |numbers: &[f32]| {
        let [low, high, stiffness] = *numbers.first_chunk()?;
        Some(palpate_link::ends([low, high], stiffness, numbers.get(3).copied()))
    };
    let friction = |numbers: &[f32]| {
        let [torque_n_m, whole_at_rad_per_s] = *numbers.first_chunk()?;
        Some(DialFriction { torque_n_m, whole_at_rad_per_s })
    };
    let notch = |numbers: &[f32]| {
        let [at_rad, width_rad, torque_n_m] = *numbers.first_chunk()?;
        Some(Notch { at_rad, width_rad, torque_n_m })
    };
    let numbers = numbers.as_deref();
    Some(match name {
        "detents" => FeelPart::Detents(numbers.and_then(wave)),
        "clicks" => FeelPart::Clicks(numbers.and_then(clicks)),
        "texture" => FeelPart::Texture(numbers.and_then(wave)),
        "spring" => FeelPart::Spring(numbers.and_then(spring)),
        "ends" => FeelPart::Ends(numbers.and_then(ends)),
        "damping" => FeelPart::Damping(numbers.and_then(|numbers| numbers.first().copied()).unwrap_or(0.0)),
        "friction" => FeelPart::Friction(numbers.and_then(friction)),
        "notch" => FeelPart::Notch(numbers.and_then(notch)),
        "free" => FeelPart::Free,
        _ => return None,
    })
}

#[pymethods]
impl Knob {
    #[staticmethod]
    fn simulated(py: Python<'_>) -> PyResult<Self> {
        let knob = SharedKnob::new(dial());
        let of = knob.clone();
        Self::over(py, Some(knob), move || {
            // It lives as long as the program, as a board's flash does.
            let flash: &'static KnobFlash = Box::leak(Box::new(KnobFlash::new()));
            let line: Box<dyn Line> = Box::new(SimulatedKnob::new(&of, flash));
            let mut device = Device::over(line)?;
            start(&mut device, &of)?;
            Ok(device)
        })
    }

    #[staticmethod]
    fn open(py: Python<'_>, port: String, baud: u32) -> PyResult<Self> {
        Self::over(py, None, move || {
            let line: Box<dyn Line> = Box::new(Port::open(&port, baud)?);
            Device::over(line)
        })
    }

    fn feel(&self, py: Python<'_>, part: &str, numbers: Option<Vec<f64>>) -> PyResult<()> {
        let none = || Refusal::Settings(format!("a feel has no part {part:?}"));
        let part = self::part(part, numbers.as_deref()).ok_or_else(none)?;
        self.ask(py, move |device| device.feel(part))
    }

    fn choose(&self, py: Python<'_>, index: u8) -> PyResult<()> {
        self.ask(py, move |device| device.choose(index))
    }

    fn keep(&self, py: Python<'_>, keeps: bool) -> PyResult<()> {
        self.ask(py, move |device| device.keep_feel(keeps, || ()))
    }

    fn read<'py>(&self, py: Python<'py>, seconds: f64) -> PyResult<Bound<'py, PyDict>> {
        let lasts = Duration::try_from_secs_f64(seconds)
            .map_err(|_| Refusal::Settings("seconds must be a number that is not negative".to_owned()))?;
        let (mut dials, mut left): (Vec<Dial>, _) = (Vec::new(), lasts);
        while !left.is_zero() || dials.is_empty() {
            let slice = left.min(LOOK);
            let (came, took) = self.ask(py, move |device| {
                let (began, mut came) = (device.now(), Vec::new());
                while device.now() - began < slice || came.is_empty() {
                    let before = device.dials();
                    let dial = device.dial(Duration::from_millis(20))?;
                    if device.dials() != before {
                        came.push(dial);
                    }
                }
                match device.fault()? {
                    Some(fault) => Err(Error::Fault(fault)),
                    None => Ok((came, device.now() - began)),
                }
            })?;
            dials.extend(came);
            left = left.saturating_sub(took);
        }
        let columns = PyDict::new(py);
        columns.set_item("tick", line(py, dials.iter().map(|dial| dial.tick).collect()))?;
        columns.set_item("angle", line(py, dials.iter().map(|dial| f64::from(dial.angle)).collect()))?;
        columns.set_item("rate", line(py, dials.iter().map(|dial| dial.rate).collect()))?;
        columns.set_item("torque", line(py, dials.iter().map(|dial| dial.torque).collect()))?;
        columns.set_item("feel", line(py, dials.iter().map(|dial| dial.feel).collect()))?;
        columns.set_item("detent", line(py, dials.iter().map(|dial| dial.detent).collect()))?;
        columns.set_item("end", line(py, dials.iter().map(|dial| dial.end).collect()))?;
        columns.set_item("kept", line(py, dials.iter().map(|dial| dial.kept).collect()))?;
        columns.set_item("turns", line(py, dials.iter().map(|dial| dial.turns).collect()))?;
        Ok(columns)
    }

    fn press(&self, pressed: bool) -> PyResult<()> {
        self.world()?.world().enable = pressed;
        Ok(())
    }

    fn hold(&self, py: Python<'_>, to: f64, seconds: f64, stiffness: f64, damping: f64) -> PyResult<()> {
        let is_hand =
            [to, stiffness, damping].iter().all(|number| number.is_finite()) && (1e-3..3_600.0).contains(&seconds);
        if !is_hand {
            let says = "a hand needs finite numbers, and from a millisecond to an hour to get there";
            return Err(Refusal::Settings(says.to_owned()).into());
        }
        let knob = self.world()?.clone();
        // As the encoder counts, whose zero is not the shaft's.
        let (from, to) = {
            let world = knob.world();
            (world.dial.angle(), to + DIAL_ZERO + TAU * f64::from(world.turns))
        };
        let hand = move |share: f64, rate| Fingers { stiffness, damping, aim: from + (to - from) * share, rate };
        self.ask(py, move |device| {
            let began = device.now();
            loop {
                let share = (device.now() - began).as_secs_f64() / seconds;
                if share >= 1.0 {
                    knob.world().dial.hold(hand(1.0, 0.0));
                    return Ok(());
                }
                knob.world().dial.hold(hand(share, (to - from) / seconds));
                device.tend()?;
            }
        })
    }

    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        let knob = self.world()?.clone();
        self.ask(py, move |device| {
            {
                let mut world = knob.world();
                (world.resets, world.enable) = (true, false);
                // The rotor is aligned without a hand on it.
                world.dial.hold(Fingers::NONE);
            }
            spend_through(device, 0.1)?;
            start(device, &knob)
        })
    }

    fn release(&self) -> PyResult<()> {
        self.world()?.world().dial.hold(Fingers::NONE);
        Ok(())
    }

    fn trace<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut rows = self.world()?.world().trace.replace(Vec::new()).unwrap_or_default();
        rows.iter_mut().for_each(|row| row[3] -= DIAL_ZERO);
        let columns = PyDict::new(py);
        for (at, name) in ["angle", "rate", "torque", "shaft_angle", "shaft_torque"].into_iter().enumerate() {
            columns.set_item(name, line(py, rows.iter().map(|row| row[at]).collect()))?;
        }
        Ok(columns)
    }

    fn close(&self) {
        if let Ok(mut jobs) = self.jobs.lock() {
            *jobs = None;
        }
    }
}
