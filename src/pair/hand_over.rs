//! The switch of a witness point to the next face of its body, after a step. The point stays where it is, so that the
//! distance does too.

use super::step::Foot;
use super::tool::unit;
use crate::body::{Body, Feature, Side};
use crate::math::Vec3;

/// A point of a seam is on both faces up to this, times the body's size: the tolerance of coincident borders.
const SEAM: f32 = 2.0e-6;
/// Times the size squared: a normal that is longer is not that of a pole.
const SHORT_NORMAL: f32 = 1.0e-3;

impl Foot {
    /// Hands over to the face that lets the point go on `towards` the other one, if its own does not. At most one
    /// evaluation.
    ///
    /// On a side the *conormals* are asked, the parts of the derivatives across that are normal to the edge: the
    /// derivatives themselves may point back along a skewed border. At a vertex a face lets the point go if one of its
    /// edges does, for their cone is convex: so the steepest edge decides for all faces.
    pub(super) fn hand_over(&mut self, body: &Body, towards: Vec3) -> bool {
        let Some(face) = body.faces().get(usize::from(self.face)) else { return false };
        let surface = &self.curved.surface;
        let [side_u, side_v] = [0, 1].map(|axis| side_at(self.parameters[axis]));
        let (number, is_corner) = match (side_u, side_v) {
            (None, None) => return false,
            (Some(upper), None) => (upper, false),
            (None, Some(upper)) => (2 + upper, false),
            (Some(upper), Some(_)) => (upper, true),
        };
        let inward = |axis: usize, upper: usize| {
            let tangent = if axis == 0 { surface.tangent_u } else { surface.tangent_v };
            if upper == 1 { -tangent } else { tangent }
        };
        let pole = |number: usize| match face.sides.get(number) {
            Some(Side::Pole { vertex }) => Some(*vertex),
            _ => None,
        };
        if is_corner || pole(number).is_some() {
            let lets_go = [side_u, side_v]
                .into_iter()
                .enumerate()
                .any(|(axis, side)| side.is_some_and(|upper| inward(axis, upper).dot(towards) > 0.0));
            if lets_go {
                return false;
            }
            let of_side = pole(number).or_else(|| side_v.and_then(|upper| pole(2 + upper)));
            let of_edge = || match face.sides.get(number) {
                Some(Side::Edge { edge, reversed, .. }) => body
                    .edges()
                    .get(usize::from(*edge))
                    .map(|edge| edge.ends[side_v.unwrap_or(0) ^ usize::from(*reversed)]),
                _ => None,
            };
            return of_side.or_else(of_edge).is_some_and(|vertex| self.leave_vertex(body, vertex, towards));
        }
        let Some(Side::Edge { edge: index, reversed, .. }) = face.sides.get(number) else { return false };
        let Some(edge) = body.edges().get(usize::from(*index)) else { return false };
        let along = self.parameters[usize::from(number < 2)];
        let is_out = conormal(self, number).dot(towards) < 0.0;
        let t = if *reversed { 1.0 - along } else { along };
        let of = edge.neighbour_of_side(Feature::Face(self.face), number);
        let Some((beyond, parameters)) = is_out.then(|| body.position_on_face(of, t)).flatten() else { return false };
        let next = Self::on(body, beyond, parameters);
        let lets_go = conormal(&next, usize::from(of.side)).dot(towards) > 0.0;
        lets_go && self.continue_as(next, body)
    }

    /// To a face of the steepest edge.
    fn leave_vertex(&mut self, body: &Body, vertex: u16, towards: Vec3) -> bool {
        let Some(vertex) = body.vertices().get(usize::from(vertex)) else { return false };
        let Some((_, spoke)) = body.steepest(vertex, towards) else { return false };
        let Some(edge) = body.edges().get(usize::from(spoke.edge)) else { return false };
        let t = if spoke.at_upper_end { 1.0 } else { 0.0 };
        let Some((face, parameters)) = edge.faces.iter().find_map(|of| body.position_on_face(*of, t)) else {
            return false;
        };
        self.continue_as(Self::on(body, face, parameters), body)
    }

    fn continue_as(&mut self, next: Self, body: &Body) -> bool {
        let seam = SEAM * body.size();
        let is_same_point = (next.point() - self.point()).length_squared() <= seam * seam;
        if is_same_point {
            *self = next;
        }
        is_same_point
    }

    /// The outward unit normal; at a pole, where the tangent around it is rounding, that of the pole's vertex.
    pub(super) fn unit_normal(&self, body: &Body) -> Vec3 {
        let (normal, size) = (self.normal(body), body.size());
        // That of a pole is far shorter.
        let shortest = SHORT_NORMAL * size * size;
        if normal.length_squared() > shortest * shortest {
            return unit(normal);
        }
        let pole = body.faces().get(usize::from(self.face)).and_then(|face| body.pole_at(face, self.parameters));
        match pole.and_then(|vertex| body.vertices().get(usize::from(vertex))) {
            Some(vertex) if vertex.outward != Vec3::ZERO => vertex.outward,
            _ => unit(normal),
        }
    }

    /// The sum of the outward unit normals of the faces that meet at the point: at a rest outside a convex body the
    /// other point is on this side of it, however sharp the edge. At a vertex the table has it.
    pub(super) fn outward(&self, body: &Body) -> Vec3 {
        let own = self.unit_normal(body);
        let Some(face) = body.faces().get(usize::from(self.face)) else { return own };
        let [side_u, side_v] = [0, 1].map(|axis| side_at(self.parameters[axis]));
        let number = match (side_u, side_v) {
            (None, None) => return own,
            (Some(upper), _) => upper,
            (None, Some(upper)) => 2 + upper,
        };
        match face.sides.get(number) {
            Some(Side::Edge { edge: index, reversed, .. }) => {
                let Some(edge) = body.edges().get(usize::from(*index)) else { return own };
                if let (Some(_), Some(upper)) = (side_u, side_v) {
                    let end = edge.ends[upper ^ usize::from(*reversed)];
                    let known = body.vertices().get(usize::from(end)).map_or(Vec3::ZERO, |vertex| vertex.outward);
                    return if known == Vec3::ZERO { own } else { known };
                }
                let along = self.parameters[usize::from(number < 2)];
                let t = if *reversed { 1.0 - along } else { along };
                let of = edge.neighbour_of_side(Feature::Face(self.face), number);
                let beyond = body.position_on_face(of, t).map(|(face, at)| Self::on(body, face, at));
                own + beyond.map_or(Vec3::ZERO, |beyond| beyond.unit_normal(body))
            }
            Some(Side::Pole { .. }) | None => own,
        }
    }
}

/// Which border a parameter is at: 0 the lower, 1 the upper.
fn side_at(parameter: f32) -> Option<usize> {
    if parameter <= 0.0 {
        Some(0)
    } else if parameter >= 1.0 {
        Some(1)
    } else {
        None
    }
}

/// The derivative into the face, without its part along the border.
fn conormal(foot: &Foot, number: usize) -> Vec3 {
    let surface = &foot.curved.surface;
    let (across, along) =
        if number < 2 { (surface.tangent_u, surface.tangent_v) } else { (surface.tangent_v, surface.tangent_u) };
    let across = if number & 1 == 1 { -across } else { across };
    let stretch = along.length_squared();
    if stretch > f32::MIN_POSITIVE { across - along * (across.dot(along) / stretch) } else { across }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::patch::{CurvedPoint, SecondDerivatives, SurfacePoint};

    /// On a skewed border the derivative across may lead in where the face does not: only the conormal tells.
    #[test]
    fn the_conormal_is_normal_to_the_border_and_leads_into_the_face() {
        // A flat face over the parallelogram of (2, 0) and (3, 1), to the left of (3, 1) along u = 0.
        let surface =
            SurfacePoint { point: Vec3::ZERO, tangent_u: vec3(2.0, 0.0, 0.0), tangent_v: vec3(3.0, 1.0, 0.0) };
        let foot =
            Foot { face: 0, parameters: [0.0; 2], curved: CurvedPoint { surface, second: SecondDerivatives::NONE } };
        // (2, 0) less its part 6/10 of (3, 1), and (3, 1) less its part along x.
        let [u, v] = [vec3(0.2, -0.6, 0.0), vec3(0.0, 1.0, 0.0)];
        for (number, expected) in [u, -u, v, -v].into_iter().enumerate() {
            assert!((conormal(&foot, number) - expected).length() < 1e-6, "side {number}");
        }
        // Along the border u = 0 and out of the face, though with the derivative across.
        let towards = surface.tangent_v - u;
        assert!(towards.dot(surface.tangent_u) > 0.0 && towards.dot(conormal(&foot, 0)) < 0.0);
    }
}
