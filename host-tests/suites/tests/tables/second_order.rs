//! What the certificate of the law of second order rests on (theory §12): the bounds of third derivatives and jumps
//! against samples, and the lemma itself, on random patches, in double precision and straight from the tables.

use crate::random_patches::{Random, for_each_patch, table_surface};
use glam::DVec3;
use palpate::patch::{ThirdDerivativeBounds, span_centre};
use palpate_bake::BakedPatch;
use palpate_truth::oracle::OraclePoint;
use std::error::Error;

/// A patch as its table has it, at parameters of one span, its borders included.
pub struct Table<'a>(pub &'a BakedPatch);

impl Table<'_> {
    fn border(&self, axis: usize, index: usize) -> f64 {
        f64::from(self.0.breaks[axis][index])
    }

    fn spans(&self, axis: usize) -> usize {
        self.0.breaks[axis].len() - 1
    }

    /// The first span that holds a parameter.
    fn span(&self, axis: usize, at: f64) -> usize {
        (0..self.spans(axis) - 1).find(|span| at <= self.border(axis, span + 1)).unwrap_or(self.spans(axis) - 1)
    }

    fn of_span(&self, span: [usize; 2], at: [f64; 2]) -> OraclePoint {
        let local = |axis: usize| {
            let [left, right] = [0, 1].map(|end| self.0.breaks[axis][span[axis] + end]);
            at[axis] - f64::from(span_centre(left, right))
        };
        table_surface(self.0, span, local(0), local(1))
    }

    pub fn at(&self, at: [f64; 2]) -> OraclePoint {
        self.of_span([0, 1].map(|axis| self.span(axis, at[axis])), at)
    }
}

fn seconds(surface: &OraclePoint) -> [DVec3; 3] {
    [surface.second_uu, surface.second_uv, surface.second_vv]
}

#[test]
fn the_bounds_of_third_derivatives_and_jumps_hold_and_are_tight() -> Result<(), Box<dyn Error>> {
    const INTERVALS: usize = 12;
    let (mut loosest, mut loosest_jump) = (1.0_f64, 1.0_f64);
    for_each_patch(6, |_, patch| {
        let baked = BakedPatch::without_shape(patch)?;
        let (table, bounds) = (Table(&baked), baked.shape.third_derivatives);
        let (mut sampled, mut jumps) = ([0.0_f64; 4], [0.0_f64; 2]);
        for i in 0..table.spans(0) {
            for j in 0..table.spans(1) {
                let range =
                    [[table.border(0, i), table.border(0, i + 1)], [table.border(1, j), table.border(1, j + 1)]];
                let place = |axis: usize, step: usize| {
                    let [low, high] = range[axis];
                    low + (high - low) * step as f64 / INTERVALS as f64
                };
                for k in 0..=INTERVALS {
                    for l in 0..=INTERVALS {
                        let at = [place(0, k), place(1, l)];
                        // Polynomials go on beyond their span: a difference needs no room. The best step for doubles is
                        // about the cube root of their spacing, in parts of the span.
                        let along = |axis: usize| {
                            let step = 1e-5 * (range[axis][1] - range[axis][0]);
                            let moved = |sign: f64| {
                                let mut at = at;
                                at[axis] += sign * step;
                                seconds(&table.of_span([i, j], at))
                            };
                            let (ahead, behind) = (moved(1.0), moved(-1.0));
                            [0, 1, 2].map(|kind| ((ahead[kind] - behind[kind]) / (2.0 * step)).length())
                        };
                        let ([uuu, uuv, uvv], [.., vvv]) = (along(0), along(1));
                        for (most, found) in sampled.iter_mut().zip([uuu, uuv, uvv, vvv]) {
                            *most = most.max(found);
                        }
                        // The other span at the border before this one.
                        if k == 0 && i > 0 {
                            let other = seconds(&table.of_span([i - 1, j], at));
                            jumps[0] = jumps[0].max(other[0].distance(seconds(&table.of_span([i, j], at))[0]));
                        }
                        if l == 0 && j > 0 {
                            let other = seconds(&table.of_span([i, j - 1], at));
                            jumps[1] = jumps[1].max(other[2].distance(seconds(&table.of_span([i, j], at))[2]));
                        }
                    }
                }
            }
        }
        let proved = [bounds.uuu, bounds.uuv, bounds.uvv, bounds.vvv].map(f64::from);
        let scale = proved.into_iter().fold(0.0, f64::max);
        for (kind, (bound, sampled)) in proved.into_iter().zip(sampled).enumerate() {
            // The differences are good to six digits.
            assert!(
                bound >= sampled * (1.0 - 1e-5) - 1e-7 * scale,
                "degree {:?}, kind {kind}: {bound} below {sampled}",
                patch.degree
            );
            if sampled > 1e-3 * scale {
                loosest = loosest.max(bound / sampled);
            }
        }
        for (bound, sampled) in [bounds.jump_uu, bounds.jump_vv].map(f64::from).into_iter().zip(jumps) {
            assert!(bound >= sampled, "degree {:?}: a jump of {sampled} above the bound {bound}", patch.degree);
            if bound.is_finite() && sampled > 1e-2 * f64::from(baked.shape.second_derivatives.uu) {
                loosest_jump = loosest_jump.max(bound / sampled);
            }
        }
        Ok(())
    })?;
    println!("bound over the largest sample: third derivatives up to {loosest:.3}, jumps up to {loosest_jump:.3}");
    // 5 % slack, and what 12 intervals a span miss of a peak. How tight a jump's bound is, is printed: it has to hold.
    assert!(loosest <= 1.2, "{loosest}");
    Ok(())
}

/// Sum of the squares of how far a step goes beyond the knots of one parameter, the one it starts on included where it
/// goes to the lower span.
fn beyond(table: &Table, axis: usize, from: f64, to: f64) -> f64 {
    let knots = (1..table.spans(axis)).map(|index| table.border(axis, index));
    let crossed = knots.filter(|knot| (from <= *knot && *knot < to) || (to < *knot && *knot <= from));
    crossed.map(|knot| (to - knot) * (to - knot)).sum()
}

/// A step and a probe.
pub struct Step {
    pub from: [f64; 2],
    pub to: [f64; 2],
    pub probe: DVec3,
}

impl Step {
    /// A tenth of the starts on a border or a knot.
    pub fn random(random: &mut Random, table: &Table, at: impl Fn([f64; 2]) -> OraclePoint) -> Self {
        let mut parameter = |axis: usize| match random.below(10) {
            0 => table.border(axis, random.below(table.spans(axis) + 1)),
            _ => random.between(0.0, 1.0),
        };
        let from = [parameter(0), parameter(1)];
        let reach = 10.0_f64.powf(random.between(-3.0, 0.0));
        let to = from.map(|at| (at + reach * random.between(-1.0, 1.0)).clamp(0.0, 1.0));
        let mut coordinate = || random.between(-1.0, 1.0);
        let away = DVec3::new(coordinate(), coordinate(), coordinate());
        let probe = at(from).point + away * (f64::from(table.0.size) * 10.0_f64.powf(random.between(-4.0, 0.5)));
        Self { from, to, probe }
    }

    /// For a part of the step: how far `R (‖f − Q‖ − R)` is below the lemma's bound, rounding included, m²; and whether
    /// knots are crossed.
    pub fn margin(
        &self,
        table: &Table,
        at: impl Fn([f64; 2]) -> OraclePoint,
        bounds: &ThirdDerivativeBounds,
        share: f64,
    ) -> (f64, bool) {
        let Self { from, to, probe } = *self;
        let [uuu, uuv, uvv, vvv] = [bounds.uuu, bounds.uuv, bounds.uvv, bounds.vvv].map(f64::from);
        let size = f64::from(table.0.size);
        let here = at(from);
        let [w, z] = [to[0] - from[0], to[1] - from[1]];
        let difference = here.point - probe;
        let distance = difference.length();
        let way = here.tangent_u * w + here.tangent_v * z;
        let bend = here.second_uu * (w * w) + here.second_uv * (2.0 * w * z) + here.second_vv * (z * z);
        let (x, y) = (w.abs(), z.abs());
        let twist = uuu * x * x * x + 3.0 * uuv * x * x * y + 3.0 * uvv * x * y * y + vvv * y * y * y;
        let reached = [from[0] + share * w, from[1] + share * z];
        let [over_u, over_v] = [0, 1].map(|axis| beyond(table, axis, from[axis], reached[axis]));
        let jump = |over: f64, bound: f32| if over > 0.0 { over * f64::from(bound) } else { 0.0 };
        let jumps = jump(over_u, bounds.jump_uu) + jump(over_v, bounds.jump_vv);
        let t = share;
        let bound = difference.dot(way) * t
            + 0.5 * (way.length_squared() + difference.dot(bend)) * t * t
            + 0.5 * distance * jumps
            + (3.0 * way.dot(bend) + distance * twist) * t * t * t / 6.0
            + bend.length_squared() * t * t * t * t / 8.0;
        let change = distance * (at(reached).point.distance(probe) - distance);
        // The stored numbers are rounded: spans meet, and are smooth there, to a few parts in 10⁷ of coordinates up to
        // the size.
        let crosses = over_u + over_v > 0.0;
        let rounding = 2e-6 * size * distance * if crosses { 1.0 } else { 1e-9 };
        (bound + rounding + 1e-12 * distance * distance - change, crosses)
    }
}

#[test]
fn the_certificate_bounds_every_step_between_all_spans() -> Result<(), Box<dyn Error>> {
    let (mut checked, mut crossings) = (0_u64, 0_u64);
    for_each_patch(6, |random: &mut Random, patch| {
        let baked = BakedPatch::without_shape(patch)?;
        let table = Table(&baked);
        for _ in 0..400 {
            let step = Step::random(random, &table, |at| table.at(at));
            for share in [1.0, 0.5, 0.1] {
                let (margin, crosses) = step.margin(&table, |at| table.at(at), &baked.shape.third_derivatives, share);
                let Step { from, to, .. } = step;
                assert!(margin >= 0.0, "degree {:?}, {from:?} to {to:?}: {margin:e} short", patch.degree);
                checked += 1;
                crossings += u64::from(crosses);
            }
        }
        Ok(())
    })?;
    println!("{checked} steps, {crossings} of them across knots");
    assert!(crossings > checked / 20, "{crossings} of {checked}");
    Ok(())
}
