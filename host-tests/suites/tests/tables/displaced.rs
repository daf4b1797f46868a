//! The certificate of a displaced patch (theory §15): its bounds against samples, and the lemma of §12 by them, on random
//! patches and modes.
//!
//! A tenth of `PALPATE_STEPS` steps are taken, 10⁷ in the long mode; without the variable 50,000.

use crate::random_patches::{Random, for_each_patch};
use crate::second_order::{Step, Table};
use glam::DVec3;
use palpate::field::{Displacement as _, Field};
use palpate_bake::{BakedPatch, Model, NurbsPatch, Unit, modes};
use palpate_truth::oracle::OraclePoint;
use std::error::Error;

/// Modes of a patch.
const MODES: usize = 4;

/// A mode by its definition, on `r = (X − centre)/half`.
struct Truth {
    centre: DVec3,
    half: f64,
    poly: [DVec3; 10],
    bump: DVec3,
    at: DVec3,
    radius: f64,
}

/// A power series in one variable up to its square.
type Series = [f64; 3];

fn product(a: Series, b: Series) -> Series {
    [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[1] * b[1] + a[2] * b[0]]
}

impl Truth {
    fn random(random: &mut Random, patch: &NurbsPatch) -> Self {
        let half = 0.5 * patch.size();
        let centre = patch.points[patch.points.len() / 2];
        let mut vector = || DVec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0)));
        let poly = [0; 10].map(|_| vector());
        let (at, bump) = (centre + half * vector(), vector());
        Self { centre, half, poly, bump, at, radius: half * random.between(0.5, 1.5) }
    }

    fn toml(&self) -> String {
        let vector = |v: DVec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        format!(
            "[[mode]]\ncentre = {}\nhalf = {:?}\npoly = [{}]\nbump = {}\nat = {}\nradius = {:?}\n",
            vector(self.centre),
            self.half,
            self.poly.map(vector).join(", "),
            vector(self.bump),
            vector(self.at),
            self.radius
        )
    }

    /// The displacement along a curve of space, as a series.
    fn along(&self, curve: [DVec3; 3]) -> [DVec3; 3] {
        let component = |axis: usize, origin: DVec3, scale: f64| -> Series {
            let at = [curve[0] - origin, curve[1], curve[2]];
            at.map(|entry| entry[axis] / scale)
        };
        let [x, y, z] = [0, 1, 2].map(|axis| component(axis, self.centre, self.half));
        let monomials = [
            [1.0, 0.0, 0.0],
            x,
            y,
            z,
            product(x, x),
            product(x, y),
            product(x, z),
            product(y, y),
            product(y, z),
            product(z, z),
        ];
        let offset = [0, 1, 2].map(|axis| component(axis, self.at, self.radius));
        let squares = offset.map(|series| product(series, series));
        let left = [0, 1, 2].map(|k| f64::from(u8::from(k == 0)) - squares.iter().map(|square| square[k]).sum::<f64>());
        let bump = if left[0] > 0.0 { product(left, product(left, left)) } else { [0.0; 3] };
        [0, 1, 2].map(|k| {
            monomials.iter().zip(self.poly).map(|(monomial, entry)| entry * monomial[k]).sum::<DVec3>()
                + self.bump * bump[k]
        })
    }
}

/// A displaced point by series along three curves of the surface.
fn displaced(rest: &OraclePoint, modes: &[Truth], q: &[f32]) -> OraclePoint {
    let along = |tangent: DVec3, second: DVec3| {
        let curve = [rest.point, tangent, 0.5 * second];
        let added = |k: usize| modes.iter().zip(q).map(|(mode, q)| mode.along(curve)[k] * f64::from(*q)).sum::<DVec3>();
        [curve[0] + added(0), curve[1] + added(1), 2.0 * (curve[2] + added(2))]
    };
    let [point, tangent_u, second_uu] = along(rest.tangent_u, rest.second_uu);
    let [_, tangent_v, second_vv] = along(rest.tangent_v, rest.second_vv);
    let both = rest.second_uu + 2.0 * rest.second_uv + rest.second_vv;
    let [.., both] = along(rest.tangent_u + rest.tangent_v, both);
    OraclePoint { point, tangent_u, tangent_v, second_uu, second_uv: 0.5 * (both - second_uu - second_vv), second_vv }
}

#[test]
fn the_certificate_holds_on_displaced_patches_and_not_by_the_bounds_at_rest() -> Result<(), Box<dyn Error>> {
    let most = std::env::var("PALPATE_STEPS").map_or(50_000, |steps| steps.parse::<u64>().expect("a number") / 10);
    let (mut checked, mut planted, mut loosest) = (0_u64, 0_u64, f64::INFINITY);
    for_each_patch(2, |random, patch| {
        let baked = BakedPatch::new(patch)?;
        let table = Table(&baked);
        let truth: Vec<_> = (0..MODES).map(|_| Truth::random(random, patch)).collect();
        let limit = 0.05 * patch.size();
        let text = format!("budget = {limit:?}\n{}", truth.iter().map(Truth::toml).collect::<String>());
        let model = Model { name: String::new(), unit: Unit::Metre, centre: DVec3::ZERO, patches: vec![patch.clone()] };
        let modes = modes::parse(&text, "random", &model)?;
        for _ in 0..10 {
            let q: Vec<_> = (0..MODES).map(|_| (limit * random.between(-1.0, 1.0)) as f32).collect();
            let shape = (&Field::new(&modes, &q)).shape(&baked.shape);
            let at = |parameters| displaced(&table.at(parameters), &truth, &q);
            let mut sampled = 0.0_f64;
            for _ in 0..most.div_ceil(3 * 10 * 50) {
                let step = Step::random(random, &table, at);
                let here = at(step.from);
                let second = shape.second_derivatives;
                for (found, bound) in
                    [(here.second_uu, second.uu), (here.second_uv, second.uv), (here.second_vv, second.vv)]
                {
                    assert!(found.length() <= f64::from(bound), "{q:?}: {} above {bound}", found.length());
                    sampled = sampled.max(found.length() / f64::from(bound));
                }
                for share in [1.0, 0.5, 0.1] {
                    let (margin, _) = step.margin(&table, at, &shape.third_derivatives, share);
                    let Step { from, to, .. } = step;
                    assert!(margin >= 0.0, "{:?}, {from:?} to {to:?}, {q:?}: {margin:e} short", patch.degree);
                    let (at_rest, _) = step.margin(&table, at, &baked.shape.third_derivatives, share);
                    planted += u64::from(at_rest < 0.0);
                    checked += 1;
                }
            }
            loosest = loosest.min(sampled);
        }
        Ok(())
    })?;
    println!(
        "{checked} steps, {planted} above the bound at rest; second derivatives reach {loosest:.2} of their bound"
    );
    assert!(planted > checked / 10_000, "the bounds at rest are broken by {planted} of {checked} only");
    Ok(())
}
