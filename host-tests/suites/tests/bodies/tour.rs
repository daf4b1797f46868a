//! A way around a convex body that comes over each of its features.

use crate::scene::Scene;
use glam::{DQuat, DVec3};
use palpate::body::{EdgeFace, EdgeKind, Feature, Side};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::oracle::OraclePoint;

/// How far into a face a way across an edge begins, in its parameters.
const INSET: f64 = 0.1;

/// A place over the body: a point of its surface and a direction in which the probe is over it.
#[derive(Clone, Copy)]
struct Place {
    point: DVec3,
    direction: DVec3,
}

/// A polyline from one feature to the next until all were passed: faces at their middle, edges from one face across to
/// the other, vertices. Heights lie between 1 % and 11 % of the size, and the line has a vertex every hundredth of it
/// at least, far less than what it then cuts short.
pub fn tour(scene: &Scene) -> Vec<DVec3> {
    let oracle = scene.oracle();
    let size = scene.size();
    // Far out where every feature has room: the point over a place, and the way between two of them projected back.
    let far = |place: &Place| place.point + size * place.direction;
    let mut open: Vec<Vec<DVec3>> = legs(scene).iter().map(|leg| leg.iter().map(far).collect()).collect();
    let mut way = vec![open[0][0]];
    while !open.is_empty() {
        let here = way[way.len() - 1];
        let distance = |leg: &Vec<DVec3>| leg[0].distance(here);
        let next = (0..open.len()).min_by(|a, b| distance(&open[*a]).total_cmp(&distance(&open[*b])));
        way.extend(open.swap_remove(next.unwrap_or_default()));
    }
    let centre = 0.5 * (scene.low + scene.high);
    let mut line = Vec::new();
    for pair in way.windows(2) {
        let [from, to] = [pair[0] - centre, pair[1] - centre];
        // Around the body, not through it: turned about an axis, which any will do between opposite directions.
        let axis = from.cross(to).try_normalize().unwrap_or_else(|| from.any_orthonormal_vector());
        let angle = from.angle_between(to);
        let steps = (angle * from.length().max(to.length()) / (0.005 * size)).ceil().max(1.0) as u32;
        for step in 0..steps {
            let share = f64::from(step) / f64::from(steps);
            let length = from.length() * (1.0 - share) + to.length() * share;
            let out = DQuat::from_axis_angle(axis, angle * share) * from.normalize() * length;
            let height = size * (0.06 - 0.05 * (0.03 * line.len() as f64).cos());
            line.push(over(&oracle, centre + out, height));
        }
    }
    line
}

/// The point at a height over the closest point of a far one.
fn over(oracle: &BodyOracle<'_>, far: DVec3, height: f64) -> DVec3 {
    let foot = oracle.nearest(far, 0.0)[0].1.point;
    foot + (far - foot).normalize() * height
}

fn legs(scene: &Scene) -> Vec<Vec<Place>> {
    let body = &scene.body;
    let at = |face: u16, [u, v]: [f64; 2]| {
        let patch = &scene.patches[usize::from(face)];
        let surface = OraclePoint::evaluate(patch, u, v);
        Place { point: surface.point, direction: surface.normal(patch.flip) }
    };
    let mut legs: Vec<Vec<Place>> = (0..body.faces().len() as u16).map(|face| vec![at(face, [0.5; 2])]).collect();
    for edge in body.edges() {
        let [first, second] =
            edge.faces.map(|of| [inset(of, INSET), inset(of, 0.0)].map(|parameters| at(of.face, parameters)));
        let direction = (first[1].direction + second[1].direction).normalize();
        legs.push(vec![first[0], Place { point: first[1].point, direction }, second[0]]);
    }
    for vertex in body.vertices() {
        let point = vertex.point.as_dvec3();
        let corners = (0..body.faces().len() as u16).flat_map(|face| [0, 1, 2, 3].map(|corner| (face, corner)));
        let normals = corners.filter_map(|(face, corner)| {
            let parameters = [corner & 1, corner >> 1].map(f64::from);
            let near = at(face, parameters).point.distance(point) < 1e-6 * scene.size();
            near.then(|| at(face, parameters.map(|x| 1e-3 + x * (1.0 - 2e-3))).direction)
        });
        legs.push(vec![Place { point, direction: normals.sum::<DVec3>().normalize() }]);
    }
    legs
}

/// Parameters of a face at the middle of one of its sides, and so far in.
fn inset(of: EdgeFace, by: f64) -> [f64; 2] {
    match of.side {
        0 => [by, 0.5],
        1 => [1.0 - by, 0.5],
        2 => [0.5, by],
        _ => [0.5, 1.0 - by],
    }
}

/// Features that own a region outside, and pairs of faces that hand over directly across a smooth edge.
pub fn owning(scene: &Scene) -> (Vec<Feature>, Vec<[u16; 2]>) {
    let body = &scene.body;
    let is_smooth = |edge: u16| body.edges()[usize::from(edge)].kind == EdgeKind::Smooth;
    let faces = (0..body.faces().len() as u16).map(Feature::Face);
    let edges = (0..body.edges().len() as u16).filter(|edge| !is_smooth(*edge)).map(Feature::Edge);
    let vertices = (0..body.vertices().len()).filter(|vertex| {
        let vertex = body.vertices()[*vertex];
        let first = usize::from(vertex.first_spoke);
        body.spokes()[first..first + usize::from(vertex.spokes)].iter().any(|spoke| !is_smooth(spoke.edge))
    });
    let poles = body.faces().iter().flat_map(|face| &face.sides).any(|side| matches!(side, Side::Pole { .. }));
    assert!(!poles, "a pole is a vertex of its own kind");
    let features = faces.chain(edges).chain(vertices.map(|vertex| Feature::Vertex(vertex as u16))).collect();
    let smooth = body.edges().iter().filter(|edge| edge.kind == EdgeKind::Smooth);
    (features, smooth.map(|edge| edge.faces.map(|of| of.face)).collect())
}
