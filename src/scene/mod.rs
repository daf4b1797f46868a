//! A scene: bodies that move, touched by one tool.
//!
//! [`Scene`] is a [`crate::servo::Surface`] made of surfaces: the servo loop that renders one body renders a scene.
//! Each [`Part`] has a surface in its own frame, a [`Motion`] that places this frame at each tick, and a [`Material`].
//! The tracker works in the body's frame, where the probe's velocity is the relative one: `Rᵀ (q̇ − v − ω × (Q − o))`,
//! as Remark 3's feed-forward requires; friction acts in that frame too, so that it moves with the body.
//!
//! A tick moves and tracks the two nearest bodies and checks one other, which replaces one of them if it is nearer;
//! then both press, and a free one is pushed in turn. After a switch the force starts from that of the last tick, and
//! moves to the new one at a bounded rate ([`Limits::release_n_per_s`]).

mod change;
mod command;
mod frame;
mod host_force;
mod limits;
mod part;
mod path;
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
