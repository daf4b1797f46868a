//! The minimiser of a quadratic model over a box, by an active set.

use crate::math::{Vec3, vec3};

/// Two parameters of the body, and as many coordinates as a core may have.
pub(super) const SIZE: usize = 5;
/// One number a variable.
pub(super) type Step = [f32; SIZE];

/// A pivot below this fraction of its diagonal is rounding. Parallel edges come near it (the gap over the size).
const MIN_PIVOT: f32 = 2.0e-5;
/// `gᵀd + ½ dᵀ H d` over `lower ≤ d ≤ upper`, where `lower ≤ 0 ≤ upper`. A variable without range stays.
pub(super) struct Quadratic<H, const N: usize> {
    pub gradient: [f32; N],
    pub hessian: H,
    pub lower: [f32; N],
    pub upper: [f32; N],
}

/// A positive Hessian, or one that turns out not to be.
pub(super) trait Hessian<const N: usize> {
    /// Of a variable with itself.
    fn diagonal(&self, i: usize) -> f32;
    /// `slope + H way`.
    fn slope(&self, slope: &[f32; N], way: &[f32; N]) -> [f32; N];
    /// Newton's step of the variables that are not held; `None` where the model is not positive definite in them.
    fn newton(&self, slope: &[f32; N], held: &[bool; N]) -> Option<[f32; N]>;
}

impl<H: Hessian<N>, const N: usize> Quadratic<H, N> {
    /// Maximum changes of the active set: every stop on the way is feasible, and not higher.
    const MAX_CHANGES: usize = 4 + 2 * N;

    /// The minimiser; `None` where the model is not positive definite in the variables that are free.
    ///
    /// Starts with the bounds that hold the variables at 0: another start would meet many wrong ones on the way.
    pub fn minimiser(&self) -> Option<[f32; N]> {
        let Self { gradient, hessian, lower, upper } = self;
        let mut held: [bool; N] = core::array::from_fn(|i| {
            (lower[i] >= 0.0 && gradient[i] >= 0.0) || (upper[i] <= 0.0 && gradient[i] <= 0.0)
        });
        let (mut at, mut slope) = ([0.0; N], *gradient);
        for _ in 0..Self::MAX_CHANGES {
            let way = hessian.newton(&slope, &held)?;
            let (mut share, mut met) = (1.0, None);
            for i in 0..N {
                let next = at[i] + way[i];
                if !held[i] && (next < lower[i] || next > upper[i]) {
                    let space = if way[i] < 0.0 { lower[i] - at[i] } else { upper[i] - at[i] };
                    if space / way[i] < share {
                        (share, met) = (space / way[i], Some(i));
                    }
                }
            }
            for i in 0..N {
                at[i] += share * way[i];
            }
            if let Some(i) = met {
                (at[i], held[i]) = (if way[i] < 0.0 { lower[i] } else { upper[i] }, true);
            }
            slope = hessian.slope(gradient, &at);
            if met.is_some() {
                continue;
            }
            let mut worst = (0.0, None);
            for i in 0..N {
                let (pulls_up, pulls_down) = (slope[i] < 0.0 && at[i] < upper[i], slope[i] > 0.0 && at[i] > lower[i]);
                if held[i] && (pulls_up || pulls_down) {
                    let gain = slope[i] * slope[i] / hessian.diagonal(i);
                    if gain > worst.0 {
                        worst = (gain, Some(i));
                    }
                }
            }
            match worst.1 {
                Some(i) => held[i] = false,
                None => break,
            }
        }
        Some(core::array::from_fn(|i| crate::math::saturate(at[i], lower[i], upper[i])))
    }
}

impl<const N: usize> Hessian<N> for [[f32; N]; N] {
    fn diagonal(&self, i: usize) -> f32 {
        self[i][i]
    }

    fn slope(&self, slope: &[f32; N], way: &[f32; N]) -> [f32; N] {
        core::array::from_fn(|i| (0..N).fold(slope[i], |sum, k| sum + self[i][k] * way[k]))
    }

    /// By Cholesky's factors.
    fn newton(&self, slope: &[f32; N], held: &[bool; N]) -> Option<[f32; N]> {
        let mut factor = [[0.0_f32; N]; N];
        let mut way = [0.0; N];
        for i in 0..N {
            if held[i] {
                continue;
            }
            way[i] = -slope[i];
            for k in 0..=i {
                let sum = (0..k).fold(self[i][k], |sum, j| sum - factor[i][j] * factor[k][j]);
                if k < i {
                    // The row of a held variable is 0.
                    factor[i][k] = if held[k] { 0.0 } else { sum * factor[k][k] };
                } else if sum > MIN_PIVOT * self[i][i] && sum > f32::MIN_POSITIVE {
                    // The inverse of the diagonal.
                    factor[i][i] = crate::math::inverse_sqrt(sum);
                } else {
                    return None;
                }
            }
            for k in 0..i {
                way[i] -= factor[i][k] * way[k];
            }
            way[i] *= factor[i][i];
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                way[i] -= factor[k][i] * way[k];
            }
            way[i] *= factor[i][i];
        }
        Some(way)
    }
}

/// The Hessian of two parameters of the body and the coordinates of a solid: `[[B, −T], [−Tᵀ, k I]]`. The solid's axes
/// are orthonormal, so that its coordinates are eliminated one by one.
pub(super) struct Bordered {
    /// `B`: `uu`, `uv`, `vv`.
    pub block: [f32; 3],
    /// The rows of `T`, the tangents in the solid's frame; zero where only the blocks count.
    pub tangents: [Vec3; 2],
    /// `k`, and its inverse.
    pub stiff: [f32; 2],
}

impl Hessian<SIZE> for Bordered {
    #[inline]
    fn diagonal(&self, i: usize) -> f32 {
        match i {
            0 => self.block[0],
            1 => self.block[2],
            _ => self.stiff[0],
        }
    }

    #[inline]
    fn slope(&self, slope: &Step, way: &Step) -> Step {
        let ([uu, uv, vv], [t_u, t_v]) = (self.block, self.tangents);
        let [u, v, x, y, z] = *way;
        let moved = vec3(x, y, z);
        let of_solid = moved * self.stiff[0] - t_u * u - t_v * v;
        [
            slope[0] + (uu * u + uv * v - t_u.dot(moved)),
            slope[1] + (uv * u + vv * v - t_v.dot(moved)),
            slope[2] + of_solid.x,
            slope[3] + of_solid.y,
            slope[4] + of_solid.z,
        ]
    }

    #[inline]
    fn newton(&self, slope: &Step, held: &[bool; SIZE]) -> Option<Step> {
        let [uu, uv, vv] = self.block;
        let inverse = self.stiff[1];
        let free = |vector: Vec3| {
            let kept = |is_held: bool, x: f32| if is_held { 0.0 } else { x };
            vec3(kept(held[2], vector.x), kept(held[3], vector.y), kept(held[4], vector.z))
        };
        let [t_u, t_v] = self.tangents.map(free);
        let pull = free(vec3(slope[2], slope[3], slope[4])) * inverse;
        let (mut u, mut v) = (0.0, 0.0);
        let of_u = -(slope[0] + t_u.dot(pull));
        let of_v = -(slope[1] + t_v.dot(pull));
        let cross = uv - inverse * t_u.dot(t_v);
        let mut row = (0.0, 0.0);
        if !held[0] {
            let by = inverse_pivot(uu - inverse * t_u.length_squared(), uu)?;
            row = (by, cross * by);
        }
        if !held[1] {
            let of_v = of_v - row.1 * of_u;
            v = of_v * inverse_pivot(vv - inverse * t_v.length_squared() - row.1 * cross, vv)?;
        }
        if !held[0] {
            u = row.0 * of_u - row.1 * v;
        }
        let moved = (t_u * u + t_v * v) * inverse - pull;
        Some([u, v, moved.x, moved.y, moved.z])
    }
}

/// The same where no coordinate of the solid can move, as of a point: `B` alone, with the same roundings.
pub(super) struct Block(pub [f32; 3]);

impl Hessian<2> for Block {
    #[inline]
    fn diagonal(&self, i: usize) -> f32 {
        if i == 0 { self.0[0] } else { self.0[2] }
    }

    #[inline]
    fn slope(&self, slope: &[f32; 2], way: &[f32; 2]) -> [f32; 2] {
        let ([uu, uv, vv], [u, v]) = (self.0, *way);
        [slope[0] + (uu * u + uv * v), slope[1] + (uv * u + vv * v)]
    }

    #[inline]
    fn newton(&self, slope: &[f32; 2], held: &[bool; 2]) -> Option<[f32; 2]> {
        let [uu, uv, vv] = self.0;
        let [of_u, of_v] = slope.map(|slope| -slope);
        let (mut u, mut v, mut row) = (0.0, 0.0, (0.0, 0.0));
        if !held[0] {
            let by = inverse_pivot(uu, uu)?;
            row = (by, uv * by);
        }
        if !held[1] {
            let of_v = of_v - row.1 * of_u;
            v = of_v * inverse_pivot(vv - row.1 * uv, vv)?;
        }
        if !held[0] {
            u = row.0 * of_u - row.1 * v;
        }
        Some([u, v])
    }
}

/// Of a pivot that is not below a fraction of the diagonal, and a number.
#[inline]
fn inverse_pivot(pivot: f32, diagonal: f32) -> Option<f32> {
    (pivot > MIN_PIVOT * diagonal && pivot > f32::MIN_POSITIVE).then_some(1.0 / pivot)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the KKT conditions: the model is convex, so that they are sufficient.
    fn meets_the_conditions<H: Hessian<N>, const N: usize>(model: &Quadratic<H, N>) {
        let at = model.minimiser().expect("it is convex");
        let slope = model.hessian.slope(&model.gradient, &at);
        for i in 0..N {
            assert!(at[i] >= model.lower[i] && at[i] <= model.upper[i]);
            // Some twenty roundings of numbers near 5.
            let tolerance = 2e-5;
            assert!(slope[i] < tolerance || at[i] == model.lower[i], "{at:?} {slope:?}");
            assert!(slope[i] > -tolerance || at[i] == model.upper[i], "{at:?} {slope:?}");
        }
    }

    #[test]
    fn the_minimiser_meets_the_conditions_of_optimality() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for _ in 0..2_000 {
            let columns: [[f32; 7]; SIZE] = core::array::from_fn(|_| core::array::from_fn(|_| random()));
            let product = |i: usize, k: usize| (0..7).map(|j| columns[i][j] * columns[k][j]).sum::<f32>();
            let at_border = random() > 0.0;
            let gradient = core::array::from_fn(|_| 3.0 * random());
            let lower = core::array::from_fn(|i| if at_border && i % 2 == 0 { 0.0 } else { -random().abs() });
            let upper = core::array::from_fn(|i| if at_border && i == 1 { 0.0 } else { random().abs() });
            let hessian: [Step; SIZE] =
                core::array::from_fn(|i| core::array::from_fn(|k| product(i, k) + if i == k { 0.1 } else { 0.0 }));
            meets_the_conditions(&Quadratic { gradient, hessian, lower, upper });
            // Any tangents, and what keeps the model positive.
            let tangents = [0, 1].map(|i| Vec3::from_slice(&columns[i]));
            let [uu, vv] = tangents.map(|tangent| tangent.length_squared() + 0.1);
            let stiff = [1.01, 1.0 / 1.01];
            let hessian = Bordered { block: [uu, tangents[0].dot(tangents[1]), vv], tangents, stiff };
            for i in 0..SIZE {
                let unit = core::array::from_fn(|k| f32::from(i == k));
                assert_eq!(hessian.slope(&[0.0; SIZE], &unit)[i], hessian.diagonal(i));
            }
            let model = Quadratic { gradient, hessian, lower, upper };
            meets_the_conditions(&model);
            // Where no coordinate can move, to the last bit.
            let held = |bounds: Step| [bounds[0], bounds[1], 0.0, 0.0, 0.0];
            let held = Quadratic { lower: held(lower), upper: held(upper), ..model };
            let [u, v, ..] = held.minimiser().expect("it is convex");
            let short = |bounds: Step| [bounds[0], bounds[1]];
            let (gradient, lower, upper) = (short(gradient), short(lower), short(upper));
            let block = Quadratic { gradient, hessian: Block(held.hessian.block), lower, upper };
            meets_the_conditions(&block);
            assert_eq!(block.minimiser(), Some([u, v]));
        }
    }
}
