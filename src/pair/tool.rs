//! A tool: a convex core and the radius of the ball that rolls on it.

use super::step::Foot;
use crate::body::{Body, EdgeKind, Spoke};
use crate::math::{Vec3, inverse_sqrt, saturate, vec3};
use core::fmt;

/// The convex core of a tool. Half lengths in metres, about the origin of the tool's frame.
#[derive(Clone, Copy, Debug)]
pub enum Core<'a> {
    /// The origin: a ball.
    Point,
    /// A segment along z: a stylus or a finger.
    Segment {
        /// Half its length.
        half: f32,
    },
    /// A solid box.
    Box {
        /// Half its sides.
        half: [f32; 3],
    },
    /// A convex body.
    Body(&'a Body<'a>),
}

/// Minimum radius of a tool for contact, as a share of its core's largest half length.
const MIN_RADIUS: f32 = 0.01;

/// A convex core and a radius: the tool is the core with a ball rolled over it.
#[derive(Clone, Copy, Debug)]
pub struct Tool<'a> {
    core: Core<'a>,
    radius: f32,
}

/// Why a tool is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ToolError {
    /// A half length is negative, above 1e6 m, or no number.
    Half,
    /// The radius is negative, above 1e6 m, or no number.
    Radius,
    /// The core is a body that is not convex.
    NotConvex,
}

impl fmt::Display for ToolError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Half => "half: half lengths must be 0 to 1e6 m",
            Self::Radius => "radius: must be 0 to 1e6 m",
            Self::NotConvex => "core: the body of a tool must be certified convex; split it into convex tools",
        })
    }
}

impl core::error::Error for ToolError {}

impl<'a> Tool<'a> {
    /// A tool of a core and a radius, metres.
    ///
    /// # Errors
    /// A length that is negative, above 1e6 m or no number, and a core that is not convex.
    pub const fn new(core: Core<'a>, radius: f32) -> Result<Self, ToolError> {
        let bad = match &core {
            Core::Point => None,
            Core::Segment { half } if is_length(*half) => None,
            Core::Box { half: [x, y, z] } if is_length(*x) && is_length(*y) && is_length(*z) => None,
            Core::Segment { .. } | Core::Box { .. } => Some(ToolError::Half),
            Core::Body(body) if body.is_convex() => None,
            Core::Body(_) => Some(ToolError::NotConvex),
        };
        match bad {
            Some(error) => Err(error),
            None if !is_length(radius) => Err(ToolError::Radius),
            None => Ok(Self { core, radius }),
        }
    }

    /// The core.
    pub const fn core(&self) -> &Core<'a> {
        &self.core
    }

    /// The radius, metres.
    pub const fn radius(&self) -> f32 {
        self.radius
    }

    /// Whether the radius is at least 1 % of the core's largest half length, as a tool for contact needs: nearer, the
    /// normal is lost to rounding (theory §14).
    pub const fn is_thick(&self) -> bool {
        let largest = match &self.core {
            Core::Point => 0.0,
            Core::Segment { half } => *half,
            Core::Box { half: [x, y, z] } => {
                let across = if *x > *y { *x } else { *y };
                if across > *z { across } else { *z }
            }
            Core::Body(body) => 0.5 * body.size(),
        };
        self.radius > 0.0 && self.radius >= MIN_RADIUS * largest
    }

    /// Where the core's point may be.
    pub(super) fn region(&self) -> Region<'a> {
        match self.core {
            Core::Point => Region::Solid { middle: Vec3::ZERO, half: Vec3::ZERO },
            Core::Segment { half } => Region::Solid { middle: Vec3::ZERO, half: vec3(0.0, 0.0, half) },
            Core::Box { half } => Region::Solid { middle: Vec3::ZERO, half: Vec3::from_array(half) },
            Core::Body(body) => Region::Surface(body),
        }
    }

    /// The corners of the core: at most `N` of them.
    pub(super) fn corners<const N: usize>(&self) -> [Option<Foot>; N] {
        let mut corners = [None; N];
        let mut free = corners.iter_mut();
        match self.region() {
            Region::Surface(body) => {
                for vertex in body.vertices() {
                    let first = usize::from(vertex.first_spoke);
                    let spokes = body.spokes().get(first..first + usize::from(vertex.spokes)).unwrap_or(&[]);
                    let edge_of = |spoke: &Spoke| body.edges().get(usize::from(spoke.edge));
                    let is_sharp = |spoke: &&Spoke| edge_of(spoke).is_some_and(|edge| edge.kind != EdgeKind::Smooth);
                    let Some(spoke) = spokes.iter().find(is_sharp) else { continue };
                    let t = if spoke.at_upper_end { 1.0 } else { 0.0 };
                    let place = edge_of(spoke).and_then(|edge| body.position_on_face(edge.faces[0], t));
                    if let (Some((face, at)), Some(corner)) = (place, free.next()) {
                        *corner = Some(Foot::on(body, face, at));
                    }
                }
            }
            // A point is the pair itself.
            Region::Solid { half: Vec3::ZERO, .. } => {}
            Region::Solid { middle, half } => {
                for signs in 0..8_u8 {
                    let is_upper = [0, 1, 2].map(|axis| signs >> axis & 1 == 1);
                    let half = half.to_array();
                    let is_double = (0..3).any(|axis| is_upper[axis] && half[axis] <= 0.0);
                    // Asked last: it would leave a place free.
                    if !is_double && let Some(corner) = free.next() {
                        let at: [f32; 3] = core::array::from_fn(|k| if is_upper[k] { half[k] } else { -half[k] });
                        *corner = Some(Foot::in_solid(middle + Vec3::from_array(at)));
                    }
                }
            }
        }
        corners
    }
}

impl Tool<'_> {
    /// Half the edges of a box, and quarters of a segment: their middles and half lengths. An edge that crosses two of
    /// the body's touches at two places.
    pub(super) fn edges(&self) -> impl Iterator<Item = (Vec3, Vec3)> {
        let (half, pieces) = match self.core {
            Core::Box { half } => (half, 2_u8),
            Core::Segment { half } => ([0.0, 0.0, half], 4),
            Core::Point | Core::Body(_) => ([0.0; 3], 0),
        };
        (0..12_usize).flat_map(move |index| {
            let (along, signs) = (index / 4, index % 4);
            let across = [(along + 1) % 3, (along + 2) % 3];
            let is_double = (0..2).any(|side| signs >> side & 1 == 1 && half[across[side]] <= 0.0);
            let mut middle = [0.0; 3];
            for (side, axis) in across.into_iter().enumerate() {
                middle[axis] = if signs >> side & 1 == 1 { half[axis] } else { -half[axis] };
            }
            let mut piece = [0.0; 3];
            piece[along] = half[along] / f32::from(pieces);
            let pieces = if half[along] > 0.0 && !is_double { pieces } else { 0 };
            let (step, end) = (piece[along], half[along]);
            (0..pieces).map(move |number| {
                // In a closure of its own the index has lost its bound, and would be a branch to a panic.
                if let Some(place) = middle.get_mut(along) {
                    *place = step * f32::from(2 * number + 1) - end;
                }
                (Vec3::from_array(middle), Vec3::from_array(piece))
            })
        })
    }

    /// How far the core reaches along each axis of its frame, at most, metres.
    pub(super) fn extents(&self) -> Vec3 {
        match self.core {
            Core::Point => Vec3::ZERO,
            Core::Segment { half } => vec3(0.0, 0.0, half),
            Core::Box { half } => Vec3::from_array(half),
            Core::Body(body) => Vec3::splat(body.size()),
        }
    }
}

/// Where the core's point may be: in a box of its coordinates, or on the faces of a body.
#[derive(Clone, Copy, Debug)]
pub(super) enum Region<'a> {
    Solid { middle: Vec3, half: Vec3 },
    Surface(&'a Body<'a>),
}

impl Region<'_> {
    /// The region if it is a solid, otherwise the origin.
    pub const fn solid(&self) -> Region<'static> {
        match self {
            Self::Solid { middle, half } => Region::Solid { middle: *middle, half: *half },
            Self::Surface(_) => Region::Solid { middle: Vec3::ZERO, half: Vec3::ZERO },
        }
    }

    /// The nearest point to another, in the tool's frame, and the face of the body that holds it with its parameters.
    pub fn nearest(&self, to: Vec3) -> (Vec3, u16, [f32; 2]) {
        match self {
            Self::Solid { middle, half } => {
                let along = |x: f32, middle: f32, half: f32| saturate(x, middle - half, middle + half);
                let x = along(to.x, middle.x, half.x);
                (vec3(x, along(to.y, middle.y, half.y), along(to.z, middle.z, half.z)), 0, [0.0; 2])
            }
            Self::Surface(body) => {
                let located = body.locate(to);
                (located.point, located.face, located.parameters)
            }
        }
    }
}

/// The unit vector along a vector; zero of zero.
pub(super) fn unit(vector: Vec3) -> Vec3 {
    let squared = vector.length_squared();
    if squared > f32::MIN_POSITIVE { vector * inverse_sqrt(squared) } else { Vec3::ZERO }
}

/// Above it squares and products of lengths leave the numbers; NaN fails too.
const MAX_LENGTH_M: f32 = 1.0e6;

const fn is_length(x: f32) -> bool {
    x >= 0.0 && x <= MAX_LENGTH_M
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_come_first_in_their_places() {
        for (half, count) in [([0.0; 3], 0), ([0.0, 0.0, 0.01], 2), ([0.01, 0.0, 0.01], 4), ([0.01; 3], 8)] {
            let tool = Tool::new(Core::Box { half }, 0.003).unwrap_or_else(|error| panic!("{half:?}: {error}"));
            let corners = tool.corners::<8>();
            assert_eq!(corners.iter().take_while(|corner| corner.is_some()).count(), count, "{half:?}");
            assert_eq!(corners.iter().flatten().count(), count, "{half:?}");
        }
    }
}
