//! The regions of a cell as places where descents may begin, in groups that lie together.

use super::faces::{Faces, Region};
use super::osculating::Osculating;
use super::rectangle::Rectangle;
use palpate::body::{Candidate, GRID};
use palpate::math::Vec3;
use std::ops::Range;

/// Starts of a group: those that came from one part of a face follow each other.
const TOGETHER: usize = 12;

/// All of them.
pub(super) struct Starts {
    starts: Vec<Start>,
    groups: Vec<Group>,
}

/// A region.
pub(super) struct Start {
    /// Its rectangle with a step of the grid around it, so that a descent may leave it for a neighbour's minimum.
    pub candidate: Candidate,
    near: Osculating,
}

/// Some of them in a ball, metres.
struct Group {
    centre: Vec3,
    radius: f32,
    starts: Range<usize>,
}

impl Starts {
    pub(super) fn new(faces: &Faces, regions: &[Region<'_>]) -> Self {
        let starts: Vec<_> = regions.iter().map(|region| Start::new(faces, region)).collect();
        let first = (0..starts.len()).step_by(TOGETHER);
        let groups = first.map(|first| Group::of(&starts, first..(first + TOGETHER).min(starts.len()))).collect();
        Self { starts, groups }
    }

    /// The distance of the one that is nearest to a probe, metres; `None` if none is nearer than `distance`.
    pub(super) fn nearest(&self, distance: f32, probe: Vec3) -> Option<f32> {
        let mut nearest = distance;
        for group in &self.groups {
            if group.is_within(nearest, probe) {
                for start in &self.starts[group.starts.clone()] {
                    if start.near.is_within(nearest, probe) {
                        nearest = nearest.min(start.near.distance(probe));
                    }
                }
            }
        }
        (nearest < distance).then_some(nearest)
    }

    /// Those nearer than a distance, with theirs, the nearest first.
    pub(super) fn nearer(&self, distance: f32, probe: Vec3) -> Vec<(f32, &Start)> {
        let groups = self.groups.iter().filter(|group| group.is_within(distance, probe));
        let starts = groups.flat_map(|group| &self.starts[group.starts.clone()]);
        let within = starts.filter(|start| start.near.is_within(distance, probe));
        let mut nearer: Vec<_> =
            within.map(|start| (start.near.distance(probe), start)).filter(|(to, _)| *to < distance).collect();
        nearer.sort_by(|a, b| a.0.total_cmp(&b.0));
        nearer
    }
}

impl Start {
    fn new(faces: &Faces, region: &Region<'_>) -> Self {
        let face = region.face(faces);
        let rectangle = region.rectangle(faces);
        let Rectangle { lower, upper } = Rectangle::around(rectangle);
        let candidate = Candidate {
            face,
            lower: lower.map(|step| step.saturating_sub(1)),
            upper: upper.map(|step| (step + 1).min(GRID as u8)),
            convex: false,
            more: false,
        };
        let surface = &faces.surfaces[usize::from(face)];
        let near = match region {
            Region::Inside(piece) => piece.near(surface),
            Region::Side { .. } | Region::Vertex(_) => Osculating::new(surface, rectangle),
        };
        Self { candidate, near }
    }
}

impl Group {
    fn of(all: &[Start], starts: Range<usize>) -> Self {
        let middles = || all[starts.clone()].iter().map(|start| start.near.middle);
        let centre = middles().sum::<Vec3>() / starts.len() as f32;
        let reach = all[starts.clone()].iter().map(|start| start.near.middle.distance(centre) + start.near.radius);
        Self { centre, radius: reach.fold(0.0, f32::max), starts }
    }

    /// Whether any of it may be nearer than a distance.
    fn is_within(&self, distance: f32, probe: Vec3) -> bool {
        let reach = distance + self.radius;
        reach > 0.0 && self.centre.distance_squared(probe) < reach * reach
    }
}
