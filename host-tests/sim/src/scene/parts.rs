//! From the file's entries to what the library takes.

use super::file::{BodyEntry, JointEntry, MagnetEntry, SceneFile, SceneFileError, TextureEntry, ViscosityEntry};
use crate::recorded::{Entry, Movement, SceneNumbers, Turn};
use glam::{DMat3, DVec3};
use palpate::body::Body;
use palpate::math::{Vec3, vec3};
use palpate::render::{EffectField, Effects, Friction, Magnet, Texture, TextureShape, Viscosity};
use palpate::scene::{Joint, Limits, Material, Part, RigidBody, Scene, SceneError, Sphere, Tether};
use palpate::servo::Surface;
use palpate::track::Placement;

/// Shape of a body: its tables' frame in its model, and its bounding box in that frame, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Position of the tables' origin in the model.
    pub centre: DVec3,
    /// The box's lower corner.
    pub low: DVec3,
    /// Its upper corner.
    pub high: DVec3,
    /// How far its modes move its surface, metres; 0 of a rigid body.
    pub motion: f64,
}

impl Shape {
    fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Half the diagonal, and a thousandth for what the box was sampled by and for rounding; with the modes' motion.
    fn radius(&self) -> f32 {
        ((0.5 * (self.high - self.low).length() + self.motion) * 1.001) as f32
    }
}

impl SceneFile {
    /// The scene's limits: those of a device, with what the file says.
    pub fn limits(&self, of_device: Limits) -> Limits {
        Limits { release_n_per_s: self.let_go.unwrap_or(of_device.release_n_per_s), ..of_device }
    }

    /// A scene of the file's bodies, in its order.
    ///
    /// # Errors
    /// An error of the library, with the body's name.
    ///
    /// # Panics
    /// Where `N` is not the number of bodies.
    pub fn scene<S: Surface, const N: usize>(
        &self,
        limits: Limits,
        bodies: &[(&'static S, Shape)],
    ) -> Result<Scene<'static, S, N>, SceneFileError> {
        let (limits, parts) = (self.limits(limits), self.parts(limits.rate_hz, bodies));
        let parts = <[_; N]>::try_from(parts).unwrap_or_else(|_| panic!("not {N} bodies"));
        Scene::try_new(limits, parts).map_err(|error| {
            if let SceneError::Effects(index) = error
                && let Some(effects) = parts[usize::from(index)].material.effects
                && let Err(error) = effects.check(&limits.for_effects(&parts, index.into()))
            {
                let body = self.body[usize::from(index)].name.clone();
                return SceneFileError::Effect { body, error, value: number(effects, error.field) };
            }
            let index = match error {
                SceneError::Stiffness(index)
                | SceneError::Damping(index)
                | SceneError::Friction(index)
                | SceneError::Effects(index)
                | SceneError::Motion(index)
                | SceneError::Light(index)
                | SceneError::Slack(index)
                | SceneError::Sphere(index)
                | SceneError::Group(index) => Some(usize::from(index)),
                _ => None,
            };
            SceneFileError::Scene { body: index.and_then(|index| Some(self.body.get(index)?.name.clone())), error }
        })
    }

    /// The scene as a recording carries it; `which` says of each part which of the recorded bodies it is.
    pub fn numbers(&self, limits: Limits, bodies: &[(&'static Body<'static>, Shape)], which: &[u32]) -> SceneNumbers {
        let parts = self.parts(limits.rate_hz, bodies);
        let entries = self.body.iter().zip(bodies).zip(parts.iter().zip(which));
        let entries = entries.map(|((entry, (_, shape)), (part, which))| Entry {
            body: *which,
            movement: entry.movement(shape),
            stiffness: part.material.stiffness_n_per_m,
            damping: part.material.damping_n_s_per_m,
            friction: part.material.friction,
            effects: part.material.effects.copied(),
            sphere: part.sphere,
            group: part.group,
        });
        SceneNumbers { limits: self.limits(limits), entries: entries.collect() }
    }

    /// The parts of a scene, at a servo rate, Hz.
    pub fn parts<S>(&self, rate: f32, bodies: &[(&'static S, Shape)]) -> Vec<Part<'static, S>> {
        let entries = self.body.iter().zip(bodies);
        entries.map(|(entry, (body, shape))| entry.part(rate, *body, shape)).collect()
    }

    /// Whether a body of it deforms.
    pub fn is_soft(&self) -> bool {
        self.body.iter().any(|entry| entry.modes.is_some())
    }
}

impl BodyEntry {
    fn part<S>(&self, rate: f32, body: &'static S, shape: &Shape) -> Part<'static, S> {
        let friction = self.friction.map(|friction| Friction {
            stiffness_n_per_m: friction.stiffness,
            damping_n_s_per_m: friction.damping,
            static_coefficient: friction.static_coefficient,
            dynamic_coefficient: friction.dynamic_coefficient,
        });
        Part {
            surface: body,
            motion: self.movement(shape).at(rate),
            material: Material {
                stiffness_n_per_m: self.stiffness,
                damping_n_s_per_m: self.damping,
                friction,
                effects: self.effects(),
            },
            sphere: Sphere { centre_m: single(shape.middle()), radius_m: shape.radius() },
            group: self.group,
        }
    }

    /// They live as long as the program, as its surfaces do.
    fn effects(&self) -> Option<&'static Effects> {
        let texture = self.texture.map(|texture| match texture {
            TextureEntry::Ridges { across, pitch, share } => Texture {
                shape: TextureShape::Ridges { across: unit(across), pitch_m: (pitch * 1e-3) as f32 },
                max_fraction: share,
            },
            TextureEntry::Bumps { pitch, share } => {
                Texture { shape: TextureShape::Bumps { pitch_m: (pitch * 1e-3) as f32 }, max_fraction: share }
            }
        });
        let magnet =
            self.magnet.map(|MagnetEntry { force, reach }| Magnet { force_n: force, reach_m: (reach * 1e-3) as f32 });
        let viscosity = self.viscosity.map(|ViscosityEntry { damping, reach }| Viscosity {
            damping_n_s_per_m: damping,
            reach_m: (reach * 1e-3) as f32,
        });
        let is_any = texture.is_some() || magnet.is_some() || viscosity.is_some() || self.max_force.is_some();
        let max_force_n = self.max_force.unwrap_or(f32::INFINITY);
        is_any.then(|| &*Box::leak(Box::new(Effects { texture, magnet, viscosity, max_force_n })))
    }

    /// Where the frame of the tables is at the start.
    pub fn placement(&self, shape: &Shape) -> Placement {
        let turn = self.turned.map_or(DMat3::IDENTITY, |turned| {
            DMat3::from_axis_angle(DVec3::from_array(turned.axis).normalize(), turned.by.to_radians())
        });
        let origin = metres(self.at) + turn * shape.centre;
        let axes = [turn.x_axis, turn.y_axis, turn.z_axis].map(single);
        Placement { axes, origin: single(origin), ..Placement::IDENTITY }
    }

    /// How it moves.
    pub fn movement(&self, shape: &Shape) -> Movement {
        let start = self.placement(shape);
        if let Some(free) = &self.free {
            let size = shape.high - shape.low;
            let block = DVec3::new(
                size.y * size.y + size.z * size.z,
                size.x * size.x + size.z * size.z,
                size.x * size.x + size.y * size.y,
            );
            let inertia = free.inertia.map_or_else(|| single(block * f64::from(free.mass) / 12.0), Vec3::from_array);
            let middle = single(shape.middle());
            return Movement::Free(RigidBody {
                start,
                mass_kg: free.mass,
                inertia_kg_m2: inertia,
                centre_m: middle,
                joint: match free.joint {
                    None => Joint::Free,
                    Some(JointEntry::Fixed) => Joint::Fixed,
                    Some(JointEntry::Slider { axis }) => Joint::Slider(unit(axis)),
                    Some(JointEntry::Hinge { axis, about }) => {
                        Joint::Hinge { axis: unit(axis), pivot: single(metres(about)) }
                    }
                },
                gravity_m_per_s2: Vec3::from_array(free.gravity),
                damping_n_s_per_m: free.damping,
                angular_damping_n_m_s_per_rad: free.angular_damping,
                tether: free.spring.map(|spring| Tether {
                    anchor_m: start.point_to_a(middle),
                    slack_m: single(metres(spring.slack)),
                    stiffness_n_per_m: spring.stiffness,
                    damping_n_s_per_m: spring.damping,
                }),
                angular_stiffness_n_m_per_rad: free.angular_stiffness,
            });
        }
        if self.turns.is_none() && self.sways.is_none() {
            return Movement::Resting(start);
        }
        let turn = self.turns.map(|turn| Turn {
            axis: unit(turn.axis),
            pivot: single(metres(turn.about)),
            rate: turn.rate.to_radians() as f32,
        });
        let sway = self.sways.map(|sway| (single(metres(sway.by)), (sway.often * core::f64::consts::TAU) as f32));
        Movement::Prescribed { start, turn, sway }
    }
}

/// A number of an effect, in SI units.
fn number(effects: &Effects, field: EffectField) -> f32 {
    let (texture, magnet) = (effects.texture.as_ref(), effects.magnet.as_ref());
    match field {
        EffectField::MaxForce => Some(effects.max_force_n),
        EffectField::TextureFraction => texture.map(|texture| texture.max_fraction),
        EffectField::TexturePitch => texture.and_then(|texture| texture.shape.pitch()),
        EffectField::TextureAcross => None,
        EffectField::MagnetForce => magnet.map(|magnet| magnet.force_n),
        EffectField::MagnetReach => magnet.map(|magnet| magnet.reach_m),
        EffectField::ViscosityDamping => Some(effects.damping()),
        EffectField::ViscosityReach => effects.viscosity.map(|viscosity| viscosity.reach_m),
    }
    .unwrap_or(f32::NAN)
}

fn metres(millimetres: [f64; 3]) -> DVec3 {
    DVec3::from_array(millimetres) * 1e-3
}

fn unit(axis: [f64; 3]) -> Vec3 {
    single(DVec3::from_array(axis).normalize_or_zero())
}

fn single(vector: DVec3) -> Vec3 {
    vec3(vector.x as f32, vector.y as f32, vector.z as f32)
}
