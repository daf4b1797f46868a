//! A recorded run, felt anew: the counts of each tick through the firmware's code, and the hash of what came of it.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::device::presets::{
    NOVINT_FALCON_PROTECTION, PHANTOM_PREMIUM_PROTECTION, POLHEM_V2_PROTECTION, WOODEN_HAPTICS_2016_PROTECTION,
};
use palpate::device::{Counts, Protection};
use palpate::math::Vec3;
use palpate::servo::{Event, Guard, Input, Safety, Servo, ServoState, Settings};
use palpate::track::Controller;

use crate::felt::{Felt, FeltWitness};
use crate::loaded::Loaded;
use crate::mechanism::{self, Mechanism};
use crate::view;

/// How a scene's loop was set.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The device's name.
    pub device: &'a str,
    /// The loop's settings.
    pub settings: Settings,
    /// Seconds without a host after which it stops.
    pub link_timeout: f32,
    /// Whether its device was protected.
    pub protected: bool,
}

/// A loop that is told what the sensors said.
pub trait Replay: Send {
    /// One tick.
    fn tick(&mut self, counts: [i32; 3], enable: bool);
    /// What there is to see.
    fn view(&self, body: &palpate::body::Body<'static>, out: &mut Vec<f32>);
    /// The hash so far, as the tool's summary prints it.
    fn hash(&self) -> u32;
}

struct Recorded<G: Guard<3> + 'static>
where
    G::State: Send,
{
    servo: Servo<'static, Felt, Mechanism, 3, G>,
    state: ServoState<3, FeltWitness, G::State>,
    hash: u32,
}

impl<G: Guard<3> + Send> Replay for Recorded<G>
where
    G::State: Send,
{
    fn tick(&mut self, counts: [i32; 3], enable: bool) {
        self.servo.note(&mut self.state, Event::LinkAlive);
        self.servo.tick(&mut self.state, Input::Sensors { counts: counts.map(Counts), enable });
        self.hash = (self.hash ^ self.state.digest()).wrapping_mul(0x0100_0193);
    }

    fn view(&self, body: &palpate::body::Body<'static>, out: &mut Vec<f32>) {
        let probe = self.state.probe();
        let next = view::next_step(body, &Controller::SECOND_ORDER, self.state.witness(), probe);
        view::write(&self.state, self.servo.surface(), next, probe, out);
    }

    fn hash(&self) -> u32 {
        self.hash
    }
}

/// The loop of a scene.
///
/// # Errors
/// What the loop refuses, in a sentence.
pub fn replay(loaded: &Loaded, scene: &Scene<'_>) -> Result<Box<dyn Replay>, String> {
    let device = mechanism::shipped(scene.device)
        .ok_or_else(|| alloc::format!("{}: the page knows no such device", scene.device))?;
    let device = Box::leak(Box::new(device));
    let settings = scene.settings;
    let servo =
        Servo::try_new(device, loaded.felt, Controller::SECOND_ORDER, settings).map_err(|error| error.to_string())?;
    let safety = Safety { link_timeout: scene.link_timeout, ..Safety::DEFAULT };
    if scene.protected {
        let servo = servo.try_protect(protection(scene.device)).map_err(|error| error.to_string())?;
        return recorded(servo.try_safety(safety).map_err(|error| error.to_string())?);
    }
    recorded(servo.try_safety(safety).map_err(|error| error.to_string())?)
}

fn recorded<G: Guard<3> + Send + 'static>(
    servo: Servo<'static, Felt, Mechanism, 3, G>,
) -> Result<Box<dyn Replay>, String>
where
    G::State: Send,
{
    Ok(Box::new(Recorded { state: servo.start(), servo, hash: 0 }))
}

fn protection(device: &str) -> Protection<3> {
    match device {
        "phantom-premium" => PHANTOM_PREMIUM_PROTECTION,
        "polhem-v2" => POLHEM_V2_PROTECTION,
        "falcon" => NOVINT_FALCON_PROTECTION,
        _ => WOODEN_HAPTICS_2016_PROTECTION,
    }
}

/// The settings as the page gives them: rate, stiffness, damping, greatest force, velocity corner, soft start, and
/// the body's origin.
pub fn settings(numbers: &[f32]) -> Option<Settings> {
    let &[rate, stiffness, damping, max_force, velocity_corner, soft_start, x, y, z] = numbers else { return None };
    Some(Settings { rate, stiffness, damping, max_force, velocity_corner, soft_start, body_origin: Vec3::new(x, y, z) })
}
