//! A scene: bodies that move, felt by one tool.
//!
//! [`Scene`] is a [`crate::servo::Surface`] made of surfaces: the servo loop that feels one body feels a scene. Each
//! [`Part`] has a surface in its own frame, a [`Motion`] that places this frame at each tick, and a [`Material`]. The
//! tracker works in the body's frame, where the probe's velocity is the relative one: `Rᵀ (q̇ − v − ω × (Q − o))`,
//! which is what Remark 3's feed-forward wants; friction holds there, too, so that it rides on the body.
//!
//! A tick: the two bodies in hand are moved on and tracked; one other is looked at, and taken in hand if it is nearer;
//! then both press, and a free one is pushed in turn. Whatever was switched since the last tick, the force is that of
//! the last tick, and goes over to the new one at a bounded rate ([`Limits::release_n_per_s`]).

mod change;
mod command;
mod frame;
mod host_force;
mod limits;
mod part;
mod path;
mod quaternion;
mod rigid;
#[expect(clippy::module_inception, reason = "the scene is what the layer is named after")]
mod scene;
mod slot;
mod state;

pub use command::{BodyPose, Command, Commanded, SceneError};
pub use host_force::HOLD;
pub use limits::Limits;
pub use part::{Material, Motion, Part, PartState, Sphere};
pub use path::Path;
pub use rigid::{Joint, Moving, RigidBody, Tether, Wrench};
pub use scene::Scene;
pub use slot::{BodyStore, Slot, SlotWitness};
pub use state::SceneState;
