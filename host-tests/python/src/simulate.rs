//! The simulated loop of `palpate sim`: a device in a hand, the servo loop, a body.

use crate::devices::{OnDevice, refused};
use crate::refusal::Refusal;
use glam::DVec3;
use palpate::body::Body;
use palpate::device::{Counts, Device, Kinematics, Protection};
use palpate::field::MAX_MODES;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::servo::recommended::Recommended;
use palpate::servo::{
    Config, Event, Guard, Input, Rendering, Safety, Servo, Settings, SoftBody, Surface, Tracked as _,
};
use palpate::wire::Report;
use palpate_bake::NurbsPatch;
use palpate_sim::plant::{HandSettings, PathError, Plant, PlantSettings, TouchingPath, middle, place_around};
use palpate_truth::oracle::OraclePoint;

/// The seconds before force is asked for, in which the witness point converges.
const STANDBY: f32 = 0.1;
/// The longest run: an hour of a hand's path is 86 MB.
const LONGEST: f64 = 3_600.0;
/// The limits of a loop with a host at its link, which is gone when it is silent for 100 ms.
const SAFETY: Safety = Safety { link_timeout_s: 0.1, ..Safety::DEFAULT };

/// The request.
pub struct Wishes {
    /// Servo rate, Hz.
    pub rate: f32,
    /// How long, s.
    pub seconds: f64,
    /// Of the hand's path.
    pub seed: u64,
    /// N/m.
    pub stiffness: Option<f32>,
    /// N·s/m.
    pub damping: Option<f32>,
    /// N.
    pub max_force: Option<f32>,
    /// Corner frequency of the velocity filter, Hz.
    pub velocity_corner: Option<f32>,
    /// Seconds over which the force is faded in.
    pub soft_start: f32,
    /// The recommended rendering; else spring and damper alone.
    pub smooth: bool,
    /// With all protection of the device.
    pub protected: bool,
    /// Where the origin of the tables lies in the device's workspace, m; centres the body if not given.
    pub origin: Option<DVec3>,
}

/// The surface of a run, as `palpate sim` takes it.
#[derive(Clone, Copy)]
pub enum Touched<'a> {
    /// One patch, and in double precision, as the hand follows it.
    Patch(&'static SplinePatch<'static>, &'a NurbsPatch),
    /// All faces.
    Body(&'static Body<'static>),
    /// A body that deforms; the hand touches it at rest.
    Soft(&'static Body<'static>, &'static SoftBody<'static>),
}

impl Touched<'_> {
    /// The middle of its bounding box.
    fn middle(self) -> Vec3 {
        match self {
            Self::Patch(patch, _) => middle(std::iter::once(patch)),
            Self::Body(body) | Self::Soft(body, _) => middle(body.faces().iter().map(|face| &face.patch)),
        }
    }

    /// Where a hand may touch: a point and the outward normal for each `(u, v)` in `[0, 1]²`.
    fn places(self) -> impl Fn(f64, f64) -> (DVec3, DVec3) {
        let middle = self.middle();
        move |u, v| match self {
            Self::Patch(_, surface) => OraclePoint::place(surface, u, v),
            Self::Body(body) | Self::Soft(body, _) => place_around(body, middle, u, v),
        }
    }
}

/// One tick as both ends saw it.
pub struct Sample {
    /// Seconds since the start.
    pub time: f64,
    /// The encoders' counts.
    pub counts: [i32; 3],
    /// The loop's answer.
    pub report: Report,
    /// Where the simulated probe really was, m, in the device's frame.
    pub hand: [f64; 3],
    /// `q` of each mode, m.
    pub q: [f32; MAX_MODES],
}

/// A run, a sample a tick.
pub struct Run {
    /// Its samples.
    pub samples: Vec<Sample>,
}

impl Run {
    /// A hash over the digest of every tick's state, as `palpate sim` and `palpate demo` print it.
    pub fn state_hash(&self) -> u32 {
        self.samples.iter().fold(0, |hash, sample| (hash ^ sample.report.digest).wrapping_mul(0x0100_0193))
    }
}

/// A run of a surface on a device.
pub struct Simulated<'a>(pub Touched<'a>, pub &'a Wishes);

impl OnDevice for Simulated<'_> {
    type Made = Run;

    fn on<K: Kinematics<3> + Copy + Sync + 'static>(
        self,
        device: &'static Device<K, 3>,
        protection: Protection<3>,
        plant: &PlantSettings,
        recommended: Recommended,
    ) -> Result<Run, Refusal> {
        let Self(touched, wishes) = self;
        match touched {
            Touched::Patch(patch, _) => run_over(device, protection, plant, touched, patch, wishes, recommended),
            Touched::Body(body) => run_over(device, protection, plant, touched, body, wishes, recommended),
            Touched::Soft(_, soft) => run_over(device, protection, plant, touched, soft, wishes, recommended),
        }
    }
}

/// Runs it over a surface.
fn run_over<K: Kinematics<3>, S: Surface>(
    device: &'static Device<K, 3>,
    protection: Protection<3>,
    simulated: &PlantSettings,
    touched: Touched<'_>,
    surface: &'static S,
    wishes: &Wishes,
    Recommended { settings: recommended, rendering }: Recommended,
) -> Result<Run, Refusal> {
    let ticks = wishes.seconds * f64::from(wishes.rate);
    if !(wishes.seconds <= LONGEST && (1.0..=f64::from(u32::MAX)).contains(&ticks)) {
        let Wishes { seconds, rate, .. } = wishes;
        return Err(Refusal::Settings(format!("{seconds} s at {rate} Hz is not a number of ticks that can be run")));
    }
    let settings = Settings {
        rate_hz: wishes.rate,
        stiffness_n_per_m: wishes.stiffness.unwrap_or(recommended.stiffness_n_per_m),
        damping_n_s_per_m: wishes.damping.unwrap_or(recommended.damping_n_s_per_m),
        max_force_n: wishes.max_force.unwrap_or(recommended.max_force_n),
        velocity_corner_hz: wishes.velocity_corner.unwrap_or(recommended.velocity_corner_hz),
        soft_start_s: wishes.soft_start,
        body_origin_m: wishes.origin.map_or_else(|| -touched.middle(), |origin| origin.as_vec3()),
    };
    let rendering = if wishes.smooth { rendering } else { Rendering::PLAIN };
    let config = Config { settings, rendering, safety: SAFETY, ..Config::DEFAULT };
    let servo = Servo::try_new(device, surface, config).map_err(|error| refused(error, &settings, device))?;
    let mut plant = plant(device, simulated, touched, settings.body_origin_m, wishes)?;
    let samples = if wishes.protected {
        let servo = Servo::try_protected(device, surface, protection, config)
            .map_err(|error| refused(error, &settings, device))?;
        looped(&servo, &mut plant, wishes.rate, ticks as u32)
    } else {
        looped(&servo, &mut plant, wishes.rate, ticks as u32)
    };
    Ok(Run { samples })
}

/// The closed loop, in lockstep.
fn looped<K: Kinematics<3>, S: Surface, G: Guard<3>>(
    servo: &Servo<'_, S, K, 3, G>,
    plant: &mut Plant,
    rate: f32,
    ticks: u32,
) -> Vec<Sample> {
    let enable_at = (STANDBY * rate) as u32;
    let mut state = servo.start();
    let mut samples = Vec::with_capacity(ticks as usize);
    for tick in 0..ticks {
        let (time, counts, hand) = (plant.time(), plant.counts(), plant.position());
        servo.note(&mut state, Event::LinkAlive);
        let _ = servo.tick(&mut state, Input::Sensors { counts: counts.map(Counts), enable: tick >= enable_at });
        let report = Report::new(&state, 0);
        let q = state.witness().modes().unwrap_or_default();
        samples.push(Sample { time, counts, report, hand, q });
        plant.advance(report.duties);
    }
    samples
}

/// The simulated device with a hand that touches the surface.
fn plant<K: Kinematics<3>>(
    device: &'static Device<K, 3>,
    simulated: &PlantSettings,
    touched: Touched<'_>,
    origin: Vec3,
    wishes: &Wishes,
) -> Result<Plant, Refusal> {
    let places = touched.places();
    let origin = origin.as_dvec3();
    let surface = |u, v| {
        let (point, normal) = places(u, v);
        ((point + origin).to_array(), normal.to_array())
    };
    let mechanism = simulated.mechanism(0.0);
    let has_room = |place| {
        mechanism.angles(place).is_some_and(|angles: [f64; 3]| {
            let angles = angles.map(|angle| angle as f32);
            device
                .kinematics
                .pose(angles)
                .is_some_and(|pose| device.workspace_margin(device.to_stop(&angles), &pose) > 0.0)
        })
    };
    let advice = |error: &dyn std::fmt::Display| Refusal::Settings(format!("{error} (move the model with `at`)"));
    let path = TouchingPath::within(surface, wishes.seconds, wishes.seed, has_room).map_err(|error| match error {
        PathError::NoRoom => advice(&error),
        _ => Refusal::Settings(format!("{error}; bake one patch alone, or try another `seed`")),
    })?;
    Plant::new(simulated, HandSettings::default(), Box::new(path), f64::from(wishes.rate))
        .map_err(|error| advice(&error))
}
