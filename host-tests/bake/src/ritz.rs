//! Modes of a body of one elastic material, by Ritz's method in polynomials (Visscher's "xyz algorithm", 1991): the
//! matrices need the body's moments `∫ xᵃ yᵇ zᶜ dV` alone, which the divergence theorem takes from its patches. No mesh.
//!
//! Frequencies and modal masses come from polynomials of degree 6, shapes are what a quadratic field holds of these
//! modes, and the *share* says how much of the mode's mass that is.

mod linear;

use crate::body::BakedBody;
use crate::jet::Jet;
use crate::model::{Model, message};
use crate::modes::{self, ModesError};
use crate::patch::{Axis, NurbsPatch};
use glam::DVec3;
use linear::{Matrix, SINGULAR, lowest};
use palpate::field::MAX_MODES;
use serde::Deserialize;
use std::fmt::Write as _;
use std::path::Path;
use thiserror::Error;

/// Degree of the polynomials that frequencies come from.
const DEGREE: usize = 6;
/// Modes of a body in the order of their frequency, among which those are looked for that a field holds.
const LOOKED_AT: usize = 16;
/// Minimum share of a mode for which a field stands.
const MIN_SHARE: f64 = 0.5;
/// Maximum of `Σ |q| Lip ψ`, which must stay below 1 (theory §15).
const MAX_STRETCH: f64 = 0.5;
/// Maximum of `|q|`, in sizes of the body.
const MAX_SIZES: f64 = 0.1;

/// Why a body has no modes.
#[derive(Debug, Error)]
pub enum RitzError {
    /// The material's file cannot be read.
    #[error("{file}: cannot be read: {cause}")]
    Read {
        /// The file.
        file: String,
        /// Why.
        cause: std::io::Error,
    },
    /// It is not TOML, or a key is missing, unknown or of the wrong kind.
    #[error("{file}: {message}; a material has youngs_modulus_pa, poissons_ratio, density_kg_per_m3 and damping_ratio")]
    Syntax {
        /// The file.
        file: String,
        /// Where and what.
        message: String,
    },
    /// A number outside of its range.
    #[error("{file}: {key} is {value}: must be {range}")]
    Number {
        /// The file.
        file: String,
        /// Which.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The range.
        range: &'static str,
    },
    /// The body has no inside.
    #[error("{model}: an open body has no volume, and no modes: close it ({edges} open edges)")]
    Open {
        /// The model.
        model: String,
        /// The number of open edges.
        edges: usize,
    },
    /// A face to hold that there is none of.
    #[error("--held {name}: {model} has no such face; it has {faces}")]
    Face {
        /// The name.
        name: String,
        /// The model.
        model: String,
        /// All names.
        faces: String,
    },
    /// More modes than a body may have, or none.
    #[error("--modes {count}: a body has 1 to {MAX_MODES}")]
    Count {
        /// How many.
        count: usize,
    },
    /// The moments are those of no solid.
    #[error(
        "{model}: the mass matrix is singular: the body is too thin for its size, or its patches cut each other (see check)"
    )]
    Singular {
        /// The model.
        model: String,
    },
    /// No mode is held by a quadratic field.
    #[error("{model}: no mode of the first {LOOKED_AT} is held by a quadratic field to a half; give modes of your own")]
    NoShape {
        /// The model.
        model: String,
    },
    /// Modes that were given are wrong.
    #[error(transparent)]
    Modes(#[from] ModesError),
}

/// An elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
    /// Damping ratio of every mode; 1 is critical.
    pub damping_ratio: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMaterial {
    #[serde(rename = "name")]
    _name: Option<String>,
    youngs_modulus_pa: f64,
    poissons_ratio: f64,
    density_kg_per_m3: f64,
    damping_ratio: f64,
}

impl Material {
    /// Reads a material's file.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn read(path: &Path) -> Result<Self, RitzError> {
        let file = path.display().to_string();
        match std::fs::read_to_string(path) {
            Ok(text) => Self::parse(&text, &file),
            Err(cause) => Err(RitzError::Read { file, cause }),
        }
    }

    /// The material of a text; `file` is what messages call it.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn parse(text: &str, file: &str) -> Result<Self, RitzError> {
        let raw: RawMaterial = toml::from_str(text)
            .map_err(|error| RitzError::Syntax { file: file.to_owned(), message: message(text, &error) })?;
        let RawMaterial { youngs_modulus_pa, poissons_ratio, density_kg_per_m3, damping_ratio, .. } = raw;
        let positive = |value: f64| value > 0.0 && value < f64::INFINITY;
        for (key, value, is_within, range) in [
            ("youngs_modulus_pa", youngs_modulus_pa, positive(youngs_modulus_pa), "above 0 and finite"),
            // At 1/2 the volume is constant and the bulk modulus infinite.
            (
                "poissons_ratio",
                poissons_ratio,
                poissons_ratio > -1.0 && poissons_ratio <= 0.49,
                "above -1, at most 0.49",
            ),
            ("density_kg_per_m3", density_kg_per_m3, positive(density_kg_per_m3), "above 0 and finite"),
            ("damping_ratio", damping_ratio, (0.0..=1_000.0).contains(&damping_ratio), "from 0 to 1000"),
        ] {
            if !is_within {
                return Err(RitzError::Number { file: file.to_owned(), key, value, range });
            }
        }
        Ok(Self { youngs_modulus_pa, poissons_ratio, density_kg_per_m3, damping_ratio })
    }
}

/// A mode of a body.
#[derive(Clone, Debug)]
pub struct RitzMode {
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Modal mass, kg, where the most moved point of the surface has the displacement 1.
    pub mass_kg: f64,
    /// Part of the mode by mass that a quadratic field holds.
    pub share: f64,
    /// That field on `1 x y z xx xy xz yy yz zz` of `(X − centre)/half`; the most moved point has the displacement 1.
    pub poly: [DVec3; 10],
}

/// The first modes of a body.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Modes that a field holds, in the order of their frequency.
    pub held: Vec<RitzMode>,
    /// Modes before the last of them that no field holds: frequency, Hz, and share.
    pub left_out: Vec<[f64; 2]>,
    /// The body's mass, kg.
    pub mass_kg: f64,
    centre: DVec3,
    half: f64,
}

impl Modes {
    /// The first `count` modes of a body that a quadratic field holds; `held` names faces that do not move.
    ///
    /// # Errors
    /// A body that has no modes, an unknown face.
    pub fn new(
        model: &Model,
        body: &BakedBody,
        material: &Material,
        count: usize,
        held: &[String],
    ) -> Result<Self, RitzError> {
        let name = || model.name.clone();
        if !(1..=MAX_MODES).contains(&count) {
            return Err(RitzError::Count { count });
        }
        if !body.topology.is_closed() {
            let edges = body.topology.edges.iter().filter(|edge| edge.partner.is_none()).count();
            return Err(RitzError::Open { model: name(), edges });
        }
        let labels: Vec<_> = (0..model.patches.len()).map(|index| model.patch_label(index)).collect();
        let find = |held: &String| {
            labels.iter().position(|label| label == held).ok_or_else(|| RitzError::Face {
                name: held.clone(),
                model: name(),
                faces: labels.join(", "),
            })
        };
        let held: Vec<_> = held.iter().map(find).collect::<Result<_, _>>()?;
        let patches = &model.patches;
        let frame = Frame::of(patches);
        let problem = Problem::new(patches, &frame, material, &held);
        let modes = problem.solve(patches, &frame).ok_or_else(|| RitzError::Singular { model: name() })?;
        let (mut kept, mut left_out) = (Vec::new(), Vec::new());
        for mode in modes {
            if kept.len() == count {
                break;
            }
            if mode.share >= MIN_SHARE {
                kept.push(mode);
            } else {
                left_out.push([mode.frequency_hz, mode.share]);
            }
        }
        let Some(last) = kept.last() else { return Err(RitzError::NoShape { model: name() }) };
        left_out.retain(|[frequency, _]| *frequency < last.frequency_hz);
        let half = frame.half.max_element();
        let mass_kg = material.density_kg_per_m3 * problem.volume * frame.half.element_product();
        Ok(Self { held: kept, left_out, mass_kg, centre: frame.centre + model.centre, half })
    }

    /// The modes file: as `closest --modes` reads it, with the budget of `q` that keeps space from folding.
    ///
    /// # Errors
    /// A bug: modes that the reader refuses.
    pub fn file(&self, model: &Model, model_file: &str, material: &Material) -> Result<String, RitzError> {
        let trial = self.text(model_file, material, 1.0);
        let stretch: f64 =
            modes::parse(&trial, "the modes", model)?.iter().map(|mode| f64::from(mode.bounds.stretch)).sum();
        let budget = (MAX_STRETCH / stretch).min(MAX_SIZES * 2.0 * self.half);
        // Three digits, rounded down.
        let unit = 10.0_f64.powf(budget.log10().floor() - 2.0);
        Ok(self.text(model_file, material, (budget / unit).floor() * unit))
    }

    fn text(&self, model_file: &str, material: &Material, budget: f64) -> String {
        let Material { youngs_modulus_pa, poissons_ratio, density_kg_per_m3, damping_ratio } = *material;
        let mut text = format!(
            "# Modes of {model_file}, by palpate bake --soft: {youngs_modulus_pa} Pa, Poisson's ratio {poissons_ratio}, \
             {density_kg_per_m3} kg/m³. Metres per metre of q.\nmodel = {model_file:?}\nbudget = {budget:.8} # metres, |q| \
             of each\n"
        );
        for (index, RitzMode { frequency_hz, mass_kg, share, poly }) in self.held.iter().enumerate() {
            let [x, y, z] = self.centre.to_array();
            // Nine digits: more are rounding, and not the same on every machine.
            let short = |value: f64| (value * 1e9).round() / 1e9 + 0.0;
            let rows: Vec<_> = poly.iter().map(|entry| format!("{:?}", entry.to_array().map(short))).collect();
            // Writing to a string does not fail.
            let _ = write!(
                text,
                "\n[[mode]]\nname = \"mode {index}\"\nfrequency = {frequency_hz:.6} # Hz\nmass = {mass_kg:.9} # kg\n\
                 damping = {damping_ratio} # ratio\nshare = {share:.4} # of the mode, by mass\n\
                 centre = [{x:?}, {y:?}, {z:?}]\nhalf = {:?}\npoly = [{}]\n",
                self.half,
                rows.join(", "),
            );
        }
        text
    }
}

/// The box around the body, in which coordinates run from -1 to 1.
struct Frame {
    centre: DVec3,
    half: DVec3,
}

impl Frame {
    fn of(patches: &[NurbsPatch]) -> Self {
        let (low, high) = crate::topology::bounding_box(patches);
        Self { centre: 0.5 * (low + high), half: 0.5 * (high - low) }
    }
}

/// Exponents of the monomials up to a degree, in its order: those of degree 2 come first.
fn monomials(degree: usize) -> Vec<[usize; 3]> {
    let of =
        |total: usize| (0..=total).rev().flat_map(move |a| (0..=total - a).rev().map(move |b| [a, b, total - a - b]));
    (0..=degree).flat_map(of).collect()
}

/// Integrals of monomials up to twice the degree, by their exponents.
struct Moments(Vec<f64>);

const SIDE: usize = 2 * DEGREE + 1;

impl Moments {
    fn new() -> Self {
        Self(vec![0.0; SIDE * SIDE * SIDE])
    }

    fn at(&self, [a, b, c]: [usize; 3]) -> f64 {
        self.0[(a * SIDE + b) * SIDE + c]
    }

    /// Adds `weight · xᵃ yᵇ zᶜ`, with `along` for each power of x.
    fn add(&mut self, along: &[f64; SIDE], at: DVec3, weight: f64) {
        let (y, z) = (powers(at.y), powers(at.z));
        for (a, x) in along.iter().enumerate() {
            for (b, y) in y.iter().enumerate().take(SIDE - a) {
                let row = (a * SIDE + b) * SIDE;
                let part = weight * x * y;
                for (sum, z) in self.0[row..row + SIDE - a - b].iter_mut().zip(&z) {
                    *sum += part * z;
                }
            }
        }
    }
}

fn powers(x: f64) -> [f64; SIDE] {
    let mut power = 1.0;
    core::array::from_fn(|_| {
        let now = power;
        power *= x;
        now
    })
}

/// Points and weights of Gauss on `[0, 1]`, by Newton's method on Legendre's polynomial.
fn gauss(count: usize) -> Vec<[f64; 2]> {
    let legendre = |x: f64| {
        let (mut last, mut now) = (1.0, x);
        for k in 2..=count {
            let k = k as f64;
            (last, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * last) / k);
        }
        (now, count as f64 * (x * now - last) / (x * x - 1.0))
    };
    let point = |index: usize| {
        let mut x = (std::f64::consts::PI * (index as f64 + 0.75) / (count as f64 + 0.5)).cos();
        for _ in 0..8 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let slope = legendre(x).1;
        [0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..count).map(point).collect()
}

/// Points along each side of a span: exact for moments of the degree 12 of patches of degree 2, and for those of degree
/// 5 and rational ones to some 1e-9.
const POINTS: usize = 20;

/// Calls with each point of a patch in the box's coordinates and its area vector, in these coordinates and in metres.
fn over(patch: &NurbsPatch, frame: &Frame, mut each: impl FnMut(DVec3, DVec3, f64)) {
    let rule = gauss(POINTS);
    let nodes = |axis| {
        let on_span = |pair: &[f64]| {
            let (start, width) = (pair[0], pair[1] - pair[0]);
            rule.iter().map(|[at, weight]| [start + width * at, width * weight]).collect::<Vec<_>>()
        };
        patch.borders(axis).windows(2).flat_map(on_span).collect::<Vec<_>>()
    };
    let (along_u, along_v) = (nodes(Axis::U), nodes(Axis::V));
    let sign = if patch.flip { -1.0 } else { 1.0 };
    for [u, of_u] in along_u {
        for [v, of_v] in &along_v {
            let jet = Jet::of(patch, u, *v);
            let weight = of_u * of_v;
            let (a, b) = (jet.tangent_u / frame.half, jet.tangent_v / frame.half);
            let area = jet.tangent_u.cross(jet.tangent_v).length() * weight;
            each((jet.point - frame.centre) / frame.half, a.cross(b) * (sign * weight), area);
        }
    }
}

/// The matrices of the problem, in the box's coordinates: three components of each monomial.
struct Problem {
    mass: Matrix,
    stiffness: Matrix,
    /// Of the box's coordinates.
    volume: f64,
    /// `E/(ρ size²)`, 1/s².
    scale: f64,
    basis: Vec<[usize; 3]>,
    is_held: bool,
}

impl Problem {
    fn new(patches: &[NurbsPatch], frame: &Frame, material: &Material, held: &[usize]) -> Self {
        let Material { youngs_modulus_pa: young, poissons_ratio: nu, density_kg_per_m3: density, .. } = *material;
        let mut volume = Moments::new();
        let mut surface = Moments::new();
        for (index, patch) in patches.iter().enumerate() {
            let is_held = held.contains(&index);
            over(patch, frame, |at, area, square_metres| {
                // ∫ xᵃ … dV = ∮ xᵃ⁺¹/(a + 1) … n_x dA.
                let along = powers(at.x);
                let raised = core::array::from_fn(|a| along[a] * at.x / (a + 1) as f64);
                volume.add(&raised, at, area.x);
                if is_held {
                    surface.add(&along, at, square_metres);
                }
            });
        }
        let basis = monomials(DEGREE);
        let count = basis.len();
        let (lambda, mu) = (young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), young / (2.0 * (1.0 + nu)));
        let cell = frame.half.element_product();
        let (mut mass, mut stiffness) = (Matrix::new(3 * count), Matrix::new(3 * count));
        /// Stiffness of a held face by area, in Young's moduli by size: a face moves by 1e-5 of what a body would.
        const HOLD: f64 = 1e5;
        let hold = HOLD * young / (2.0 * frame.half.max_element());
        for (row, a) in basis.iter().enumerate() {
            for (column, b) in basis.iter().enumerate() {
                let both = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
                // ∫ ∂_k φ_a ∂_l φ_b dV.
                let slope = |k: usize, l: usize| {
                    if a[k] == 0 || b[l] == 0 {
                        return 0.0;
                    }
                    let mut powers = both;
                    powers[k] -= 1;
                    powers[l] -= 1;
                    (a[k] * b[l]) as f64 / (frame.half[k] * frame.half[l]) * volume.at(powers) * cell
                };
                let same = (0..3).map(|k| slope(k, k)).sum::<f64>();
                for i in 0..3 {
                    for j in 0..3 {
                        let place = (3 * row + i, 3 * column + j);
                        stiffness[place] = lambda * slope(i, j) + mu * slope(j, i);
                        if i == j {
                            stiffness[place] += mu * same;
                            mass[place] = density * volume.at(both) * cell;
                            if !held.is_empty() {
                                stiffness[place] += hold * surface.at(both);
                            }
                        }
                    }
                }
            }
        }
        let size = 2.0 * frame.half.max_element();
        let scale = young / (density * size * size);
        Self { mass, stiffness, volume: volume.at([0; 3]), scale, basis, is_held: !held.is_empty() }
    }

    /// The modes in the order of their frequency, without those of the rigid body; `None` where a matrix is singular.
    fn solve(&self, patches: &[NurbsPatch], frame: &Frame) -> Option<Vec<RitzMode>> {
        /// Below, in units of `E/(ρ size²)`, a mode is one of the rigid body, with its rounding.
        const RIGID: f64 = 1e-6;
        let rigid = if self.is_held { 0 } else { 6 };
        let found = lowest(&self.stiffness, &self.mass, LOOKED_AT + rigid, 1e-2 * self.scale)?;
        let quadratic = self.mass.corner(30).cholesky(SINGULAR)?;
        let samples = samples(patches, frame);
        let modes = found.into_iter().filter(|(value, _)| *value > RIGID * self.scale);
        let mode = |(value, vector): (f64, Vec<f64>)| {
            let moved = self.mass.times(&vector);
            let held = quadratic.solve(moved[..30].to_vec());
            let share = held.iter().zip(&moved).map(|(held, moved)| held * moved).sum::<f64>()
                / vector.iter().zip(&moved).map(|(a, b)| a * b).sum::<f64>();
            let most = |of: &[f64]| {
                let at = |point: &DVec3| displacement(&self.basis, of, *point).length_squared();
                samples.iter().map(at).fold(0.0, f64::max).sqrt()
            };
            let (most_whole, most_held) = (most(&vector), most(&held));
            let mass_kg = vector.iter().zip(&moved).map(|(a, b)| a * b).sum::<f64>() / (most_whole * most_whole);
            RitzMode {
                frequency_hz: value.sqrt() / std::f64::consts::TAU,
                mass_kg,
                share,
                poly: self.poly(&held, frame, most_held),
            }
        };
        Some(modes.map(mode).collect())
    }

    /// In one unit of length along all axes.
    fn poly(&self, held: &[f64], frame: &Frame, most: f64) -> [DVec3; 10] {
        let ratio = DVec3::splat(frame.half.max_element()) / frame.half;
        core::array::from_fn(|index| {
            let [a, b, c] = self.basis[index].map(|power| power as i32);
            let factor = ratio.x.powi(a) * ratio.y.powi(b) * ratio.z.powi(c) / most;
            DVec3::new(held[3 * index], held[3 * index + 1], held[3 * index + 2]) * factor
        })
    }
}

fn displacement(basis: &[[usize; 3]], of: &[f64], at: DVec3) -> DVec3 {
    let (x, y, z) = (powers(at.x), powers(at.y), powers(at.z));
    let each = basis.iter().zip(of.chunks_exact(3));
    each.map(|([a, b, c], of)| DVec3::new(of[0], of[1], of[2]) * (x[*a] * y[*b] * z[*c])).sum()
}

/// Points of the surface in the box's coordinates, 16 to a span and its borders.
fn samples(patches: &[NurbsPatch], frame: &Frame) -> Vec<DVec3> {
    let mut points = Vec::new();
    for patch in patches {
        patch.for_each_sample(16, |_, surface| {
            points.push((surface.point - frame.centre) / frame.half);
            true
        });
    }
    points
}
