//! The fundamental forms of a patch on a cell of its parameters, as polynomials, and what they bound there.
//!
//! With `f = A / w` and the cell's own parameters over the unit square, all of these are polynomials:
//! - `e, f, g`: the first fundamental form times `w⁴`, from the tangents `(A_x w − A w_x) / w²`;
//! - `b_xy = det(f_u, f_v, f_xy) w⁴`, up to sign the determinant of the four homogeneous vectors `Ã, Ã_u, Ã_v, Ã_xy`:
//!   the second fundamental form times `w⁴ √d / w⁴`, where `d = e g − f²`. Products are formed before anything is
//!   bounded, so a straight direction gives a coefficient of zero and not a difference of intervals.
//!
//! For a symmetric form `m`, the eigenvalues relative to `I` are those of the matrix `L⁻¹ m L⁻ᵀ` with `I = L Lᵀ`:
//! `[m₁₁ w⁴/e, (e m₁₂ − f m₁₁) w⁴/(e √d), (f² m₁₁ − 2 e f m₁₂ + e² m₂₂) w⁴/(e d)]`.

use super::bernstein::Bernstein;
use super::form::{Form, eigenvalues, symmetric};
use crate::bernstein::Tracked;
use palpate::patch::SecondDerivativeBounds;

/// Lower and upper bounds, or the minimum and maximum of sampled values, over a part of the patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extremes {
    /// Principal curvatures with respect to `f_u × f_v` turned round, 1/m: positive where the surface bends away from
    /// it.
    pub curvature: [f64; 2],
    /// Eigenvalues of the first fundamental form, m².
    pub stretch: [f64; 2],
    /// The maximum bend, 1/m.
    pub bend: f64,
}

/// The fundamental forms on a cell.
#[derive(Clone, Debug)]
pub(super) struct FormCell {
    /// `e, f, g, b₁₁, b₁₂, b₂₂, w` in one degree.
    field: Bernstein<7>,
    /// Rounding error of each.
    errors: [f64; 7],
    /// Widths of the span: the unit square's parameters times these are the patch's.
    widths: [f64; 2],
    pub halvings: usize,
}

impl FormCell {
    /// The whole of a span; `None` if a weight is not positive.
    pub(super) fn of_span(degree: [usize; 2], powers: &[[f64; 4]], ranges: [[f64; 2]; 2]) -> Option<Self> {
        let homogeneous = Tracked::of_span(degree, powers, ranges);
        let weight = &homogeneous[3];
        if weight.polynomial.coefficients.iter().any(|[w]| w.is_nan() || *w <= weight.error) {
            return None;
        }
        let is_polynomial = weight.polynomial.coefficients.iter().all(|w| *w == [1.0]);
        let along = |axis: usize| homogeneous.each_ref().map(|component| component.derivative(axis));
        let (first_u, first_v) = (along(0), along(1));
        let second = |first: &[Tracked; 4], axis: usize| first.each_ref().map(|component| component.derivative(axis));
        let seconds = [second(&first_u, 0), second(&first_u, 1), second(&first_v, 1)];
        let one = Tracked::constant(1.0);
        let tangent = |first: &[Tracked; 4]| -> [Tracked; 3] {
            std::array::from_fn(|c| {
                if is_polynomial {
                    first[c].clone()
                } else {
                    first[c].times(weight).plus(-1.0, &homogeneous[c].times(&first[3]))
                }
            })
        };
        let (tangent_u, tangent_v) = (tangent(&first_u), tangent(&first_v));
        let normal = if is_polynomial {
            let minor = |a: usize, b: usize| minor_2([&first_u, &first_v], [a, b]);
            [minor(1, 2), minor(2, 0), minor(0, 1), Tracked::constant(0.0)]
        } else {
            let minor = |columns: [usize; 3]| minor_3([&homogeneous, &first_u, &first_v], columns);
            let turned = |columns: [usize; 3]| Tracked::constant(0.0).plus(-1.0, &minor(columns));
            [minor([1, 2, 3]), turned([0, 2, 3]), minor([0, 1, 3]), turned([0, 1, 2])]
        };
        let bending = seconds.each_ref().map(|second| dot(&normal, second));
        let [b_uu, b_uv, b_vv] = bending;
        let stretch = [dot(&tangent_u, &tangent_u), dot(&tangent_u, &tangent_v), dot(&tangent_v, &tangent_v)];
        let [e, f, g] = stretch;
        let weight = if is_polynomial { one } else { weight.clone() };
        let entries = [e, f, g, b_uu, b_uv, b_vv, weight];
        let common =
            [0, 1].map(|axis| entries.iter().map(|entry| entry.polynomial.degree[axis]).max().unwrap_or_default());
        let entries = entries.map(|entry| entry.raised(common));
        let count = entries[0].polynomial.coefficients.len();
        let coefficients =
            (0..count).map(|index| entries.each_ref().map(|entry| entry.polynomial.coefficients[index][0])).collect();
        Some(Self {
            field: Bernstein { degree: common, coefficients },
            errors: entries.map(|entry| entry.error),
            widths: ranges.map(|[low, high]| high - low),
            halvings: 0,
        })
    }

    /// Both halves, along `u` and `v` in turn.
    pub(super) fn halves(&self) -> [Self; 2] {
        let axis = self.halvings % 2;
        // An average rounds once, and there are as many rounds as degrees.
        let rounds = self.field.degree[axis] as f64;
        let errors = std::array::from_fn(|c| self.errors[c] + rounds * f64::EPSILON * largest(&self.field, c));
        let halvings = self.halvings + 1;
        self.field.halves(axis).map(|field| Self { field, errors, widths: self.widths, halvings })
    }

    /// Enclosures of the seven functions.
    fn forms(&self) -> [Form; 7] {
        let [p, q] = self.field.degree;
        let corner = |i: usize, j: usize| self.field.at(i, j);
        let (low, low_high, high_low, high) = (corner(0, 0), corner(0, q), corner(p, 0), corner(p, q));
        let place = |k: usize, degree: usize| if degree == 0 { 0.0 } else { 2.0 * k as f64 / degree as f64 - 1.0 };
        std::array::from_fn(|c| {
            // Any line would do; the one through the corners is near the best.
            let slope = [
                0.25 * (high[c] + high_low[c] - low[c] - low_high[c]),
                0.25 * (high[c] + low_high[c] - low[c] - high_low[c]),
            ];
            let mut rest = [f64::INFINITY, f64::NEG_INFINITY];
            for i in 0..=p {
                for j in 0..=q {
                    let off = corner(i, j)[c] - slope[0] * place(i, p) - slope[1] * place(j, q);
                    rest = [rest[0].min(off), rest[1].max(off)];
                }
            }
            let rounding = 16.0 * f64::EPSILON * largest(&self.field, c);
            let radius = 0.5 * (rest[1] - rest[0]) + self.errors[c] + rounding;
            Form { centre: 0.5 * (rest[0] + rest[1]), slope, radius }
        })
    }

    /// Bounds over the cell: of the stretch always, of curvature and bend where the tangents are proved to span a
    /// plane.
    pub(super) fn bounds(&self, derivatives: &SecondDerivativeBounds) -> (Extremes, bool) {
        let [e, f, g, b_uu, b_uv, b_vv, w] = self.forms();
        let mut extremes = Extremes {
            curvature: [f64::NEG_INFINITY, f64::INFINITY],
            stretch: [0.0, f64::INFINITY],
            bend: f64::INFINITY,
        };
        let squared = w.times(&w);
        let fourth = squared.times(&squared);
        let Some(weights) = fourth.reciprocal() else { return (extremes, false) };
        let [width_u, width_v] = self.widths;
        let scaled = |entry: &Form, area: f64| entry.times(&weights).scaled(1.0 / area);
        let metric = [scaled(&e, width_u * width_u), scaled(&f, width_u * width_v), scaled(&g, width_v * width_v)];
        let [least, greatest] = eigenvalues(&metric);
        extremes.stretch = [least.max(0.0), greatest];
        let d = e.times(&g).plus(-1.0, &f.times(&f));
        let (Some(e_inverse), Some(root)) = (e.reciprocal(), d.root()) else { return (extremes, false) };
        let Some(root_inverse) = root.reciprocal() else { return (extremes, false) };
        let relative = |m: &[Form; 3]| {
            let scale = fourth.times(&e_inverse);
            let mixed = e.times(&m[1]).plus(-1.0, &f.times(&m[0]));
            let last =
                f.times(&f).times(&m[0]).plus(-2.0, &e.times(&f).times(&m[1])).plus(1.0, &e.times(&e).times(&m[2]));
            [
                m[0].times(&scale),
                mixed.times(&scale).times(&root_inverse),
                last.times(&scale).times(&root_inverse).times(&root_inverse),
            ]
        };
        let [least, greatest] = eigenvalues(&relative(&[b_uu, b_uv, b_vv].map(|b| b.times(&root_inverse))));
        extremes.curvature = [-greatest, -least];
        let [uu, uv, vv] = self.in_unit_square(derivatives);
        let bend = |uv: f64| eigenvalues(&relative(&[uu, uv, vv].map(Form::constant)))[1];
        extremes.bend = bend(uv).max(bend(-uv));
        (extremes, true)
    }

    /// The bounds of the second derivatives by the unit square's parameters, rounded up.
    fn in_unit_square(&self, derivatives: &SecondDerivativeBounds) -> [f64; 3] {
        let [width_u, width_v] = self.widths;
        let up = 1.0 + 4.0 * f64::EPSILON;
        [
            f64::from(derivatives.uu) * width_u * width_u * up,
            f64::from(derivatives.uv) * width_u * width_v * up,
            f64::from(derivatives.vv) * width_v * width_v * up,
        ]
    }

    /// The values at the four corners; those at which the tangents span no plane have no curvature.
    pub(super) fn samples(&self, derivatives: &SecondDerivativeBounds) -> impl Iterator<Item = Extremes> {
        let [p, q] = self.field.degree;
        let [uu, uv, vv] = self.in_unit_square(derivatives);
        [(0, 0), (0, q), (p, 0), (p, q)].into_iter().map(move |(i, j)| {
            let [e, f, g, b_uu, b_uv, b_vv, w] = *self.field.at(i, j);
            let [width_u, width_v] = self.widths;
            let fourth = w * w * w * w;
            let metric = [e / (width_u * width_u), f / (width_u * width_v), g / (width_v * width_v)];
            let d = e * g - f * f;
            let root = d.sqrt();
            let relative = |m: [f64; 3]| {
                let last = (f * f * m[0] - 2.0 * e * f * m[1] + e * e * m[2]) / d;
                symmetric([m[0], (e * m[1] - f * m[0]) / root, last].map(|entry| entry * fourth / e))
            };
            let [least, greatest] = relative([b_uu, b_uv, b_vv].map(|b| b / root));
            let bend = relative([uu, uv, vv])[1].max(relative([uu, -uv, vv])[1]);
            Extremes { curvature: [-greatest, -least], stretch: symmetric(metric.map(|entry| entry / fourth)), bend }
        })
    }
}

fn largest(field: &Bernstein<7>, component: usize) -> f64 {
    field.coefficients.iter().map(|entry| entry[component].abs()).fold(0.0, f64::max)
}

fn dot<const N: usize>(a: &[Tracked; N], b: &[Tracked; N]) -> Tracked {
    let terms = a.iter().zip(b).filter(|(a, b)| !a.is_zero() && !b.is_zero());
    terms.fold(Tracked::constant(0.0), |sum, (a, b)| sum.plus(1.0, &a.times(b)))
}

fn minor_2(rows: [&[Tracked; 4]; 2], [a, b]: [usize; 2]) -> Tracked {
    rows[0][a].times(&rows[1][b]).plus(-1.0, &rows[0][b].times(&rows[1][a]))
}

fn minor_3(rows: [&[Tracked; 4]; 3], [a, b, c]: [usize; 3]) -> Tracked {
    let below = |columns| minor_2([rows[1], rows[2]], columns);
    let first = rows[0][a].times(&below([b, c])).plus(-1.0, &rows[0][b].times(&below([a, c])));
    first.plus(1.0, &rows[0][c].times(&below([a, b])))
}
