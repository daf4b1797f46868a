//! A tool with a shape in the loop: the drawn tool is held outside of the body, and the hand's is coupled to it.

use super::{DEFAULT_CELLS, Proxy, ProxyError, Tool, ToolCoupling};
use crate::body::{Body, TableCursor};
use crate::math::{Vec3, inverse_sqrt, product, sqrt};
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::scene::BodyPose;
use crate::servo::{BakedTables, Settings, Surface, Touched, Tracked, witness_words};
use crate::track::{BoundaryMode, Contact, Controller, Probe, Witness};

/// Relative to the body's size: a stretch below is rounding.
const NO_STRETCH: f32 = 1.0e-6;
/// Seconds after which an orientation is old.
const MAX_AGE_S: f32 = 0.02;
/// Maximum angular speed of a hand, rad/s: the proxy turns no faster.
const MAX_TURN_RAD_PER_S: f32 = 40.0;

/// A tool of some shape on a body, for a device that senses the orientation of its handle and drives three joints.
///
/// The tool's frame has its origin at the probe, about which the handle turns, and the orientation of the last
/// [`crate::servo::Event::Oriented`]: send one before every tick, from the encoders of a gimbal ([`crate::device::Wrist`]) or
/// an inertial sensor. The drawn tool ([`Proxy`]) has the hand's orientation and lies where no contact is closed; the
/// loop's wall pulls the probe to it, with its stiffness, damping, limits and slew.
///
/// There is no force before the first orientation, until all contacts are located, and while the hand's tool is in the
/// body then: keep it outside until [`HeldTool::is_located`]. A tool that goes in before passes in without a force, and there
/// is none until it was out; [`HeldTool::given_up`] says so. A location ends within 900 ticks everywhere. Measured are 14
/// (ball), 33 (capsule) and 110 (box) beside convex bodies, and up to 450 where many places are as near.
///
/// An orientation that is older than 20 ms, no rotation, or 40 rad/s from the one before ends contact as an implausible one does ([`crate::servo::ContactLimits`]): the force fades, the contacts are located again.
///
/// The work of a tick is bounded, but large: on the capped box a ball takes at most 6,845 instructions of a Cortex-M4F, a
/// capsule 15,559 and a box 23,270 (`palpate budgets --tool MODEL`; in single ticks, in which the face changes). Count it
/// for your body and tool before you choose a rate; a tick that is late is a fault.
///
/// Without torque the force does not conserve energy along paths that turn the tool in contact (Barbagli & Salisbury
/// 2003): keep the device's own damping above half a tick's stiffness. Friction is the proxy's
/// ([`Self::with_friction`]); a point's friction, texture and virtual coupling are refused.
///
/// ```
/// use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face};
/// use palpate::math::{Vec3, vec3};
/// use palpate::pair::{Core, Tool, ToolSurface};
/// use palpate::servo::{Settings, Surface, Tracked};
/// use palpate::track::{Contact, Controller, Probe};
///
/// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
/// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// // A finger of 24 mm, 6 mm thick, beside a box of 60 × 40 × 20 mm whose corner is the origin.
/// let finger = Tool::new(Core::Segment { half: 0.009 }, 0.003).unwrap();
/// let settings = Settings { rate_hz: 4_000.0, ..Settings::DEFAULT };
/// let surface = ToolSurface::new(&body, finger, &settings).unwrap();
/// let mut held = surface.rest();
/// for tick in 0..2_000 {
///     surface.orient(&mut held, [0.0, 0.0, 0.0, 1.0]);
///     let x = if tick < 1_000 { 0.08 } else { 0.08 - 18e-6 * (tick - 999) as f32 };
///     surface.follow(&Controller::SecondOrder, &mut held, Probe::at(vec3(x, 0.02, 0.01)), 2.5e-4);
/// }
/// // The probe is 2 mm from the side plus the radius: 1 mm too deep.
/// assert_eq!(held.contact(), Contact::Touching);
/// assert!((held.gap() + 0.001).abs() < 2e-5);
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ToolSurface<'a> {
    body: &'a Body<'a>,
    tool: Tool<'a>,
    coupling: ToolCoupling,
    cells: u16,
    period: f32,
    max_age: u16,
    /// Half the maximum turn in a tick, radians.
    half_turn: f32,
}

/// State of a tool in the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTool {
    proxy: Proxy,
    orientation: [f32; 4],
    /// Ticks since the last orientation.
    age: u16,
    is_plausible: bool,
    witness: Witness,
    gap: f32,
    contact: Contact,
}

impl<'a> ToolSurface<'a> {
    /// A body, `&part::BODY` of a baked module, and a tool, for a loop of these settings. Its default work visits 16 cells
    /// of the audit a tick on a body that is not convex ([`Self::with_cells`]).
    ///
    /// # Errors
    /// A tool that is too thin, and settings whose rate or stiffness is not positive and finite.
    pub const fn new(body: &'a Body<'a>, tool: Tool<'a>, settings: &Settings) -> Result<Self, ProxyError> {
        let rate = settings.rate_hz;
        let Some(coupling) = ToolCoupling::without_torque(settings.stiffness_n_per_m, rate) else {
            return Err(ProxyError::Coupling);
        };
        if !tool.is_thick() {
            return Err(ProxyError::Thin);
        }
        // The casts saturate.
        let max_age = (MAX_AGE_S * rate) as u16;
        Ok(Self {
            body,
            tool,
            coupling,
            cells: DEFAULT_CELLS,
            period: 1.0 / rate,
            max_age: if max_age == 0 { 1 } else { max_age },
            half_turn: 0.5 * MAX_TURN_RAD_PER_S / rate,
        })
    }

    /// The same with another number of cells of the audit in a tick, on a body that is not convex.
    #[must_use]
    pub const fn with_cells(self, cells: u16) -> Self {
        Self { cells, ..self }
    }

    /// The same with dry friction at the contacts ([`ToolCoupling::with_friction`]).
    ///
    /// # Errors
    /// A coefficient that is not from 0 to 2.
    pub const fn with_friction(self, coefficient: f32) -> Result<Self, ProxyError> {
        match self.coupling.with_friction(coefficient) {
            Some(coupling) => Ok(Self { coupling, ..self }),
            None => Err(ProxyError::Friction),
        }
    }

    /// The body.
    pub const fn body(&self) -> &'a Body<'a> {
        self.body
    }

    /// The tool.
    pub const fn tool(&self) -> &Tool<'a> {
        &self.tool
    }
}

impl HeldTool {
    /// The drawn tool and its contacts.
    pub const fn proxy(&self) -> &Proxy {
        &self.proxy
    }

    /// The orientation of the tool, a quaternion `(x, y, z, w)` of the device's frame.
    pub const fn orientation(&self) -> [f32; 4] {
        self.orientation
    }

    /// Whether all contacts are known. Until then there is no force, and the tool can pass into the body.
    pub const fn is_located(&self) -> bool {
        self.proxy.is_located()
    }

    /// Why there is no contact with the body: it was given up, is not located (again) yet, or the tool lies in it.
    pub const fn given_up(&self) -> Option<ProxyError> {
        self.proxy.given_up()
    }
}

impl Surface for ToolSurface<'_> {
    type Witness = HeldTool;

    const HAS_SHAPED_TOOL: bool = true;

    fn rest(&self) -> HeldTool {
        let surface = SurfacePoint { point: Vec3::ZERO, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        let (second, mode) = (SecondDerivatives::NONE, BoundaryMode::Interior);
        HeldTool {
            proxy: Proxy::unlocated(),
            orientation: [0.0, 0.0, 0.0, 1.0],
            age: u16::MAX,
            is_plausible: false,
            witness: Witness { parameters: [0.0; 2], surface, second, mode, is_free: true, halvings: 0 },
            gap: 0.0,
            contact: Contact::Behind,
        }
    }

    fn is_for(&self, period: f32) -> bool {
        (period - self.period).abs() <= 1e-3 * self.period
    }

    /// One tick of the proxy: bounded work, as [`Proxy::tick_located`]'s.
    fn follow(&self, _: &Controller, held: &mut HeldTool, probe: Probe, _: f32) -> Touched {
        held.age = held.age.saturating_add(1);
        let is_known = held.is_plausible && held.age <= self.max_age;
        let orientation = if is_known { held.orientation } else { [0.0; 4] };
        let hand = BodyPose { position: probe.position.to_array(), orientation };
        let was_holding = held.proxy.is_holding();
        held.proxy.tick_located(self.body, &self.tool, &self.coupling, &hand, self.cells);
        held.show();
        if !held.proxy.is_holding() {
            held.gap = 0.0;
            // In this tick the loop still sees the contact that it is to release.
            let unexplained = was_holding && held.contact == Contact::Touching;
            if !unexplained {
                held.contact = Contact::Behind;
            }
            return Touched { normal: Vec3::ZERO, rejected: false, unexplained };
        }
        let stretch = held.proxy.stretch();
        let squared = stretch.length_squared();
        let smallest = NO_STRETCH * self.body.size();
        let (gap, away, contact) = if squared > smallest * smallest {
            (-sqrt(squared), stretch, Contact::Touching)
        } else {
            (held.proxy.distance(), held.proxy.difference(), Contact::InFront)
        };
        (held.gap, held.contact) = (gap, contact);
        let squared = away.length_squared();
        let normal = if squared > f32::MIN_POSITIVE { away * -inverse_sqrt(squared) } else { Vec3::ZERO };
        Touched { normal, rejected: false, unexplained: false }
    }

    fn release(&self, held: &mut HeldTool) {
        held.proxy = Proxy::unlocated();
        (held.contact, held.gap) = (Contact::Behind, 0.0);
    }

    fn orient(&self, held: &mut HeldTool, orientation: [f32; 4]) {
        let [x, y, z, w] = held.orientation;
        let [a, b, c, _] = product(&orientation, &[-x, -y, -z, w]);
        let sine_squared = a * a + b * b + c * c;
        let ticks = f32::from(held.age) + 1.0;
        let most = self.half_turn * ticks;
        let is_first = held.age > self.max_age;
        // A NaN fails too. The proxy refuses numbers that are no rotation.
        held.is_plausible = is_first || sine_squared <= most * most;
        (held.orientation, held.age) = (orientation, 0);
    }
}

impl HeldTool {
    /// The body's witness point as the loop reports it.
    fn show(&mut self) {
        let foot = &self.proxy.tracker().pair().a;
        // Each from its place to its place: together they would go over the stack.
        self.witness.parameters = foot.parameters;
        self.witness.surface = foot.curved.surface;
        self.witness.second = foot.curved.second;
    }
}

impl BakedTables for ToolSurface<'_> {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.body.table_word(cursor)
    }

    fn table_records(&self) -> u32 {
        self.body.table_records()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.body.baked_crc()
    }
}

impl Tracked for HeldTool {
    fn witness(&self) -> &Witness {
        &self.witness
    }

    fn gap(&self) -> f32 {
        self.gap
    }

    fn contact(&self) -> Contact {
        self.contact
    }

    /// The face of the pair's witness point.
    fn feature(&self) -> u16 {
        self.proxy.tracker().pair().a.face
    }

    /// The drawn tool's pose, the hand's orientation and the pair, from which all else of a tick follows or shows in the
    /// next.
    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        let pose = self.proxy.pose();
        for number in pose.position.iter().chain(&pose.orientation).chain(&self.orientation) {
            take(number.to_bits());
        }
        take(u32::from(self.age) | u32::from(self.is_plausible) << 16 | (self.contact as u32) << 17);
        take(u32::from(self.proxy.is_holding()) | u32::from(self.feature()) << 1);
        for coordinate in self.proxy.tracker().pair().b.point().to_array() {
            take(coordinate.to_bits());
        }
        take(self.gap.to_bits());
        witness_words(&self.witness, take);
    }
}
