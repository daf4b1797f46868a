//! Newton's method on palpate's patches, from the last tick's point, with the safeguards of the oracle in double
//! precision (`host-tests/truth/src/oracle`): two steps a tick, and no guarantee.

use crate::Answer;
use palpate::body::{Body, Side};
use palpate::math::{Vec3, inverse_sqrt};
use palpate::patch::{CurvedPoint, Patch as _};

/// Halvings of a step that leads farther away.
const HALVINGS: usize = 4;
/// A step in neither parameter longer than this is none.
const SETTLED: f32 = 1e-6;

/// The point of the last tick.
#[derive(Clone, Copy, Debug)]
pub struct Newton<'a> {
    body: &'a Body<'a>,
    face: u16,
    at: [f32; 2],
    point: CurvedPoint,
}

impl<'a> Newton<'a> {
    /// At the closest point of a probe.
    pub fn start(body: &'a Body<'a>, probe: Vec3) -> Self {
        let found = body.locate(probe);
        let [u, v] = found.parameters;
        // There is a face, but the compiler does not know that.
        let face = body.faces().get(usize::from(found.face)).unwrap_or(&palpate::body::Face::VACANT);
        Self { body, face: found.face, at: found.parameters, point: face.patch.evaluate_curved(u, v) }
    }

    /// Two steps, the second on the neighbour if the probe is beyond the border that the first ended at.
    pub fn tick(&mut self, probe: Vec3) -> Answer {
        let moved = self.step(probe);
        if !self.cross(probe) && moved {
            self.step(probe);
        }
        self.answer(probe)
    }

    /// One step on the face, halved until it leads nearer; false if there is none.
    fn step(&mut self, probe: Vec3) -> bool {
        let Some(face) = self.body.faces().get(usize::from(self.face)) else { return false };
        let from = self.point.surface.point - probe;
        let [step_u, step_v] = direction(&self.point, from, self.at);
        if step_u.abs().max(step_v.abs()) <= SETTLED {
            return false;
        }
        let before = from.length_squared();
        let mut length = 1.0;
        for _ in 0..=HALVINGS {
            let at = [(self.at[0] + length * step_u).clamp(0.0, 1.0), (self.at[1] + length * step_v).clamp(0.0, 1.0)];
            if at == self.at {
                return false;
            }
            let point = face.patch.evaluate_curved(at[0], at[1]);
            if (point.surface.point - probe).length_squared() < before {
                (self.at, self.point) = (at, point);
                return true;
            }
            length *= 0.5;
        }
        false
    }

    /// At a border that the probe is beyond: one step on the neighbour, kept if it leads nearer. False elsewhere.
    fn cross(&mut self, probe: Vec3) -> bool {
        let from = self.point.surface.point - probe;
        let slope = [from.dot(self.point.surface.tangent_u), from.dot(self.point.surface.tangent_v)];
        let mut pressed = None;
        for (number, (axis, is_upper)) in [(0, false), (0, true), (1, false), (1, true)].into_iter().enumerate() {
            let is_there = self.at[axis] == f32::from(u8::from(is_upper));
            let push = if is_upper { -slope[axis] } else { slope[axis] };
            if is_there && push > 0.0 && pressed.is_none_or(|(_, most)| push > most) {
                pressed = Some((number, push));
            }
        }
        let Some((number, _)) = pressed else { return false };
        if let Some(mut there) = self.beyond(number)
            && there.step(probe)
            && (there.point.surface.point - probe).length_squared() < from.length_squared()
        {
            *self = there;
        }
        true
    }

    /// The same point on the neighbour over a border.
    #[inline(never)]
    fn beyond(&self, number: usize) -> Option<Self> {
        let (faces, edges) = (self.body.faces(), self.body.edges());
        let side = |face: u16, number: usize| match faces.get(usize::from(face))?.sides.get(number)? {
            Side::Edge { edge, reversed, .. } => Some((*edge, *reversed)),
            Side::Pole { .. } => None,
        };
        let (edge, reversed) = side(self.face, number)?;
        let [one, other] = edges.get(usize::from(edge))?.faces;
        let next = if one.face == self.face && usize::from(one.side) == number { other } else { one };
        let patch = &faces.get(usize::from(next.face))?.patch;
        let (_, turns) = side(next.face, next.side.into())?;
        let along = self.at[1 - number / 2];
        let along = if reversed == turns { along } else { 1.0 - along };
        let border = f32::from(next.side & 1);
        let at = if next.side < 2 { [border, along] } else { [along, border] };
        Some(Self { face: next.face, at, point: patch.evaluate_curved(at[0], at[1]), ..*self })
    }

    fn answer(&self, probe: Vec3) -> Answer {
        let surface = &self.point.surface;
        let away = probe - surface.point;
        let face = self.body.faces().get(usize::from(self.face));
        let across = surface.tangent_u.cross(surface.tangent_v);
        let across = if face.is_some_and(|face| face.patch.orientation() < 0.0) { -across } else { across };
        let squared = away.length_squared();
        let is_inner = self.at.iter().all(|parameter| *parameter > 0.0 && *parameter < 1.0);
        if is_inner || squared <= f32::MIN_POSITIVE {
            let normal = across * inverse_sqrt(across.length_squared());
            return Answer { gap_m: away.dot(normal), normal, point: surface.point };
        }
        let inverse = inverse_sqrt(squared) * if away.dot(across) < 0.0 { -1.0 } else { 1.0 };
        Answer { gap_m: squared * inverse, normal: away * inverse, point: surface.point }
    }
}

/// The Newton direction in the parameters that are free, Gauss and Newton's where the distance is not convex.
#[inline(always)]
fn direction(point: &CurvedPoint, from: Vec3, at: [f32; 2]) -> [f32; 2] {
    let (f_u, f_v) = (point.surface.tangent_u, point.surface.tangent_v);
    let gradient = [from.dot(f_u), from.dot(f_v)];
    let held = [0, 1].map(|i| (at[i] <= 0.0 && gradient[i] > 0.0) || (at[i] >= 1.0 && gradient[i] < 0.0));
    let form = [f_u.dot(f_u), f_u.dot(f_v), f_v.dot(f_v)];
    let second =
        [2.0 * from.dot(point.second.half_uu), from.dot(point.second.uv), 2.0 * from.dot(point.second.half_vv)];
    let hessian = [form[0] + second[0], form[1] + second[1], form[2] + second[2]];
    let alone = |i: usize| -gradient[i] / if hessian[2 * i] > 0.0 { hessian[2 * i] } else { form[2 * i] };
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            let [a, b, c] =
                if hessian[0] > 0.0 && hessian[0] * hessian[2] > hessian[1] * hessian[1] { hessian } else { form };
            let inverse = 1.0 / (a * c - b * b);
            [(b * gradient[1] - c * gradient[0]) * inverse, (b * gradient[0] - a * gradient[1]) * inverse]
        }
    }
}
