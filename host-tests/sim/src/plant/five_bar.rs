//! The simulated five-bar, flat on a table or upright on a turntable.
//!
//! Written with the rods' own turning rates: `Ċ = Ȧ + ω₁ p⊥ = Ḃ + ω₂ q⊥`, so `ω₁ = (Ḃ − Ȧ)·q / (p⊥·q)`.

use super::lumped::{Geometry, Point, Points};
use super::vector::Vector;

type Pair = [f64; 2];

/// A link as a mass at its centre and an inertia about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkLump {
    /// Mass, kg.
    pub mass: f64,
    /// The centre, m along the link from its first hinge.
    pub along: f64,
    /// The centre, m to the left of that.
    pub across: f64,
    /// Inertia about the centre, kg·m².
    pub inertia: f64,
}

impl LinkLump {
    /// A uniform thin rod.
    pub const fn rod(mass: f64, length: f64) -> Self {
        Self { mass, along: 0.5 * length, across: 0.0, inertia: mass * length * length / 12.0 }
    }
}

/// Two cranks, two rods and a probe on the first rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBarSettings {
    /// The second crank's pivot on the x axis, m; the first is at the origin.
    pub second_pivot: f64,
    /// Lengths of the cranks, m.
    pub cranks: Pair,
    /// Lengths of the rods, m.
    pub rods: Pair,
    /// The probe on the first rod, m from its elbow towards the hinge.
    pub tool: f64,
    /// 1 if the hinge lies left of the line from the first elbow to the second, −1 if right.
    pub side: f64,
    /// Which way each crank is bent off the line from its pivot to what it holds: 1 counter-clockwise, −1 clockwise.
    pub bends: Pair,
    /// Origin of probe positions, m from the first pivot.
    pub workspace_centre: Pair,
    /// First crank, second crank, first rod (towards the probe), second rod.
    pub links: [LinkLump; 4],
    /// Mass on the probe, kg.
    pub tool_mass: f64,
}

/// A point of the plane with its motion per radian of each crank.
#[derive(Clone, Copy, Debug, Default)]
struct Flat {
    inertia: f64,
    weight: f64,
    place: Pair,
    motion: [Pair; 2],
}

fn left([x, y]: Pair) -> Pair {
    [-y, x]
}

fn plus(a: Pair, b: Pair, factor: f64) -> Pair {
    [a[0] + b[0] * factor, a[1] + b[1] * factor]
}

fn inner(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A link from a hinge: its direction, and how it turns per radian of each crank.
fn lump(link: &LinkLump, start: Pair, start_motion: [Pair; 2], [x, y]: Pair, turns: Pair) -> Flat {
    let length = x.hypot(y);
    let forward = [x / length, y / length];
    let offset = plus([forward[0] * link.along, forward[1] * link.along], left(forward), link.across);
    let motion = [0, 1].map(|crank| plus(start_motion[crank], left(offset), turns[crank]));
    Flat { inertia: link.mass, weight: link.mass, place: plus(start, offset, 1.0), motion }
}

/// A link's turning as a point of its own.
fn spin(link: &LinkLump, turns: Pair) -> Flat {
    Flat { inertia: link.inertia, weight: 0.0, place: [0.0; 2], motion: [[turns[0], 0.0], [turns[1], 0.0]] }
}

impl FiveBarSettings {
    /// Probe, four links' centres, the turning of the two rods and of the two cranks together.
    fn flat(&self, first: f64, second: f64) -> [Flat; 8] {
        let crank = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
        let (arm_a, arm_b) = (crank(self.cranks[0], first), crank(self.cranks[1], second));
        let a = arm_a;
        let pivot_b = [self.second_pivot, 0.0];
        let b = plus(arm_b, pivot_b, 1.0);
        // The hinge by the angle at the first elbow.
        let span = plus(b, a, -1.0);
        let distance = span[0].hypot(span[1]);
        let cosine =
            (self.rods[0].powi(2) + distance * distance - self.rods[1].powi(2)) / (2.0 * self.rods[0] * distance);
        let angle = span[1].atan2(span[0]) + self.side * cosine.acos();
        let c = plus(a, [angle.cos(), angle.sin()], self.rods[0]);

        let (p, q) = (plus(c, a, -1.0), plus(c, b, -1.0));
        let none = [0.0; 2];
        let (motion_a, motion_b) = ([left(arm_a), none], [none, left(arm_b)]);
        let turns = |p: Pair, q: Pair, sign: f64| {
            [0, 1].map(|crank| sign * inner(plus(motion_b[crank], motion_a[crank], -1.0), q) / inner(left(p), q))
        };
        let (turns_a, turns_b) = (turns(p, q, 1.0), turns(q, p, -1.0));
        let along = [p[0] / self.rods[0], p[1] / self.rods[0]];
        let tool_offset = [along[0] * self.tool, along[1] * self.tool];
        let tool = Flat {
            inertia: self.tool_mass,
            weight: self.tool_mass,
            place: plus(a, tool_offset, 1.0),
            motion: [0, 1].map(|crank| plus(motion_a[crank], left(tool_offset), turns_a[crank])),
        };
        let [crank_a, crank_b, rod_a, rod_b] = &self.links;
        // The cranks' turning does not couple: one entry each would do, but they share a point's two rows.
        let mut cranks = Flat { inertia: 1.0, ..Flat::default() };
        cranks.motion = [[crank_a.inertia.sqrt(), 0.0], [0.0, crank_b.inertia.sqrt()]];
        [
            tool,
            lump(crank_a, none, [none; 2], arm_a, [1.0, 0.0]),
            lump(crank_b, pivot_b, [none; 2], arm_b, [0.0, 1.0]),
            lump(rod_a, a, motion_a, tool_offset, turns_a),
            lump(rod_b, b, motion_b, q, turns_b),
            spin(rod_a, turns_a),
            spin(rod_b, turns_b),
            cranks,
        ]
    }

    /// The cranks that put the probe at a place of the plane, m from the first pivot.
    fn cranks_at(&self, place: Pair) -> Option<Pair> {
        let bent = |pivot: Pair, goal: Pair, crank: f64, rod: f64, bend: f64| {
            let to = plus(goal, pivot, -1.0);
            let distance = to[0].hypot(to[1]);
            let cosine = (crank * crank + distance * distance - rod * rod) / (2.0 * crank * distance);
            (-1.0..=1.0).contains(&cosine).then(|| to[1].atan2(to[0]) + bend * cosine.acos())
        };
        let first = bent([0.0; 2], place, self.cranks[0], self.tool.abs(), self.bends[0])?;
        let elbow = [self.cranks[0] * first.cos(), self.cranks[0] * first.sin()];
        let hinge = plus(elbow, plus(place, elbow, -1.0), self.rods[0] / self.tool);
        let second = bent([self.second_pivot, 0.0], hinge, self.cranks[1], self.rods[1], self.bends[1])?;
        Some([first, second])
    }
}

impl Geometry for FiveBarSettings {
    fn joints(&self) -> usize {
        2
    }

    fn points(&self, [first, second, _]: Vector) -> Points {
        let mut points = self.flat(first, second).map(|flat| Point {
            inertia: flat.inertia,
            weight: flat.weight,
            place: [flat.place[0], flat.place[1], 0.0],
            jacobian: [
                [flat.motion[0][0], flat.motion[1][0], 0.0],
                [flat.motion[0][1], flat.motion[1][1], 0.0],
                [0.0; 3],
            ],
        });
        for (entry, centre) in points[0].place.iter_mut().zip(self.workspace_centre) {
            *entry -= centre;
        }
        points
    }

    fn angles(&self, [x, y, _]: Vector) -> Option<Vector> {
        let [first, second] = self.cranks_at(plus([x, y], self.workspace_centre, 1.0))?;
        Some([first, second, 0.0])
    }
}

/// A turntable that carries an upright five-bar. The links' turning about the vertical is that of their centres alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkageArmSettings {
    /// The linkage in the upright plane; its workspace centre is not used.
    pub linkage: FiveBarSettings,
    /// From the turntable's axis to the first pivot, m.
    pub pivot_reach: f64,
    /// Origin of probe positions, m from the axis at the pivots' height.
    pub workspace_centre: Vector,
    /// Inertia of the turntable with all it carries but the links, kg·m².
    pub turntable_inertia: f64,
}

impl Geometry for LinkageArmSettings {
    fn joints(&self) -> usize {
        3
    }

    fn points(&self, [a, b, c]: Vector) -> Points {
        let (sine, cosine) = a.sin_cos();
        let mut points = Points::default();
        for (index, (point, flat)) in points.iter_mut().zip(self.linkage.flat(b, c)).enumerate() {
            let [along, up] = flat.place;
            let [first, second] = flat.motion;
            // The last three are angles, which do not turn with the table.
            let turning = index >= 5;
            let reach = if turning { 0.0 } else { self.pivot_reach + along };
            let (cosine, sine) = if turning { (1.0, 0.0) } else { (cosine, sine) };
            *point = Point {
                inertia: flat.inertia,
                weight: flat.weight,
                place: [reach * cosine, reach * sine, up],
                jacobian: [
                    [-reach * sine, first[0] * cosine, second[0] * cosine],
                    [reach * cosine, first[0] * sine, second[0] * sine],
                    [0.0, first[1], second[1]],
                ],
            };
        }
        for (entry, centre) in points[0].place.iter_mut().zip(self.workspace_centre) {
            *entry -= centre;
        }
        points
    }

    fn angles(&self, position: Vector) -> Option<Vector> {
        let [x, y, z]: Vector = core::array::from_fn(|i| position[i] + self.workspace_centre[i]);
        let [first, second] = self.linkage.cranks_at([x.hypot(y) - self.pivot_reach, z])?;
        Some([y.atan2(x), first, second])
    }
}
