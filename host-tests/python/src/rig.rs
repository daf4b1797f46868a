//! The loop by itself, for whichever plant Python has, and the project's own plant to compare it with.

use crate::arrays::{Table, rows, table, usable};
use crate::body::Body;
use crate::devices::{OnDevice, on_device, refused};
use crate::refusal::Refusal;
use glam::DVec3;
use numpy::PyReadonlyArray2;
use palpate::body::Effort;
use palpate::device::{Counts, Kinematics, Protection};
use palpate::patch::SplinePatch;
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Event, Guard, Input, Rendering, Safety, Servo, ServoState, Settings, Surface};
use palpate::wire::Report;
use palpate_sim::plant::{HandSettings, PlantSettings, StillHand};
use palpate_sim::recorded::Recorded;
use pyo3::prelude::*;
use std::path::PathBuf;

type Pose = ([f64; 3], [f64; 9]);

/// A device's numbers and kinematics.
#[pyclass(frozen, module = "palpate")]
pub struct Device {
    pose: Box<dyn Fn([f64; 3]) -> Pose + Send + Sync>,
    plant: PlantSettings,
}

struct Described;

impl OnDevice for Described {
    type Made = Device;

    fn on<K: Kinematics<3> + Copy + Sync + 'static>(
        self,
        device: &'static palpate::device::Device<K, 3>,
        _: Protection<3>,
        plant: &PlantSettings,
        _: Recommended,
    ) -> Result<Device, Refusal> {
        let pose = |angles: [f64; 3]| {
            let Some(pose) = device.kinematics.pose(angles.map(|angle| angle as f32)) else {
                return ([f64::NAN; 3], [f64::NAN; 9]);
            };
            let jacobian = pose.jacobian.map(|column| column.to_array().map(f64::from));
            (pose.position.as_dvec3().to_array(), core::array::from_fn(|place: usize| jacobian[place % 3][place / 3]))
        };
        Ok(Device { pose: Box::new(pose), plant: *plant })
    }
}

#[pymethods]
impl Device {
    #[new]
    fn new(device: PathBuf) -> PyResult<Self> {
        Ok(on_device(&device, Described)?)
    }

    fn pose<'py>(
        &self,
        py: Python<'py>,
        angles: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Table<'py, f64>, Table<'py, f64>)> {
        let (places, jacobians) = rows::<3>("angles", &angles)?.into_iter().map(&self.pose).unzip();
        Ok((table(py, places), table(py, jacobians)))
    }

    fn angles<'py>(&self, py: Python<'py>, places: PyReadonlyArray2<'py, f64>) -> PyResult<Table<'py, f64>> {
        let mechanism = self.plant.mechanism(0.0);
        let angles = |place| mechanism.angles(place).unwrap_or([f64::NAN; 3]);
        Ok(table(py, rows::<3>("positions", &places)?.into_iter().map(angles).collect()))
    }

    fn counts(&self, angles: [f64; 3]) -> [i32; 3] {
        let encoders = self.plant.encoders();
        core::array::from_fn(|joint| encoders[joint].counts(angles[joint]))
    }

    fn torques(&self, duties: [i16; 3], rates: [f64; 3]) -> [f64; 3] {
        let motors = self.plant.motors();
        let current = |joint: usize| motors[joint].settled(duties[joint], rates[joint]);
        core::array::from_fn(|joint| current(joint) * motors[joint].torque_per_ampere)
    }

    fn numbers(&self) -> PyResult<String> {
        let says = "a device with fewer than three joints has no numbers here";
        Ok(self.plant.numbers().ok_or_else(|| Refusal::Settings(says.to_owned()))?)
    }
}

/// A servo of any type.
trait Ticking: Send + Sync {
    fn tick(&mut self, counts: [i32; 3], enable: bool) -> Report;
    fn origin(&self) -> [f32; 3];
}

struct Running<S: Surface + 'static, K: Kinematics<3> + 'static, G: Guard<3>> {
    servo: Servo<'static, S, K, 3, G>,
    state: ServoState<3, S::Witness, G::State>,
}

impl<S: Surface, K: Kinematics<3>, G: Guard<3>> Ticking for Running<S, K, G>
where
    Servo<'static, S, K, 3, G>: Send + Sync,
    ServoState<3, S::Witness, G::State>: Send + Sync,
{
    fn tick(&mut self, counts: [i32; 3], enable: bool) -> Report {
        self.servo.note(&mut self.state, Event::LinkAlive);
        let _ = self.servo.tick(&mut self.state, Input::Sensors { counts: counts.map(Counts), enable });
        Report::new(&self.state, 0)
    }

    fn origin(&self) -> [f32; 3] {
        self.servo.settings().body_origin_m.to_array()
    }
}

/// The firmware's loop, a tick a call.
#[pyclass(module = "palpate")]
pub struct Loop {
    running: Box<dyn Ticking>,
    last: Report,
}

/// The device of a loop: one that has a name or a file, or that of a recording.
#[derive(FromPyObject)]
enum LoopDevice {
    Named(PathBuf),
    Recorded(Vec<f32>),
}

/// A surface that does not deform.
#[derive(Clone, Copy)]
enum Rigid {
    Patch(&'static SplinePatch<'static>),
    Body(&'static palpate::body::Body<'static>),
}

struct Started {
    surface: Rigid,
    /// Its stiffness, damping, maximum force and velocity corner count where `given` has them.
    config: Config<3>,
    given: [Option<f32>; 4],
    protected: bool,
    beyond: bool,
}

impl OnDevice for Started {
    type Made = Box<dyn Ticking>;

    fn on<K: Kinematics<3> + Copy + Sync + 'static>(
        self,
        device: &'static palpate::device::Device<K, 3>,
        protection: Protection<3>,
        _: &PlantSettings,
        Recommended { settings: recommended, .. }: Recommended,
    ) -> Result<Self::Made, Refusal> {
        let protection = self.protected.then_some(protection);
        self.on_protected(device, protection, &recommended)
    }
}

impl Started {
    fn on_protected<K: Kinematics<3> + Copy + Sync + 'static>(
        self,
        device: &'static palpate::device::Device<K, 3>,
        protection: Option<Protection<3>>,
        recommended: &Settings,
    ) -> Result<Box<dyn Ticking>, Refusal> {
        let Self { surface, mut config, given: [stiffness, damping, max_force, velocity_corner], beyond, .. } = self;
        config.settings = Settings {
            stiffness_n_per_m: stiffness.unwrap_or(recommended.stiffness_n_per_m),
            damping_n_s_per_m: damping.unwrap_or(recommended.damping_n_s_per_m),
            max_force_n: max_force.unwrap_or(recommended.max_force_n),
            velocity_corner_hz: velocity_corner.unwrap_or(recommended.velocity_corner_hz),
            ..config.settings
        };
        let device = if beyond {
            let Settings { stiffness_n_per_m, damping_n_s_per_m, .. } = config.settings;
            Box::leak(Box::new(palpate::device::Device {
                max_stiffness_n_per_m: device.max_stiffness_n_per_m.max(stiffness_n_per_m),
                max_damping_n_s_per_m: device.max_damping_n_s_per_m.max(damping_n_s_per_m),
                ..*device
            }))
        } else {
            device
        };
        match surface {
            Rigid::Patch(patch) => running(device, patch, protection, config),
            Rigid::Body(body) => running(device, body, protection, config),
        }
    }
}

/// The loop over a surface, before its first tick.
fn running<K: Kinematics<3> + Copy + Sync + 'static, S: Surface + Sync + 'static>(
    device: &'static palpate::device::Device<K, 3>,
    surface: &'static S,
    protection: Option<Protection<3>>,
    config: Config<3>,
) -> Result<Box<dyn Ticking>, Refusal>
where
    S::Witness: Send + Sync,
{
    let refused = |error| refused(error, &config.settings, device);
    if let Some(protection) = protection {
        let servo = Servo::try_protected(device, surface, protection, config).map_err(refused)?;
        let state = servo.start();
        Ok(Box::new(Running { servo, state }))
    } else {
        let servo = Servo::try_new(device, surface, config).map_err(refused)?;
        let state = servo.start();
        Ok(Box::new(Running { servo, state }))
    }
}

#[pymethods]
impl Loop {
    #[new]
    #[pyo3(signature = (
        device, body, *, rate, stiffness, damping, max_force, velocity_corner, soft_start, smooth, protected, beyond, at
    ))]
    #[allow(clippy::too_many_arguments, reason = "each is an argument of the function in Python, by its name")]
    fn new(
        device: LoopDevice,
        body: Py<Body>,
        rate: f32,
        stiffness: Option<f32>,
        damping: Option<f32>,
        max_force: Option<f32>,
        velocity_corner: Option<f32>,
        soft_start: f32,
        smooth: bool,
        protected: bool,
        beyond: bool,
        at: [f64; 3],
    ) -> PyResult<Self> {
        usable("at", &[at])?;
        let body = body.get();
        body.at_rest("a loop")?;
        let settings = Settings {
            rate_hz: rate,
            soft_start_s: soft_start,
            body_origin_m: (DVec3::from_array(at) + body.middle()).as_vec3(),
            ..Settings::DEFAULT
        };
        let rendering = if smooth { Rendering::SMOOTH } else { Rendering::PLAIN };
        let safety = Safety { link_timeout_s: 0.1, ..Safety::DEFAULT };
        let config = Config { settings, rendering, safety, ..Config::DEFAULT };
        // The loop wants its surface for good.
        let whole = || Rigid::Body(Box::leak(Box::new(body.tables.with_effort(Effort::ONE))));
        let surface = body.alone.map_or_else(whole, Rigid::Patch);
        let given = [stiffness, damping, max_force, velocity_corner];
        let started = Started { surface, config, given, protected, beyond };
        let running = match device {
            LoopDevice::Named(device) => on_device(&device, started)?,
            LoopDevice::Recorded(numbers) => {
                let none = || Refusal::File("the recording's device is damaged, or of another version".to_owned());
                let Recorded { device, protection } = Recorded::of(&numbers).ok_or_else(none)?;
                let device: &'static _ = Box::leak(Box::new(device));
                started.on_protected(device, protection, &recommended::of(device).settings)?
            }
        };
        Ok(Self { running, last: Report::default() })
    }

    fn tick(&mut self, counts: [i32; 3], enable: bool) -> [i16; 3] {
        self.last = self.running.tick(counts, enable);
        self.last.duties
    }

    #[getter]
    fn probe(&self) -> [f32; 3] {
        let (probe, origin) = (self.last.probe, self.running.origin());
        core::array::from_fn(|axis| probe[axis] + origin[axis])
    }

    #[getter]
    fn force(&self) -> [f32; 3] {
        self.last.force
    }

    #[getter]
    fn gap(&self) -> f32 {
        self.last.gap
    }

    #[getter]
    fn contact(&self) -> u8 {
        self.last.contact
    }

    #[getter]
    fn phase(&self) -> u8 {
        self.last.phase
    }

    #[getter]
    fn fault(&self) -> u8 {
        self.last.fault
    }
}

/// The project's own plant.
#[pyclass(module = "palpate", unsendable)]
pub struct Plant(palpate_sim::plant::Plant);

#[pymethods]
impl Plant {
    #[new]
    fn new(device: &Device, position: [f64; 3], rate: f64) -> PyResult<Self> {
        usable("position", &[position])?;
        let made =
            palpate_sim::plant::Plant::new(&device.plant, HandSettings::NONE, Box::new(StillHand(position)), rate);
        Ok(Self(made.map_err(|error| Refusal::Settings(error.to_string()))?))
    }

    fn advance(&mut self, duties: [i16; 3], aim: [f64; 3], velocity: [f64; 3], stiffness: f64, damping: f64) {
        let grip = HandSettings { stiffness, damping, mass: 0.0 };
        palpate_sim::motion::Moving::advance(&mut self.0, duties, aim, velocity, grip);
    }

    #[getter]
    fn counts(&self) -> [i32; 3] {
        self.0.counts()
    }

    #[getter]
    fn angles(&self) -> [f64; 3] {
        self.0.angles()
    }

    #[getter]
    fn position(&self) -> [f64; 3] {
        self.0.position()
    }

    #[getter]
    fn velocity(&self) -> [f64; 3] {
        self.0.velocity()
    }
}
