//! The tokens of a body.

use super::{Check, Origin, joined, number, pretty, rows};
use crate::BakedCoefficients;
use crate::body::{BakedBody, BakedCurve, BakedEdge, BakedFace, BakedSeparator, BakedSide};
use crate::locator::PackedLists;
use palpate::body::{EdgeFace, EdgeKind, Effort, Spoke, TickLimit, Vertex};
use palpate::math::Vec3;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::fmt::Write as _;
use thiserror::Error;

/// Why there is no source: bugs of the baker both.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The library refuses the tables.
    #[error(transparent)]
    Table(#[from] crate::body::TableFault),
    /// The tokens do not parse as Rust.
    #[error("the tables do not parse as Rust: {0}")]
    Syntax(#[from] syn::Error),
}

/// The source: `pub static BODY: Body`, checked when it is compiled, and `pub const TABLE_CRC: u32` of all its numbers.
/// `labels` name the faces.
///
/// # Errors
/// Where the library refuses the tables, or they do not parse: bugs.
pub fn body_source(origin: &Origin<'_>, body: &BakedBody, labels: &[String]) -> Result<String, SourceError> {
    let tables = body.to_body()?;
    let (crc, effort) = (tables.table_crc(), tables.fitted(origin.limit).effort());
    let mut source = origin.header();
    let (faces, edges, vertices) = (body.faces.len(), body.edges.len(), body.vertices.len());
    // Writing to a string does not fail.
    let _ = writeln!(
        source,
        "// A body of {faces} faces, {edges} edges and {vertices} vertices. CRC-32 of its numbers: {crc:08x}"
    );
    let breaks = Breaks(body.distinct_breaks());
    let _ = write!(source, "\n// Span borders.\n{}", pretty(breaks.statics())?);
    for (index, face) in body.faces.iter().enumerate() {
        let label = labels.get(index).map_or("", String::as_str);
        let _ = write!(source, "\n// Face {index}: {label}.\n{}", pretty(face_numbers(index, face))?);
    }
    for (index, edge) in body.edges.iter().enumerate() {
        let numbers = coefficients(&format_ident!("EDGE_{index}"), &edge.curve.coefficients);
        let _ = write!(source, "\n// Edge {index}.\n{}", pretty(numbers)?);
    }
    let _ = write!(source, "\n{}", pretty(lists(body, &breaks))?);
    let _ = write!(source, "\n{}", pretty(whole(body, crc, (effort, origin.limit), &origin.centre()))?);
    Ok(source)
}

/// The span borders of all patches and curves; equal ones are one static.
struct Breaks(Vec<Vec<f32>>);

impl Breaks {
    fn name(&self, breaks: &[f32]) -> Ident {
        format_ident!("BREAKS_{}", self.0.iter().position(|known| *known == breaks).unwrap_or_default())
    }

    fn statics(&self) -> TokenStream {
        let one = |(index, breaks): (usize, &Vec<f32>)| {
            let (name, count) = (format_ident!("BREAKS_{index}"), Literal::usize_unsuffixed(breaks.len()));
            let numbers = breaks.iter().copied().map(number);
            quote! {
                #[rustfmt::skip]
                static #name: [f32; #count] = [#(#numbers),*];
            }
        };
        self.0.iter().enumerate().map(one).collect()
    }
}

fn coefficients(name: &Ident, coefficients: &BakedCoefficients) -> TokenStream {
    let (count, components, entries) = match coefficients {
        BakedCoefficients::Polynomial(entries) => (entries.len(), 3_usize, rows(entries)),
        BakedCoefficients::Rational(entries) => (entries.len(), 4_usize, rows(entries)),
    };
    let [count, components] = [count, components].map(Literal::usize_unsuffixed);
    quote! {
        #[rustfmt::skip]
        static #name: [[f32; #components]; #count] = [#(#entries),*];
    }
}

fn separator_name(face: usize, side: usize) -> Ident {
    format_ident!("FACE_{face}_SIDE_{side}")
}

fn face_numbers(index: usize, face: &BakedFace) -> TokenStream {
    let patch = coefficients(&format_ident!("FACE_{index}"), &face.patch.coefficients);
    let separators = face.sides.iter().enumerate().filter_map(|(side, of)| match of {
        BakedSide::Edge { separator: BakedSeparator::Ruled(curve), .. } => {
            Some(coefficients(&separator_name(index, side), &curve.coefficients))
        }
        _ => None,
    });
    quote!(#patch #(#separators)*)
}

/// Faces, edges, vertices and spokes.
fn lists(body: &BakedBody, breaks: &Breaks) -> TokenStream {
    let faces: Vec<_> = body.faces.iter().enumerate().map(|(index, of)| face(index, of, breaks)).collect();
    let edges: Vec<_> = body.edges.iter().enumerate().map(|(index, of)| edge(index, of, breaks)).collect();
    let vertices: Vec<_> = body.vertices.iter().map(vertex).collect();
    let spokes: Vec<_> = body.spokes.iter().map(spoke).collect();
    let [face_count, edge_count, vertex_count, spoke_count] =
        [faces.len(), edges.len(), vertices.len(), spokes.len()].map(Literal::usize_unsuffixed);
    quote! {
        #[rustfmt::skip]
        static FACES: [palpate::body::Face; #face_count] = [#(#faces),*];
        #[rustfmt::skip]
        static EDGES: [palpate::body::Edge; #edge_count] = [#(#edges),*];
        #[rustfmt::skip]
        static VERTICES: [palpate::body::Vertex; #vertex_count] = [#(#vertices),*];
        #[rustfmt::skip]
        static SPOKES: [palpate::body::Spoke; #spoke_count] = [#(#spokes),*];
    }
}

fn face(index: usize, face: &BakedFace, breaks: &Breaks) -> TokenStream {
    let [breaks_u, breaks_v] = face.patch.breaks.each_ref().map(|of| breaks.name(of));
    let patch = joined([breaks_u, breaks_v, format_ident!("FACE_{index}")], &face.patch, Check::InBody);
    let sides = face.sides.iter().enumerate().map(|(side, of)| match of {
        BakedSide::Pole { vertex } => {
            let vertex = Literal::u16_unsuffixed(*vertex);
            quote!(palpate::body::Side::Pole { vertex: #vertex })
        }
        BakedSide::Edge { edge, reversed, separator } => {
            let edge = Literal::u16_unsuffixed(*edge);
            let separator = match separator {
                BakedSeparator::Plane { across, offset } => {
                    let (across, offset) = (vector(Vec3::from_array(*across)), number(*offset));
                    quote!(palpate::body::Separator::Plane { across: #across, offset: #offset })
                }
                BakedSeparator::Ruled(of) => {
                    let curve = curve(of, &separator_name(index, side), breaks);
                    quote!(palpate::body::Separator::Ruled(#curve))
                }
            };
            quote!(palpate::body::Side::Edge { edge: #edge, reversed: #reversed, separator: #separator })
        }
    });
    quote!(palpate::body::Face { patch: #patch, sides: [#(#sides),*] })
}

fn curve(curve: &BakedCurve, coefficients: &Ident, breaks: &Breaks) -> TokenStream {
    let (degree, breaks) = (Literal::u8_unsuffixed(curve.degree), breaks.name(&curve.breaks));
    let kind = match curve.coefficients {
        BakedCoefficients::Polynomial(_) => quote!(Polynomial),
        BakedCoefficients::Rational(_) => quote!(Rational),
    };
    let second_derivative = number(curve.second_derivative);
    quote! {
        palpate::body::SplineCurve {
            degree: #degree,
            breaks: &#breaks,
            coefficients: palpate::patch::Coefficients::#kind(&#coefficients),
            second_derivative: #second_derivative,
        }
    }
}

fn edge(index: usize, edge: &BakedEdge, breaks: &Breaks) -> TokenStream {
    let curve = curve(&edge.curve, &format_ident!("EDGE_{index}"), breaks);
    let faces = edge.faces.map(|of| {
        if of == EdgeFace::NONE {
            return quote!(palpate::body::EdgeFace::NONE);
        }
        let (face, side) = (Literal::u16_unsuffixed(of.face), Literal::u8_unsuffixed(of.side));
        quote!(palpate::body::EdgeFace { face: #face, side: #side })
    });
    let ends = edge.ends.map(Literal::u16_unsuffixed);
    let kind = match edge.kind {
        EdgeKind::Convex => quote!(Convex),
        EdgeKind::Smooth => quote!(Smooth),
        EdgeKind::Reflex => quote!(Reflex),
        EdgeKind::Mixed => quote!(Mixed),
        EdgeKind::Open => quote!(Open),
    };
    let [third_derivative, jump] = edge.third_derivative.map(number);
    quote! {
        palpate::body::Edge {
            curve: #curve,
            third_derivative: #third_derivative,
            jump: #jump,
            faces: [#(#faces),*],
            ends: [#(#ends),*],
            kind: palpate::body::EdgeKind::#kind,
        }
    }
}

fn vertex(vertex: &Vertex) -> TokenStream {
    let Vertex { point, outward, first_spoke, spokes, is_open } = vertex;
    let [point, outward] = [*point, *outward].map(vector);
    let [first_spoke, spokes] = [*first_spoke, *spokes].map(Literal::u16_unsuffixed);
    quote! {
        palpate::body::Vertex {
            point: #point,
            outward: #outward,
            first_spoke: #first_spoke,
            spokes: #spokes,
            is_open: #is_open,
        }
    }
}

fn spoke(spoke: &Spoke) -> TokenStream {
    let Spoke { direction, edge, at_upper_end } = spoke;
    let (direction, edge) = (vector(*direction), Literal::u16_unsuffixed(*edge));
    quote!(palpate::body::Spoke { direction: #direction, edge: #edge, at_upper_end: #at_upper_end })
}

fn vector(vector: Vec3) -> TokenStream {
    let [x, y, z] = vector.to_array().map(number);
    quote!(palpate::math::vec3(#x, #y, #z))
}

/// The limit of a tick.
fn limit_of(limit: TickLimit) -> TokenStream {
    if limit == TickLimit::BENCH {
        return quote!(palpate::body::TickLimit::BENCH);
    }
    let TickLimit { evaluations, cycles } = limit;
    let [evaluations, cycles] = [evaluations, cycles].map(Literal::u32_unsuffixed);
    quote!(palpate::body::TickLimit { evaluations: #evaluations, cycles: #cycles })
}

/// The locator and the body, with its effort and the limit that this keeps.
fn whole(body: &BakedBody, crc: u32, (effort, limit): (Effort, TickLimit), centre: &TokenStream) -> TokenStream {
    let [effort_steps, effort_candidates] = [effort.steps, effort.candidates].map(Literal::u8_unsuffixed);
    let limit = limit_of(limit);
    let locator = &body.locator;
    let nodes = locator.nodes.iter().map(|node| {
        let children = node.map(Literal::u16_unsuffixed);
        quote!([#(#children),*])
    });
    let node_count = Literal::usize_unsuffixed(locator.nodes.len());
    let PackedLists { entries, entry_bits, face_bits, rectangles, candidates } = PackedLists::of(&locator.entries);
    let entries = Literal::u16_unsuffixed(entries);
    let [entry_bits, face_bits] = [entry_bits, face_bits].map(Literal::u8_unsuffixed);
    let [rectangle_bytes, candidate_bytes] =
        [&rectangles, &candidates].map(|bytes| Literal::usize_unsuffixed(bytes.len()));
    let [rectangles, candidates] = [rectangles, candidates].map(|bytes| bytes.into_iter().map(Literal::u8_unsuffixed));
    let (corner, side, size) = (vector(locator.corner), number(locator.side), number(body.size));
    let (is_convex, crc) = (body.is_convex, Literal::u32_unsuffixed(crc));
    quote! {
        #[rustfmt::skip]
        static NODES: [[u16; 8]; #node_count] = [#(#nodes),*];
        #[rustfmt::skip]
        static RECTANGLES: [u8; #rectangle_bytes] = [#(#rectangles),*];
        #[rustfmt::skip]
        static CANDIDATES: [u8; #candidate_bytes] = [#(#candidates),*];
        /// CRC-32 of the body's numbers, [`palpate::body::Body::table_crc`], computed when it was baked.
        #[allow(dead_code)]
        pub const TABLE_CRC: u32 = #crc;
        /// The body.
        // The compiler checks every entry of the tables.
        #[allow(dead_code, long_running_const_eval)]
        #[rustfmt::skip]
        pub static BODY: palpate::body::Body = palpate::body::BodyTables {
            faces: &FACES,
            edges: &EDGES,
            vertices: &VERTICES,
            spokes: &SPOKES,
            locator: palpate::body::Locator {
                corner: #corner,
                side: #side,
                nodes: &NODES,
                lists: palpate::body::Lists {
                    entries: #entries,
                    entry_bits: #entry_bits,
                    face_bits: #face_bits,
                    rectangles: &RECTANGLES,
                    candidates: &CANDIDATES,
                },
            },
            size_m: #size,
            is_convex: #is_convex,
            crc: Some(TABLE_CRC),
        }
        .checked()
        .with_effort(palpate::body::Effort { steps: #effort_steps, candidates: #effort_candidates });
        /// The type of the surface.
        #[allow(dead_code)]
        pub type Surface = palpate::body::Body<'static, palpate::field::Rigid<{ BODY.kinds() }>>;
        /// The body, with code for its own kinds of patches alone.
        #[allow(dead_code)]
        pub const SURFACE: &Surface = &BODY.of_kinds();
        /// The body with another effort in each tick, as far as every tick keeps the limit that it was baked for.
        #[allow(dead_code)]
        pub const fn with_effort(effort: palpate::body::Effort) -> Surface {
            BODY.with_effort(effort).fitted(#limit).of_kinds()
        }
        #centre
    }
}
