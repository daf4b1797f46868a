//! The scene: one polynomial patch, as control points and as palpate's tables, and the probes. Lines of `key value
//! value …`, metres; numbers are printed so that reading them gives the same bits.

use anyhow::{Context as _, bail, ensure};
use palpate::body::{
    Body, BodyTables, Edge, EdgeFace, EdgeKind, Face, Lists, Locator, Separator, Side, SplineCurve, Spoke, Vertex,
};
use palpate::math::Vec3;
use palpate::patch::{
    Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable, ThirdDerivativeBounds,
};
use std::collections::HashMap;
use std::fs;
use std::str::FromStr;

/// A query point, metres, in both precisions, so that no contestant's time includes a conversion.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    pub single: [f32; 3],
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "only peers look at it"))]
    pub double: [f64; 3],
}

/// The input of every contestant.
#[derive(Debug)]
pub struct Scene {
    /// Knots along `u` and `v`.
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "only peers look at it"))]
    pub knots: [Vec<f64>; 2],
    /// Control points: along `u` rows, along `v` columns.
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "only peers look at it"))]
    pub points: Vec<Vec<[f64; 3]>>,
    /// palpate's table: span borders along `u` and `v`.
    pub breaks: [&'static [f32]; 2],
    /// palpate's table: 9 coefficients a span.
    pub coefficients: &'static [[f32; 3]],
    /// The patch as the firmware has it.
    pub patch: SplinePatch<'static>,
    /// The patch as a body with its locator, for a cold start. Its borders have no part in that and are left out.
    pub body: Body<'static>,
    /// Step between counted queries.
    pub stride: usize,
    /// The queries, in order.
    pub probes: Vec<Probe>,
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// A missing or faulty line.
    pub fn read(file: &str) -> anyhow::Result<Self> {
        let text = fs::read_to_string(file)?;
        let lines: HashMap<&str, &str> = text.lines().filter_map(|line| line.split_once(' ')).collect();
        let degree = numbers::<u8>(&lines, "degree")?;
        // Newton's method is compiled for the degree, as one would on a target.
        ensure!(degree == [2, 2], "the race is for biquadratic patches, not degree {degree:?}");
        let doubles = |key| numbers::<f64>(&lines, key);
        let singles = |key| numbers::<f32>(&lines, key).map(|all| -> &'static [f32] { all.leak() });
        let columns = *numbers::<usize>(&lines, "columns")?.first().context("columns")?;
        let points: Vec<[f64; 3]> = triples(&doubles("points")?);
        let breaks = [singles("breaks_u")?, singles("breaks_v")?];
        let coefficients: &'static [[f32; 3]] = triples(singles("coefficients")?).leak();
        let [uu, uv, vv] = exactly(&lines, "second_derivatives")?;
        let [uuu, uuv, uvv, vvv] = exactly(&lines, "third_derivatives")?;
        let [jump_uu, jump_vv] = exactly(&lines, "jumps")?;
        let third_derivatives = ThirdDerivativeBounds { uuu, uuv, uvv, vvv, jump_uu, jump_vv };
        let size = *singles("size")?.first().context("size")?;
        let patch = SplineTable {
            degree: [2, 2],
            breaks_u: breaks[0],
            breaks_v: breaks[1],
            coefficients: Coefficients::Polynomial(coefficients),
            shape: ShapeBounds { third_derivatives, ..ShapeBounds::unknown(SecondDerivativeBounds { uu, uv, vv }) },
            orientation: Orientation::Outward,
            size_m: size,
            crc: None,
        }
        .try_checked()?;
        let body = body(patch, size, &lines)?;
        let probe = |double: [f64; 3]| Probe { single: double.map(|value| value as f32), double };
        let stride = *numbers::<usize>(&lines, "stride")?.first().context("stride")?;
        ensure!(stride > 0, "stride: 0");
        Ok(Self {
            stride,
            knots: [doubles("knots_u")?, doubles("knots_v")?],
            points: points.chunks(columns.max(1)).map(<[_]>::to_vec).collect(),
            breaks,
            coefficients,
            patch,
            body,
            probes: triples(&doubles("probes")?).into_iter().map(probe).collect(),
        })
    }
}

fn body(patch: SplinePatch<'static>, size: f32, lines: &HashMap<&str, &str>) -> anyhow::Result<Body<'static>> {
    let [x, y, z, side] = exactly(lines, "cube")?;
    let nodes: Vec<[u16; 8]> = numbers::<u16>(lines, "nodes")?.as_chunks().0.to_vec();
    let entries = *numbers::<u16>(lines, "entries")?.first().context("entries")?;
    let [entry_bits, face_bits] = numbers::<u8>(lines, "bits")?[..] else { bail!("bits: 2 numbers are needed") };
    let [rectangles, candidates] = ["rectangles", "candidates"].map(|key| numbers::<u8>(lines, key));
    let (rectangles, candidates) = (rectangles?.leak(), candidates?.leak());
    let lists = Lists { entries, entry_bits, face_bits, rectangles, candidates };
    let locator = Locator { corner: Vec3::new(x, y, z), side, nodes: nodes.leak(), lists };
    // Four open borders that no search looks at; as poles they would be searched around.
    let separator = Separator::Plane { across: Vec3::X, offset: 0.0 };
    let sides = [0, 1, 2, 3].map(|edge| Side::Edge { edge, reversed: false, separator });
    let faces = vec![Face { patch, sides }];
    let curve = SplineCurve {
        degree: 0,
        breaks: &[0.0, 1.0],
        coefficients: Coefficients::Polynomial(&[[0.0; 3]]),
        second_derivative: 0.0,
    };
    let edge = |side| Edge {
        curve,
        third_derivative: 0.0,
        jump: 0.0,
        faces: [EdgeFace { face: 0, side }, EdgeFace::NONE],
        ends: [0; 2],
        kind: EdgeKind::Open,
    };
    let edges: Vec<Edge> = [0, 1, 2, 3].map(edge).into();
    let vertices = vec![Vertex { point: Vec3::ZERO, outward: Vec3::ZERO, first_spoke: 0, spokes: 8, is_open: true }];
    let spoke = |end: u16| Spoke { direction: Vec3::ZERO, edge: end / 2, at_upper_end: end % 2 == 1 };
    let spokes: Vec<Spoke> = (0..8).map(spoke).collect();
    Ok(BodyTables {
        faces: faces.leak(),
        edges: edges.leak(),
        vertices: vertices.leak(),
        spokes: spokes.leak(),
        locator,
        size_m: size,
        is_convex: false,
        crc: None,
    }
    .try_checked()?)
}

fn numbers<T: FromStr>(lines: &HashMap<&str, &str>, key: &str) -> anyhow::Result<Vec<T>> {
    let line = lines.get(key).with_context(|| format!("no line {key}"))?;
    let number = |word: &str| word.parse::<T>().ok().with_context(|| format!("{key}: {word} is not a number"));
    line.split_whitespace().map(number).collect()
}

fn exactly<const N: usize>(lines: &HashMap<&str, &str>, key: &str) -> anyhow::Result<[f32; N]> {
    let all = numbers(lines, key)?;
    all.try_into().ok().with_context(|| format!("{key}: {N} numbers are needed"))
}

fn triples<T: Copy>(flat: &[T]) -> Vec<[T; 3]> {
    flat.chunks_exact(3).map(|triple| [triple[0], triple[1], triple[2]]).collect()
}
