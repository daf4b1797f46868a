//! A body and a tool at a pose, and the steps of a pair there.

use super::step::{Foot, Moved, Pair};
use super::tool::Region;
use crate::body::{Body, EdgeKind};
use crate::math::sqrt;
use crate::track::Placement;

/// Maximum steps of a pair in a tick: one more after each switch.
const MAX_SWITCHES: u8 = 3;
/// Relative to the size: bodies nearer than this intersect, as far as their coordinates tell.
pub(super) const TOUCHING: f32 = 1.0e-6;
/// Relative to the size: a pair takes the place of another if it is nearer by more.
pub(super) const NEARER: f32 = 3.0e-8;

/// A body and a tool at a pose, and what has been spent on them.
pub(super) struct Scene<'a> {
    pub body: &'a Body<'a>,
    pub region: Region<'a>,
    pub placement: &'a Placement,
    pub evaluations: u32,
}

impl Scene<'_> {
    pub(super) fn distance(&self, pair: &Pair) -> f32 {
        sqrt(pair.difference(self.placement).length_squared())
    }

    /// A step of the pair, and then the switches: asked before the step, with the new pose, motion along an edge would
    /// hide that the pair wants to cross it.
    pub(super) fn tick(&mut self, pair: &mut Pair) -> Moved {
        let region = self.region;
        self.tick_on(&region, pair, [false; 2]).0
    }

    /// Steps until none ends with a switch: behind an edge the first ends on it, short of the closest pair.
    pub(super) fn follow(&mut self, region: &Region, pair: &mut Pair) -> (Moved, bool) {
        let (mut moved, mut switched) = (Moved::AtRest, true);
        for _ in 0..MAX_SWITCHES {
            if switched {
                (moved, switched) = self.tick_on(region, pair, [false; 2]);
            }
        }
        (moved, switched)
    }

    /// One step; whether a point has changed its face as well.
    pub(super) fn tick_on(&mut self, region: &Region, pair: &mut Pair, held: [bool; 2]) -> (Moved, bool) {
        let mut moved = pair.step(self.body, region, self.placement, held);
        self.evaluations += 1;
        let towards = -pair.difference(self.placement);
        let mut switched = held == [false; 2] && pair.a.hand_over(self.body, towards);
        if let Region::Surface(core) = region {
            self.evaluations += 1;
            switched |= pair.b.hand_over(core, -self.placement.direction_to_b(towards));
        }
        if switched {
            (moved, self.evaluations) = (Moved::Nearer, self.evaluations + 1);
        }
        (moved, switched)
    }

    /// The nearest point of the body to a point of the core.
    pub(super) fn beneath(&mut self, b: Foot) -> Pair {
        let located = self.body.locate(self.placement.point_to_a(b.point()));
        self.evaluations += u32::from(located.evaluations);
        Pair { a: Foot::on(self.body, located.face, located.parameters), b, halvings: 0 }
    }

    /// Whether the body has an inside: no open edge.
    pub(super) fn has_inside(&self) -> bool {
        self.body.edges().iter().all(|edge| edge.kind != EdgeKind::Open)
    }

    /// The sign test: whether the two support planes part the bodies. A rest of convex bodies is then their closest
    /// pair. A solid's nearest point needs no test.
    pub(super) fn is_global(&self, pair: &Pair) -> bool {
        let difference = pair.difference(self.placement);
        let of_body = pair.a.outward(self.body).dot(difference) < 0.0;
        of_body
            && match &self.region {
                Region::Solid { .. } => true,
                Region::Surface(core) => pair.b.outward(core).dot(self.placement.direction_to_b(difference)) > 0.0,
            }
    }
}
