//! Ways to spoil the tables of a body: the constructor refuses what cannot be followed, and the CRC finds every flipped
//! bit.

use palpate::body::{Body, BodyError, EdgeFace, EdgeKind, TableCursor};
use palpate::math::Vec3;
use palpate::patch::crc32;
use palpate::patch::{Orientation, TableError};
use palpate_bake::body::{BakedBody, BakedCurve, BakedSeparator, BakedSide, TableFault};
use palpate_bake::{BakedCoefficients, BakedPatch};
use palpate_suites::body;
use std::error::Error;
use std::sync::LazyLock;

static BOX: LazyLock<BakedBody> = LazyLock::new(|| body("capped_box"));
/// Rational, with poles.
static POLES: LazyLock<BakedBody> = LazyLock::new(|| body("ellipsoid_poles"));

fn separator(body: &mut BakedBody, face: usize, side: usize) -> &mut BakedSeparator {
    match &mut body.faces[face].sides[side] {
        BakedSide::Edge { separator, .. } => separator,
        BakedSide::Pole { .. } => panic!("a pole"),
    }
}

fn ruled(body: &mut BakedBody, face: usize, side: usize) -> &mut BakedCurve {
    match separator(body, face, side) {
        BakedSeparator::Ruled(curve) => curve,
        BakedSeparator::Plane { .. } => panic!("a plane"),
    }
}

type Spoil = fn(&mut BakedBody);

/// What is done to the capped box (its face 0 is the dome, edge 0 on its side `u = 0`), and what the library says.
const SPOILED: &[(&str, Spoil, BodyError)] = &[
    ("no face", |body| body.faces.clear(), BodyError::Faces),
    ("too many faces", |body| body.faces = vec![body.faces[0].clone(); 1025], BodyError::Faces),
    ("no size", |body| body.size = 0.0, BodyError::Size),
    ("size NaN", |body| body.size = f32::NAN, BodyError::Size),
    ("size infinite", |body| body.size = f32::INFINITY, BodyError::Size),
    (
        "a side's edge is not there",
        |body| {
            if let BakedSide::Edge { edge, .. } = &mut body.faces[0].sides[2] {
                *edge = 12;
            }
        },
        BodyError::Side { face: 0, side: 2 },
    ),
    (
        "a side's edge is another",
        |body| {
            if let BakedSide::Edge { edge, .. } = &mut body.faces[5].sides[3] {
                *edge = 0;
            }
        },
        BodyError::Side { face: 5, side: 3 },
    ),
    (
        "a pole's vertex is not there",
        |body| body.faces[1].sides[0] = BakedSide::Pole { vertex: 8 },
        BodyError::Side { face: 1, side: 0 },
    ),
    (
        "a plane's normal is NaN",
        |body| {
            *separator(body, 5, 0) = BakedSeparator::Plane { across: [0.0, f32::NAN, 0.0], offset: 0.0 };
        },
        BodyError::Side { face: 5, side: 0 },
    ),
    (
        "a plane's offset is infinite",
        |body| *separator(body, 5, 1) = BakedSeparator::Plane { across: [1.0, 0.0, 0.0], offset: f32::INFINITY },
        BodyError::Side { face: 5, side: 1 },
    ),
    ("a separator's degree is 11", |body| ruled(body, 0, 0).degree = 11, BodyError::Side { face: 0, side: 0 }),
    ("a separator lacks a coefficient", |body| ruled(body, 0, 1).degree += 1, BodyError::Side { face: 0, side: 1 }),
    (
        "a separator's borders fall",
        |body| ruled(body, 0, 3).breaks = vec![1.0, 0.0],
        BodyError::Side { face: 0, side: 3 },
    ),
    ("an edge's curve lacks a coefficient", |body| body.edges[3].curve.degree += 1, BodyError::Edge { edge: 3 }),
    ("an edge's borders end early", |body| body.edges[3].curve.breaks = vec![0.0, 0.5], BodyError::Edge { edge: 3 }),
    ("an edge's borders are one", |body| body.edges[3].curve.breaks = vec![0.0], BodyError::Edge { edge: 3 }),
    ("an edge's bound is NaN", |body| body.edges[3].curve.second_derivative = f32::NAN, BodyError::Edge { edge: 3 }),
    ("an edge's bound is negative", |body| body.edges[3].curve.second_derivative = -1.0, BodyError::Edge { edge: 3 }),
    ("an edge's vertex is not there", |body| body.edges[4].ends[1] = 8, BodyError::Edge { edge: 4 }),
    (
        "an edge's second face does not know it",
        |body| {
            let stranger = EdgeFace { face: 5, side: 0 };
            let first = body.edges[1].faces[0];
            // The face that was named still names the edge, and is refused first.
            body.faces[usize::from(body.edges[1].faces[1].face)].sides[usize::from(body.edges[1].faces[1].side)] =
                BakedSide::Pole { vertex: 0 };
            body.edges[1].faces = [first, stranger];
        },
        BodyError::Edge { edge: 1 },
    ),
    (
        "an edge has no first face",
        |body| {
            let [first, second] = body.edges[1].faces;
            body.faces[usize::from(first.face)].sides[usize::from(first.side)] = BakedSide::Pole { vertex: 0 };
            body.edges[1].faces = [EdgeFace::NONE, second];
        },
        BodyError::Edge { edge: 1 },
    ),
    (
        "a side that is none of four",
        |body| {
            let of = body.edges[2].faces[1];
            body.faces[usize::from(of.face)].sides[usize::from(of.side)] = BakedSide::Pole { vertex: 0 };
            body.edges[2].faces[1].side = 4;
        },
        BodyError::Edge { edge: 2 },
    ),
    ("a vertex is NaN", |body| body.vertices[7].point.z = f32::NAN, BodyError::Vertex { vertex: 7 }),
    ("a vertex has too many spokes", |body| body.vertices[7].spokes += 1, BodyError::Vertex { vertex: 7 }),
    ("a vertex's spokes begin too late", |body| body.vertices[7].first_spoke = 24, BodyError::Vertex { vertex: 7 }),
    ("spokes are missing", |body| body.spokes.truncate(23), BodyError::Vertex { vertex: 7 }),
    ("a spoke is infinite", |body| body.spokes[5].direction.x = f32::INFINITY, BodyError::Spoke { spoke: 5 }),
    ("a spoke's edge is not there", |body| body.spokes[5].edge = 12, BodyError::Spoke { spoke: 5 }),
    ("the cube is NaN", |body| body.locator.corner = Vec3::NAN, BodyError::LocatorCube),
    ("the cube has no side", |body| body.locator.side = -1.0, BodyError::LocatorCube),
    ("no node", |body| body.locator.nodes.clear(), BodyError::LocatorCube),
    ("no entry", |body| body.locator.entries.clear(), BodyError::LocatorCube),
    ("a node is its own child", |body| body.locator.nodes[0][3] = 0, BodyError::LocatorNode { node: 0 }),
    ("a child is past the end", |body| body.locator.nodes[0][7] = 7, BodyError::LocatorNode { node: 0 }),
    ("an entry's face is not there", |body| body.locator.entries[2] |= 6 << 20, BodyError::LocatorEntry { entry: 2 }),
    (
        "an entry's rectangle is empty",
        |body| body.locator.entries[2] = 2 << 20 | 1,
        BodyError::LocatorEntry { entry: 2 },
    ),
    ("a list has no end", |body| body.locator.entries[5] |= 1 << 31, BodyError::LocatorEntry { entry: 5 }),
];

type SpoilPatch = fn(&mut BakedPatch);

const SPOILED_PATCHES: &[(&str, SpoilPatch, TableError)] = &[
    ("degree 0", |patch| patch.degree[0] = 0, TableError::Degree),
    ("degree 6", |patch| patch.degree[1] = 6, TableError::Degree),
    ("borders along u fall", |patch| patch.breaks[0] = vec![1.0, 0.0], TableError::BreaksU),
    ("a border along v is NaN", |patch| patch.breaks[1] = vec![0.0, f32::NAN, 1.0], TableError::BreaksV),
    ("a span too many", |patch| patch.breaks[0] = vec![0.0, 0.5, 1.0], TableError::CoefficientCount),
    ("a degree too low", |patch| patch.degree[0] -= 1, TableError::CoefficientCount),
    (
        "a coefficient is infinite",
        |patch| {
            if let BakedCoefficients::Polynomial(entries) = &mut patch.coefficients {
                entries[3][1] = f32::NEG_INFINITY;
            }
        },
        TableError::CoefficientNotFinite,
    ),
    ("a bound is NaN", |patch| patch.shape.second_derivatives.uv = f32::NAN, TableError::Shape),
    ("no size", |patch| patch.size = -1.0, TableError::Size),
];

#[test]
fn every_spoiled_table_is_refused() -> Result<(), Box<dyn Error>> {
    BOX.to_body()?;
    for (what, spoil, expected) in SPOILED {
        let mut body = BOX.clone();
        spoil(&mut body);
        assert_eq!(body.to_body().err(), Some(TableFault::Body(*expected)), "{what}");
    }
    for (what, spoil, expected) in SPOILED_PATCHES {
        let mut body = BOX.clone();
        spoil(&mut body.faces[3].patch);
        assert_eq!(body.to_body().err(), Some(TableFault::Patch { face: 3, error: *expected }), "{what}");
    }
    println!("{} spoiled tables refused", SPOILED.len() + SPOILED_PATCHES.len());
    Ok(())
}

fn words(body: &Body) -> Vec<u32> {
    let (mut words, mut place) = (Vec::new(), Some(TableCursor::default()));
    while let Some(cursor) = place {
        let found = body.table_word(cursor);
        words.extend(found);
        place = cursor.after(found);
    }
    words
}

#[test]
fn every_flipped_bit_of_every_word_changes_the_crc() -> Result<(), Box<dyn Error>> {
    for baked in [&*BOX, &*POLES] {
        let body = baked.to_body()?;
        let words = words(&body);
        let crc = |words: &[u32], start: u32| words.iter().fold(start, |crc, word| crc32(crc, *word));
        let good = crc(&words, 0);
        assert_eq!(good, body.table_crc());
        let mut before = 0;
        for (index, word) in words.iter().enumerate() {
            for bit in 0..32 {
                assert_ne!(
                    crc(&words[index + 1..], crc32(before, word ^ (1 << bit))),
                    good,
                    "bit {bit} of word {index}"
                );
            }
            before = crc32(before, *word);
        }
        println!("{} words, {} bits flipped", words.len(), 32 * words.len());
    }
    Ok(())
}

/// Walks over every number of a body's tables and spoils the one that is to be.
struct Walk {
    spoilt: usize,
    seen: usize,
}

impl Walk {
    fn is_it(&mut self) -> bool {
        self.seen += 1;
        self.seen - 1 == self.spoilt
    }

    fn real(&mut self, value: &mut f32) {
        if self.is_it() {
            *value = f32::from_bits(value.to_bits() ^ 1);
        }
    }

    fn reals(&mut self, values: &mut [f32]) {
        values.iter_mut().for_each(|value| self.real(value));
    }

    fn vector(&mut self, vector: &mut Vec3) {
        self.real(&mut vector.x);
        self.real(&mut vector.y);
        self.real(&mut vector.z);
    }

    fn index(&mut self, value: &mut u16) {
        if self.is_it() {
            *value ^= 1;
        }
    }

    fn byte(&mut self, value: &mut u8) {
        if self.is_it() {
            *value ^= 1;
        }
    }

    fn flag(&mut self, value: &mut bool) {
        if self.is_it() {
            *value = !*value;
        }
    }

    fn coefficients(&mut self, coefficients: &mut BakedCoefficients) {
        match coefficients {
            BakedCoefficients::Polynomial(entries) => entries.iter_mut().for_each(|entry| self.reals(entry)),
            BakedCoefficients::Rational(entries) => entries.iter_mut().for_each(|entry| self.reals(entry)),
        }
    }

    fn curve(&mut self, curve: &mut BakedCurve) {
        self.byte(&mut curve.degree);
        self.reals(&mut curve.breaks);
        self.coefficients(&mut curve.coefficients);
        self.real(&mut curve.second_derivative);
    }

    fn patch(&mut self, patch: &mut BakedPatch) {
        patch.degree.iter_mut().for_each(|degree| self.byte(degree));
        patch.breaks.iter_mut().for_each(|breaks| self.reals(breaks));
        self.coefficients(&mut patch.coefficients);
        let shape = &mut patch.shape;
        let derivatives = &mut shape.second_derivatives;
        for value in [&mut derivatives.uu, &mut derivatives.uv, &mut derivatives.vv] {
            self.real(value);
        }
        for value in [&mut shape.curvature.min, &mut shape.curvature.max] {
            self.real(value);
        }
        for value in [&mut shape.min_stretch, &mut shape.max_stretch, &mut shape.max_bend] {
            self.real(value);
        }
        if self.is_it() {
            patch.orientation = match patch.orientation {
                Orientation::Outward => Orientation::Inward,
                Orientation::Inward => Orientation::Outward,
            };
        }
        self.real(&mut patch.size);
    }

    fn body(&mut self, body: &mut BakedBody) {
        for face in &mut body.faces {
            self.patch(&mut face.patch);
            for side in &mut face.sides {
                match side {
                    BakedSide::Pole { vertex } => self.index(vertex),
                    BakedSide::Edge { edge, reversed, separator } => {
                        self.index(edge);
                        self.flag(reversed);
                        match separator {
                            BakedSeparator::Plane { across, offset } => {
                                self.reals(across);
                                self.real(offset);
                            }
                            BakedSeparator::Ruled(curve) => self.curve(curve),
                        }
                    }
                }
            }
        }
        for edge in &mut body.edges {
            self.curve(&mut edge.curve);
            for face in &mut edge.faces {
                self.index(&mut face.face);
                self.byte(&mut face.side);
            }
            edge.ends.iter_mut().for_each(|end| self.index(end));
            if self.is_it() {
                edge.kind = if edge.kind == EdgeKind::Mixed { EdgeKind::Convex } else { EdgeKind::Mixed };
            }
        }
        for vertex in &mut body.vertices {
            self.vector(&mut vertex.point);
            self.index(&mut vertex.first_spoke);
            self.index(&mut vertex.spokes);
            self.flag(&mut vertex.is_open);
        }
        for spoke in &mut body.spokes {
            self.vector(&mut spoke.direction);
            self.index(&mut spoke.edge);
            self.flag(&mut spoke.at_upper_end);
        }
        self.vector(&mut body.locator.corner);
        self.real(&mut body.locator.side);
        body.locator.nodes.iter_mut().flatten().for_each(|child| self.index(child));
        for entry in &mut body.locator.entries {
            if self.is_it() {
                *entry ^= 1;
            }
        }
        self.real(&mut body.size);
        self.flag(&mut body.is_convex);
    }
}

/// The words leave no number out: whichever is changed by its last bit, the constructor refuses the table or its CRC is
/// another.
#[test]
fn every_number_of_the_tables_is_in_the_words() -> Result<(), Box<dyn Error>> {
    for baked in [&*BOX, &*POLES] {
        let good = baked.to_body()?.table_crc();
        let mut count = Walk { spoilt: usize::MAX, seen: 0 };
        count.body(&mut baked.clone());
        let mut refused = 0;
        for spoilt in 0..count.seen {
            let mut body = baked.clone();
            Walk { spoilt, seen: 0 }.body(&mut body);
            match body.to_body() {
                Ok(body) => assert_ne!(body.table_crc(), good, "number {spoilt} of {}", count.seen),
                Err(_) => refused += 1,
            }
        }
        println!("{} numbers spoilt, {refused} refused, the others found by their CRC", count.seen);
        // Indices are a third at most; ends of edges and spokes are refused, for each states the other.
        assert!(count.seen > 800 && refused < count.seen / 3, "{refused} of {}", count.seen);
    }
    Ok(())
}
