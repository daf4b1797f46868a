//! The bytes of a file.

use super::notes::FileFault;
use super::notes::Notes;
use crate::BakedCoefficients;
use crate::body::{BakedBody, BakedCurve, BakedEdge, BakedFace, BakedSeparator, BakedSide};
use crate::locator::PackedLists;
use crate::model::Model;
use palpate::body::{FILE_VERSION, Section, Spoke, Vertex};
use palpate::math::Vec3;
use palpate::patch::{Orientation, crc32};

/// The file of a body; `source` is the SHA-256 of its model's file.
///
/// # Errors
/// Where the library refuses the tables, a bug, or they are too large.
pub fn write(source: [u8; 32], model: &Model, body: &BakedBody) -> Result<Vec<u8>, FileFault> {
    let crc = body.to_body()?.table_crc();
    let numbers = Numbers(body.distinct_breaks());
    let mut words = vec![u32::from_le_bytes(*b"PALP"), FILE_VERSION, 0];
    let mut section = |section: Section, data: Vec<u32>| {
        words.extend([letters(section), 4 * data.len() as u32]);
        words.extend(data);
    };
    section(Section::Source, little(&source));
    let centre = model.centre.as_vec3().to_array();
    let reals = [body.size].into_iter().chain(body.locator.corner.to_array()).chain([body.locator.side]).chain(centre);
    let lists = PackedLists::of(&body.locator.entries);
    let counts = u32::from(lists.entries) | u32::from(lists.entry_bits) << 16 | u32::from(lists.face_bits) << 24;
    let whole = [crc, u32::from(body.is_convex)].into_iter().chain(reals.map(f32::to_bits)).chain([counts]);
    section(Section::Body, whole.collect());
    section(Section::Borders, numbers.0.iter().flatten().map(|border| border.to_bits()).collect());
    section(Section::Coefficients, coefficients(body));
    section(Section::Faces, body.faces.iter().flat_map(|of| numbers.face(of)).collect());
    section(Section::Edges, body.edges.iter().flat_map(|of| numbers.edge(of)).collect());
    section(Section::Vertices, body.vertices.iter().flat_map(vertex).collect());
    section(Section::Spokes, body.spokes.iter().flat_map(spoke).collect());
    let pairs =
        body.locator.nodes.iter().flat_map(|node| node.as_chunks().0.iter().map(|[low, high]| pair(*low, *high)));
    section(Section::Nodes, pairs.collect());
    section(Section::Rectangles, little(&lists.rectangles));
    section(Section::Entries, little(&lists.candidates));
    section(Section::Notes, little(&Notes::of(model, body).to_bytes()));
    let bytes = 4 * (words.len() + 1);
    words[2] = u32::try_from(bytes).map_err(|_| FileFault::TooLarge { bytes })?;
    words.push(words.iter().fold(0, |crc, word| crc32(crc, *word)));
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}

fn letters(section: Section) -> u32 {
    little(section.letters().as_bytes())[0]
}

/// Bytes as words; a multiple of four.
fn little(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

const fn pair(low: u16, high: u16) -> u32 {
    low as u32 | (high as u32) << 16
}

/// The coefficients in the order in which the records need them: each face's patch and its separators, then the edges.
fn coefficients(body: &BakedBody) -> Vec<u32> {
    let mut words = Vec::new();
    let mut add = |coefficients: &BakedCoefficients| match coefficients {
        BakedCoefficients::Polynomial(entries) => words.extend(entries.iter().flatten().map(|number| number.to_bits())),
        BakedCoefficients::Rational(entries) => words.extend(entries.iter().flatten().map(|number| number.to_bits())),
    };
    for face in &body.faces {
        add(&face.patch.coefficients);
        for side in &face.sides {
            if let BakedSide::Edge { separator: BakedSeparator::Ruled(curve), .. } = side {
                add(&curve.coefficients);
            }
        }
    }
    body.edges.iter().for_each(|edge| add(&edge.curve.coefficients));
    words
}

/// The lists of span borders.
struct Numbers(Vec<Vec<f32>>);

impl Numbers {
    /// The start of a list.
    fn place(&self, breaks: &[f32]) -> u32 {
        self.0.iter().take_while(|known| *known != breaks).map(|known| known.len() as u32).sum()
    }

    fn face(&self, BakedFace { patch, sides, .. }: &BakedFace) -> Vec<u32> {
        let [degree_u, degree_v] = patch.degree;
        let turned = u8::from(patch.orientation == Orientation::Inward);
        let [breaks_u, breaks_v] = &patch.breaks;
        let mut words = vec![
            u32::from_le_bytes([degree_u, degree_v, kind(&patch.coefficients), turned]),
            pair(breaks_u.len() as u16, breaks_v.len() as u16),
            self.place(breaks_u),
            self.place(breaks_v),
        ];
        let (second, third) = (&patch.shape.second_derivatives, &patch.shape.third_derivatives);
        let bounds = [
            second.uu,
            second.uv,
            second.vv,
            third.uuu,
            third.uuv,
            third.uvv,
            third.vvv,
            third.jump_uu,
            third.jump_vv,
            patch.shape.curvature.min,
            patch.shape.curvature.max,
            patch.shape.min_stretch,
            patch.shape.max_stretch,
            patch.shape.max_bend,
            patch.size,
        ];
        words.extend(bounds.map(f32::to_bits));
        words.extend(sides.iter().flat_map(|of| self.side(of)));
        words
    }

    fn side(&self, side: &BakedSide) -> [u32; 5] {
        match side {
            BakedSide::Pole { vertex } => [u32::from(*vertex) << 16, 0, 0, 0, 0],
            BakedSide::Edge { edge, reversed, separator } => {
                let head = u32::from(*reversed) << 8 | u32::from(*edge) << 16;
                match separator {
                    BakedSeparator::Plane { across: [x, y, z], offset } => {
                        let [x, y, z, offset] = [x, y, z, offset].map(|number| number.to_bits());
                        [head | 1, x, y, z, offset]
                    }
                    BakedSeparator::Ruled(curve) => {
                        let [codes, first, second_derivative] = self.curve(curve);
                        [head | 2, codes, first, second_derivative, 0]
                    }
                }
            }
        }
    }

    fn curve(&self, curve: &BakedCurve) -> [u32; 3] {
        let codes = u32::from(curve.degree)
            | u32::from(kind(&curve.coefficients)) << 8
            | u32::from(curve.breaks.len() as u16) << 16;
        [codes, self.place(&curve.breaks), curve.second_derivative.to_bits()]
    }

    fn edge(&self, edge: &BakedEdge) -> [u32; 8] {
        let [codes, first_border, second_derivative] = self.curve(&edge.curve);
        let [third_derivative, jump] = edge.third_derivative.map(f32::to_bits);
        let [first, second] = edge.faces.map(|of| u32::from(of.face) | u32::from(of.side) << 16);
        let first = first | (edge.kind as u32) << 24;
        let ends = pair(edge.ends[0], edge.ends[1]);
        [codes, first_border, second_derivative, third_derivative, jump, first, second, ends]
    }
}

/// 1 if rational.
const fn kind(coefficients: &BakedCoefficients) -> u8 {
    matches!(coefficients, BakedCoefficients::Rational(_)) as u8
}

fn bits(vector: Vec3) -> [u32; 3] {
    vector.to_array().map(f32::to_bits)
}

fn vertex(vertex: &Vertex) -> [u32; 8] {
    let ([x, y, z], [a, b, c]) = (bits(vertex.point), bits(vertex.outward));
    [x, y, z, a, b, c, pair(vertex.first_spoke, vertex.spokes), u32::from(vertex.is_open)]
}

fn spoke(spoke: &Spoke) -> [u32; 4] {
    let [x, y, z] = bits(spoke.direction);
    [x, y, z, pair(spoke.edge, u16::from(spoke.at_upper_end))]
}
