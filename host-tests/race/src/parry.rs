//! `parry3d`: the patch as a triangle mesh with a bounding volume hierarchy, and as the convex hull of samples.

use crate::contestant::{Answer, Contestant};
use crate::horner::Biquadratic;
use crate::scene::{Probe, Scene};
use anyhow::Context as _;
use parry3d::math::Vector;
use parry3d::query::PointQuery;
use parry3d::shape::{ConvexPolyhedron, TriMesh};

/// Two triangles in each of 256 × 256 cells: the mesh whose worst error is like palpate's.
pub fn mesh_256(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    mesh(scene, 256)
}

/// Two triangles in each of 128 × 128 cells.
pub fn mesh_128(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    mesh(scene, 128)
}

/// Two triangles in each of 32 × 32 cells.
pub fn mesh_32(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    mesh(scene, 32)
}

/// The convex hull of 33 × 33 samples: it fills hollows and closes the open side.
pub fn hull(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    let hull = ConvexPolyhedron::from_convex_hull(&samples(scene, 32)).context("the samples have no convex hull")?;
    Ok(Box::new(Shape(hull)))
}

fn mesh(scene: &Scene, cells: usize) -> anyhow::Result<Box<dyn Contestant>> {
    let index = |row: usize, column: usize| (row * (cells + 1) + column) as u32;
    let corners = (0..cells * cells).map(|cell| (cell / cells, cell % cells));
    let triangles = corners.flat_map(|(row, column)| {
        let diagonal = [index(row, column), index(row + 1, column + 1)];
        [[diagonal[0], index(row + 1, column), diagonal[1]], [diagonal[0], diagonal[1], index(row, column + 1)]]
    });
    Ok(Box::new(Shape(TriMesh::new(samples(scene, cells), triangles.collect())?)))
}

/// Points of the patch, row by row along `u`.
fn samples(scene: &Scene, cells: usize) -> Vec<Vector> {
    let patch = Biquadratic::new(scene);
    let at = |index: usize| index as f32 / cells as f32;
    let point = |index: usize| patch.point([at(index / (cells + 1)), at(index % (cells + 1))]);
    (0..(cells + 1) * (cells + 1)).map(point).map(|point| Vector::new(point.x, point.y, point.z)).collect()
}

struct Shape<S>(S);

impl<S: PointQuery> Contestant for Shape<S> {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let [x, y, z] = probe.single;
        let projected = self.0.project_local_point(Vector::new(x, y, z), false).point;
        Answer::Point([projected.x, projected.y, projected.z].map(f64::from))
    }
}
