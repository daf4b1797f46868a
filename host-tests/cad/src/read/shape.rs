//! A shell's faces as NURBS: surfaces, chained loops, edges shared by their keys.

use super::offset;
use super::statements::Numbers;
use crate::error::{HEAL, ImportError};
use crate::nurbs::{Curve, MAX_DEGREE, Surface};
use crate::part::{self, Edge, Face, Part, Sweep, Use};
use glam::{DAffine3, DVec2, DVec3};
use std::collections::HashMap;
use step_io::scene::{self, NurbsCurve, NurbsSurface, Shell, SurfaceKind};
use step_io::{EntityKey, Orientation};

/// Of the tolerance, what the pieces of an offset surface may use up.
const SHARE_OF_OFFSETS: f64 = 0.02;

/// Faces on their way into a part.
pub(super) struct Gather<'p> {
    part: &'p mut Part,
    scale: f64,
    placement: DAffine3,
    edges: HashMap<EntityKey, usize>,
    vertices: HashMap<EntityKey, usize>,
    names: HashMap<String, usize>,
    numbers: &'p Numbers,
    /// How far an edge may lie off its face or its vertex, millimetres.
    tolerance: f64,
}

impl<'p> Gather<'p> {
    pub(super) fn new(part: &'p mut Part, scale: f64, numbers: &'p Numbers, tolerance: f64) -> Self {
        let (edges, vertices, names) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { part, scale, placement: DAffine3::IDENTITY, edges, vertices, names, numbers, tolerance }
    }

    /// Another solid: nothing of it is shared with those before.
    pub(super) fn begin(&mut self, name: &str, is_closed: bool, placement: DAffine3) {
        self.part.solids.push(part::Solid { name: name.to_owned(), is_closed });
        self.placement = placement;
        self.edges.clear();
        self.vertices.clear();
    }

    /// A shell, whose faces' normals point the other way if it is turned; of a solid the outer one or a void.
    pub(super) fn shell(&mut self, shell: &Shell<'_>, turned: bool, is_void: bool) -> Result<(), ImportError> {
        for face in shell.faces() {
            self.face(&face, turned, is_void)?;
        }
        Ok(())
    }

    fn face(&mut self, face: &scene::Face<'_>, turned: bool, is_void: bool) -> Result<(), ImportError> {
        let name = self.unique(face.name());
        let mut kind = kind(&face.surface().kind());
        let number = self.numbers.of(face.key()).map(|(number, _)| number);
        let label = part::label(&name, number);
        let cannot = |reason: String| ImportError::face(&label, reason);
        let surface =
            face.to_nurbs().ok_or_else(|| cannot(format!("its surface ({kind}) is of a kind that is not read")))?;
        let mut surface = self.surface(&surface).map_err(cannot)?;
        if let Some(distance) = number.and_then(|number| self.numbers.offsets.get(&number)) {
            kind = "offset";
            (0..2).for_each(|axis| surface.gather_poles(axis));
            let fitted = offset::offset(&surface, distance * self.scale, SHARE_OF_OFFSETS * self.tolerance);
            surface = fitted.ok_or_else(|| {
                cannot("its surface, an offset, is not met by cubic pieces; export the part with B-splines".to_owned())
            })?;
            surface.find_ends(self.near().max(SHARE_OF_OFFSETS * self.tolerance));
            (0..2).for_each(|axis| surface.gather_poles(axis));
        }
        let against = face.orientation() == Orientation::Reversed;
        let mut loops = Vec::new();
        for bound in face.bounds() {
            let mut uses = Vec::new();
            for (edge, orientation) in bound.oriented_edges() {
                let edge = self.edge(&edge).map_err(cannot)?;
                uses.push(Use { edge, reversed: orientation == Orientation::Reversed });
            }
            if uses.is_empty() {
                if bound.vertex().is_none() {
                    return Err(cannot("a loop of it has no edges".to_owned()));
                }
                continue;
            }
            // Seen from the surface's own normal, the face on the left.
            if (bound.orientation() == Orientation::Reversed) != against {
                uses.reverse();
                uses.iter_mut().for_each(|used| used.reversed = !used.reversed);
            }
            loops.push(uses);
        }
        let parts = surface.parts_between_points(self.near());
        if !parts.is_empty() {
            surface = self.part_of_edges(parts, &loops, against != turned, is_void).ok_or_else(|| {
                let reason =
                    "its surface goes through one point, and the face lies on both sides of it: split it there";
                cannot(reason.to_owned())
            })?;
        }
        self.part.faces.push(Face {
            name,
            number,
            solid: self.part.solids.len() - 1,
            kind,
            surface,
            flip: against != turned,
            loops,
            is_healed: false,
        });
        Ok(())
    }

    /// Distance below which two points of a surface are one, millimetres.
    fn near(&self) -> f64 {
        self.part.precision.min(0.1 * self.tolerance).max(1e-6)
    }

    /// The part of a surface that holds all edges of a face. A sphere that is swept twice, on either side of its axis,
    /// has two such parts, with normals against each other: an edge at the start of the sweep decides, which lies at the
    /// start of the parameter; of half a turn, which has an edge there in both, the outline. As a part of the surface may
    /// have an edge there by chance, the importer tries the others of [`Sweep`] next.
    fn part_of_edges(&mut self, parts: Vec<Surface>, loops: &[Vec<Use>], flip: bool, is_void: bool) -> Option<Surface> {
        let edges: Vec<&Edge> = loops.iter().flatten().map(|used| &self.part.edges[used.edge]).collect();
        let holds = |part: &Surface| {
            let points = edges.iter().flat_map(|edge| [0.0, 0.3, 0.5, 0.7, 1.0].map(|share| edge.at(share)[0]));
            points.into_iter().all(|point| part.locate(point).distance <= self.tolerance)
        };
        let starts_sweep = |part: &Surface| {
            let axis = usize::from(!part.closed[0]);
            let [low, high] = part.range(axis);
            let share = |edge: &Edge, at: f64| (part.locate(edge.at(at)[0]).uv[axis] - low) / (high - low);
            let is_at_start = |share: f64| (share - share.round()).abs() < 1e-6;
            edges.iter().any(|edge| [0.3, 0.7].iter().all(|at| is_at_start(share(edge, *at))))
        };
        // The outline has the face on its left, which its middle is of a quarter of a sphere.
        let is_on_the_left = |part: &Surface| {
            let uses = || loops.iter().flatten().flat_map(|used| [0.1, 0.3, 0.5, 0.7, 0.9].map(|share| (used, share)));
            let points = uses().map(|(used, share)| self.part.edges[used.edge].at(share)[0]);
            let middle = points.clone().sum::<DVec3>() / points.count().max(1) as f64;
            let sides = uses().map(|(used, share)| {
                let [at, along] = self.part.edges[used.edge].at(share);
                let along = if used.reversed { -along } else { along };
                part.normal(part.locate(at).uv).cross(along).dot(middle - at)
            });
            sides.sum::<f64>() > 0.0
        };
        let mut fitting: Vec<Surface> = parts.into_iter().filter(holds).collect();
        // Six times what lies behind the part.
        let volume = |part: &Surface| {
            const STEPS: u32 = 24;
            let centre = part.at(DVec2::new(part.range(0)[0], part.range(1)[0])).point;
            let at =
                |k: u32, axis: usize| part.range(axis)[0] + part.period(axis) * (f64::from(k) + 0.5) / f64::from(STEPS);
            let all = (0..STEPS * STEPS).map(|k| part.at(DVec2::new(at(k % STEPS, 0), at(k / STEPS, 1))));
            all.map(|jet| (jet.point - centre).dot(jet.cross())).sum::<f64>()
        };
        self.part.is_swept_twice |= fitting.len() > 1 && !loops.is_empty();
        let starting: Vec<usize> = (0..fitting.len()).filter(|index| starts_sweep(&fitting[*index])).collect();
        let on_the_left = || starting.iter().copied().find(|index| is_on_the_left(&fitting[*index]));
        let bulges = |outward: bool| fitting.iter().position(|part| (volume(part) < 0.0) == (flip == outward));
        let first = match self.part.sweep {
            // The material lies behind the face: around a void, beyond it.
            _ if edges.is_empty() || fitting.len() < 2 => bulges(!is_void).filter(|_| edges.is_empty()),
            Sweep::Start if starting.len() > 1 => on_the_left(),
            Sweep::Start => starting.first().copied(),
            Sweep::Outline => fitting.iter().position(is_on_the_left),
            Sweep::Outward => bulges(true),
            Sweep::Inward => bulges(false),
        };
        let first = first.unwrap_or(0);
        if first >= fitting.len() {
            return None;
        }
        Some(fitting.swap_remove(first))
    }

    fn unique(&mut self, own: &str) -> String {
        let number = self.part.faces.len() + 1;
        let base = if own.is_empty() || own == "NONE" { format!("face {number}") } else { own.to_owned() };
        let count = self.names.entry(base.clone()).or_insert(0);
        *count += 1;
        if *count == 1 { base } else { format!("{base} ({number})") }
    }

    fn placed(&self, point: [f64; 3]) -> DVec3 {
        self.placement.transform_point3(DVec3::from_array(point)) * self.scale
    }

    fn vertex(&mut self, vertex: Option<scene::Vertex<'_>>) -> Result<usize, String> {
        let vertex = vertex.ok_or("an edge has no vertex at an end")?;
        if let Some(index) = self.vertices.get(&vertex.key()) {
            return Ok(*index);
        }
        let point = self.placed(vertex.point().ok_or("a vertex has no point")?.xyz());
        if !point.is_finite() {
            return Err("a vertex is at no finite place".to_owned());
        }
        let index = self.part.vertices.len();
        self.part.vertices.push(point);
        self.vertices.insert(vertex.key(), index);
        Ok(index)
    }

    fn edge(&mut self, edge: &scene::Edge<'_>) -> Result<usize, String> {
        if let Some(index) = self.edges.get(&edge.key()) {
            return Ok(*index);
        }
        let ends = [self.vertex(edge.start())?, self.vertex(edge.end())?];
        let number = self.numbers.of(edge.key()).map(|(number, _)| number);
        let label = part::label_of_edge(self.part.edges.len(), number);
        let curve = edge.to_nurbs().ok_or_else(|| format!("its {label} has a curve of a kind that is not read"))?;
        let mut curve = self.curve(&curve).map_err(|reason| format!("its {label}: {reason}"))?;
        let [low, high] = curve.range();
        let [start, end] = [low, high].map(|t| curve.at(t)[0]);
        let points = ends.map(|index| self.part.vertices[index]);
        let near = self.part.precision.max(self.tolerance);
        // Two vertices in one place: a closed edge.
        let is_round = ends[0] == ends[1] || points[0].distance(points[1]) <= 1e-7 && start.distance(end) <= near;
        if is_round {
            if !edge.same_sense() {
                curve = reversed(curve);
            }
        } else {
            let gap = start.distance(points[0]).max(end.distance(points[1]));
            if gap > near {
                return Err(format!("its {label} ends {gap:.6} mm from its vertex; {HEAL}"));
            }
        }
        let index = self.part.edges.len();
        let mut edge_of = Edge { is_round, ..Edge::whole(curve, ends, number) };
        if is_round && start.distance(points[0]) > near {
            // It begins where its vertex is, and goes round once.
            let (share, gap) = edge_of.nearest(points[0]);
            if gap > near {
                return Err(format!("its {label} passes {gap:.6} mm from its vertex; {HEAL}"));
            }
            edge_of.range = [0.0, 1.0].map(|turn| low + (high - low) * (share.rem_euclid(1.0) + turn));
        }
        self.part.edges.push(edge_of);
        self.edges.insert(edge.key(), index);
        Ok(index)
    }

    fn curve(&self, curve: &NurbsCurve) -> Result<Curve, String> {
        check_knots(&curve.knots, curve.degree, curve.control_points.len())?;
        let weigh = |(point, weight): (&[f64; 3], &f64)| self.placed(*point).extend(1.0) * *weight;
        let points: Vec<_> = curve.control_points.iter().zip(&curve.weights).map(weigh).collect();
        if points.iter().any(|point| !point.is_finite() || point.w <= 0.0) {
            return Err("a control point or weight is not a usable number".to_owned());
        }
        Ok(Curve { degree: curve.degree, knots: curve.knots.clone(), points })
    }

    fn surface(&self, surface: &NurbsSurface) -> Result<Surface, String> {
        let counts = [surface.control_points.len(), surface.control_points.first().map_or(0, Vec::len)];
        let degree = [surface.degree_u, surface.degree_v];
        let knots = [surface.knots_u.clone(), surface.knots_v.clone()];
        for axis in 0..2 {
            check_knots(&knots[axis], degree[axis], counts[axis])?;
        }
        let rows = surface.control_points.iter().zip(&surface.weights);
        let weigh = |(point, weight): (&[f64; 3], &f64)| self.placed(*point).extend(1.0) * *weight;
        let points: Vec<_> = rows.flat_map(|(points, weights)| points.iter().zip(weights).map(weigh)).collect();
        if points.len() != counts[0] * counts[1] || points.iter().any(|point| !point.is_finite() || point.w <= 0.0) {
            return Err("a control point or weight of its surface is not a usable number".to_owned());
        }
        let mut surface =
            Surface { degree, knots, counts, points, closed: [false; 2], touching: [false; 2], poles: [[false; 2]; 2] };
        surface.find_ends(self.near());
        Ok(surface)
    }
}

fn check_knots(knots: &[f64], degree: usize, count: usize) -> Result<(), String> {
    let fits = (1..=MAX_DEGREE).contains(&degree) && count > degree && knots.len() == count + degree + 1;
    let rises = knots.windows(2).all(|pair| pair[0] <= pair[1]) && knots.iter().all(|knot| knot.is_finite());
    if fits && rises && knots[degree] < knots[count] {
        Ok(())
    } else {
        Err("its knots do not fit its points".to_owned())
    }
}

fn reversed(mut curve: Curve) -> Curve {
    curve.points.reverse();
    let sum = curve.knots[0] + curve.knots[curve.knots.len() - 1];
    curve.knots = curve.knots.iter().rev().map(|knot| sum - knot).collect();
    curve
}

fn kind(kind: &SurfaceKind<'_>) -> &'static str {
    match kind {
        SurfaceKind::Plane(_) => "plane",
        SurfaceKind::Cylindrical(_) => "cylinder",
        SurfaceKind::Conical(_) => "cone",
        SurfaceKind::Spherical(_) => "sphere",
        SurfaceKind::Toroidal(_) | SurfaceKind::DegenerateToroidal(_) => "torus",
        SurfaceKind::Offset(_) => "offset",
        SurfaceKind::LinearExtrusion(_) => "extrusion",
        SurfaceKind::Revolution(_) => "revolution",
        SurfaceKind::BSpline(_)
        | SurfaceKind::BSplineWithKnots(_)
        | SurfaceKind::QuasiUniform(_)
        | SurfaceKind::Uniform(_)
        | SurfaceKind::Bezier(_) => "b-spline",
        // The form that a rational one has in a file.
        SurfaceKind::Other("COMPLEX") => "rational b-spline",
        SurfaceKind::Other(keyword) => keyword,
        _ => "surface",
    }
}
