//! A scene: how each of its bodies moves and feels, and which it is.

use crate::recorded::walk::{Filled, Taken, Walk};
use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::render::{Effects, Friction, Magnet, Texture, TextureShape, Viscosity};
use palpate::scene::{Joint, Limits, Material, Motion, Part, Path, RigidBody, Sphere, Tether};
use palpate::track::Placement;

/// The scene of a recorded run.
#[derive(Clone, Debug)]
pub struct SceneNumbers {
    /// Limits of all its parts.
    pub limits: Limits,
    /// Its parts, in their order.
    pub entries: Vec<Entry>,
}

/// A part of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Index of its body, which several parts may share.
    pub body: u32,
    /// How it moves.
    pub movement: Movement,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
    /// Dry friction.
    pub friction: Option<Friction>,
    /// Its effects; the texture is a named shape.
    pub effects: Option<Effects>,
    /// Bounding sphere.
    pub sphere: Sphere,
    /// The group it belongs to.
    pub group: u8,
}

/// How a part moves: as [`Motion`] has it, but for what a [`Path`] works out when it is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Movement {
    /// It rests.
    Resting(Placement),
    /// It turns and sways.
    Prescribed {
        /// Where it starts.
        start: Placement,
        /// About what it turns.
        turn: Option<Turn>,
        /// By how far it sways, metres, and its rate, rad/s.
        sway: Option<(Vec3, f32)>,
    },
    /// It is free.
    Free(RigidBody),
}

/// A turn about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// A unit vector.
    pub axis: Vec3,
    /// A point of the axis, metres.
    pub pivot: Vec3,
    /// rad/s.
    pub rate: f32,
}

const NO_LIMITS: Limits = Limits {
    max_stiffness_n_per_m: 0.0,
    max_damping_n_s_per_m: 0.0,
    max_force_n: 0.0,
    release_n_per_s: 0.0,
    rate_hz: 0.0,
    max_speed_m_per_s: 0.0,
};

const VACANT: Entry = Entry {
    body: 0,
    movement: Movement::Resting(Placement::IDENTITY),
    stiffness: 0.0,
    damping: 0.0,
    friction: None,
    effects: None,
    sphere: Sphere { centre_m: Vec3::ZERO, radius_m: 0.0 },
    group: 0,
};

const FRICTION: Friction =
    Friction { stiffness_n_per_m: 0.0, damping_n_s_per_m: 0.0, static_coefficient: 0.0, dynamic_coefficient: 0.0 };

const TETHER: Tether =
    Tether { anchor_m: Vec3::ZERO, slack_m: Vec3::ZERO, stiffness_n_per_m: 0.0, damping_n_s_per_m: 0.0 };

/// No scene has more parts.
const MOST: u32 = 32;

impl SceneNumbers {
    /// Its numbers.
    pub fn numbers(&self) -> Vec<f32> {
        let (mut taken, mut copy) = (Taken::default(), self.clone());
        copy.walk(&mut taken);
        taken.0
    }

    /// From its numbers; `None` where these are too few or too many.
    pub fn of(numbers: &[f32]) -> Option<Self> {
        let (mut filled, mut scene) = (Filled::new(numbers), Self { limits: NO_LIMITS, entries: Vec::new() });
        scene.walk(&mut filled);
        filled.is_whole().then_some(scene)
    }

    /// Its parts, each with its body; `None` where there is no such body.
    pub fn parts(&self, bodies: &[&'static Body<'static>]) -> Option<Vec<Part<'static, Body<'static>>>> {
        self.entries.iter().map(|entry| entry.part(self.limits.rate_hz, bodies)).collect()
    }

    fn walk(&mut self, walk: &mut impl Walk) {
        let Limits {
            max_stiffness_n_per_m: max_stiffness,
            max_damping_n_s_per_m: max_damping,
            max_force_n: max_force,
            release_n_per_s: let_go,
            rate_hz: rate,
            max_speed_m_per_s: max_speed,
        } = &mut self.limits;
        for number in [max_stiffness, max_damping, max_force, let_go, rate, max_speed] {
            walk.number(number);
        }
        let count = walk.count(self.entries.len() as u32).min(MOST);
        if self.entries.len() != count as usize {
            self.entries = vec![VACANT; count as usize];
        }
        for entry in &mut self.entries {
            entry.walk(walk);
        }
    }
}

impl Entry {
    fn part(&self, rate: f32, bodies: &[&'static Body<'static>]) -> Option<Part<'static, Body<'static>>> {
        let Self { body, movement, stiffness, damping, friction, effects, sphere, group } = *self;
        let effects = effects.map(|effects| &*Box::leak(Box::new(effects)));
        let material = Material { friction, effects, ..Material::new(stiffness, damping) };
        Some(Part { surface: *bodies.get(body as usize)?, motion: movement.at(rate), material, sphere, group })
    }

    fn walk(&mut self, walk: &mut impl Walk) {
        let Self { body, movement, stiffness, damping, friction, effects, sphere, group } = self;
        *body = walk.count(*body);
        movement.walk(walk);
        walk.number(stiffness);
        walk.number(damping);
        walk.maybe(friction, FRICTION, |walk, friction| {
            let Friction {
                stiffness_n_per_m: stiffness,
                damping_n_s_per_m: damping,
                static_coefficient,
                dynamic_coefficient,
            } = friction;
            for number in [stiffness, damping, static_coefficient, dynamic_coefficient] {
                walk.number(number);
            }
        });
        walk.maybe(effects, Effects::NONE, of_effects);
        walk.vector(&mut sphere.centre_m);
        walk.number(&mut sphere.radius_m);
        *group = walk.count((*group).into()) as u8;
    }
}

fn of_effects(walk: &mut impl Walk, effects: &mut Effects) {
    let Effects { texture, magnet, viscosity, max_force_n } = effects;
    let vacant = Texture { shape: TextureShape::Bumps { pitch_m: 0.0 }, max_fraction: 0.0 };
    walk.maybe(texture, vacant, |walk, Texture { shape, max_fraction }| {
        let (mut across, mut pitch) = match *shape {
            TextureShape::Ridges { across, pitch_m } => (Some(across), pitch_m),
            TextureShape::Bumps { pitch_m } => (None, pitch_m),
            TextureShape::Custom(_) => (None, 0.0),
        };
        walk.maybe(&mut across, Vec3::ZERO, |walk, across| walk.vector(across));
        walk.number(&mut pitch);
        let pitch_m = pitch;
        *shape = across.map_or(TextureShape::Bumps { pitch_m }, |across| TextureShape::Ridges { across, pitch_m });
        walk.number(max_fraction);
    });
    walk.maybe(magnet, Magnet { force_n: 0.0, reach_m: 0.0 }, |walk, Magnet { force_n, reach_m }| {
        walk.number(force_n);
        walk.number(reach_m);
    });
    let vacant = Viscosity { damping_n_s_per_m: 0.0, reach_m: 0.0 };
    walk.maybe(viscosity, vacant, |walk, Viscosity { damping_n_s_per_m, reach_m }| {
        walk.number(damping_n_s_per_m);
        walk.number(reach_m);
    });
    walk.number(max_force_n);
}

impl Movement {
    /// As the library takes it, at a servo rate, Hz.
    pub fn at(&self, servo_rate: f32) -> Motion {
        match *self {
            Self::Resting(start) => Motion::Resting(start),
            Self::Free(body) => Motion::Free(body),
            Self::Prescribed { start, turn, sway } => {
                let mut path = Path::new(start);
                if let Some(Turn { axis, pivot, rate }) = turn {
                    path = path.turning(axis, pivot, rate, servo_rate);
                }
                if let Some((amplitude, rate)) = sway {
                    path = path.swaying(amplitude, rate, servo_rate);
                }
                Motion::Prescribed(path)
            }
        }
    }

    fn walk(&mut self, walk: &mut impl Walk) {
        let kind = match self {
            Self::Resting(_) => 0,
            Self::Prescribed { .. } => 1,
            Self::Free(_) => 2,
        };
        let (wanted, start) = (walk.count(kind), Placement::IDENTITY);
        if wanted != kind {
            *self = match wanted {
                0 => Self::Resting(start),
                1 => Self::Prescribed { start, turn: None, sway: None },
                _ => Self::Free(RigidBody::new(start, 0.0, Vec3::ZERO)),
            };
        }
        match self {
            Self::Resting(start) => placement(walk, start),
            Self::Prescribed { start, turn, sway } => {
                placement(walk, start);
                walk.maybe(turn, Turn { axis: Vec3::ZERO, pivot: Vec3::ZERO, rate: 0.0 }, |walk, turn| {
                    let Turn { axis, pivot, rate } = turn;
                    walk.vector(axis);
                    walk.vector(pivot);
                    walk.number(rate);
                });
                walk.maybe(sway, (Vec3::ZERO, 0.0), |walk, (amplitude, rate)| {
                    walk.vector(amplitude);
                    walk.number(rate);
                });
            }
            Self::Free(body) => rigid(walk, body),
        }
    }
}

fn placement(walk: &mut impl Walk, of: &mut Placement) {
    let Placement { axes, origin, velocity, angular_velocity } = of;
    for vector in axes {
        walk.vector(vector);
    }
    for vector in [origin, velocity, angular_velocity] {
        walk.vector(vector);
    }
}

fn rigid(walk: &mut impl Walk, body: &mut RigidBody) {
    let RigidBody {
        start,
        mass_kg: mass,
        inertia_kg_m2: inertia,
        centre_m: centre,
        joint: of_joint,
        gravity_m_per_s2: gravity,
        ..
    } = body;
    let RigidBody {
        damping_n_s_per_m: damping,
        angular_damping_n_m_s_per_rad: angular_damping,
        tether,
        angular_stiffness_n_m_per_rad: angular_stiffness,
        ..
    } = body;
    placement(walk, start);
    walk.number(mass);
    walk.vector(inertia);
    walk.vector(centre);
    joint(walk, of_joint);
    walk.vector(gravity);
    for number in [damping, angular_damping, angular_stiffness] {
        walk.number(number);
    }
    walk.maybe(tether, TETHER, |walk, tether| {
        let Tether { anchor_m: anchor, slack_m: slack, stiffness_n_per_m: stiffness, damping_n_s_per_m: damping } =
            tether;
        walk.vector(anchor);
        walk.vector(slack);
        walk.number(stiffness);
        walk.number(damping);
    });
}

fn joint(walk: &mut impl Walk, joint: &mut Joint) {
    let mut axes = match *joint {
        Joint::Free | Joint::Fixed => [Vec3::ZERO; 2],
        Joint::Slider(axis) => [axis, Vec3::ZERO],
        Joint::Hinge { axis, pivot } => [axis, pivot],
    };
    let kind = walk.count(match joint {
        Joint::Free => 0,
        Joint::Fixed => 1,
        Joint::Slider(_) => 2,
        Joint::Hinge { .. } => 3,
    });
    for vector in &mut axes {
        walk.vector(vector);
    }
    let [axis, pivot] = axes;
    *joint = match kind {
        0 => Joint::Free,
        1 => Joint::Fixed,
        2 => Joint::Slider(axis),
        _ => Joint::Hinge { axis, pivot },
    };
}
