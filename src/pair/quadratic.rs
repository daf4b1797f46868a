//! The minimiser of a quadratic model over a box, by an active set.

/// Two parameters of the body, and as many coordinates as a core may have.
pub(super) const SIZE: usize = 5;
/// One number a variable.
pub(super) type Step = [f32; SIZE];

/// A pivot below this fraction of its diagonal is rounding. Parallel edges come near it (the gap over the size).
const MIN_PIVOT: f32 = 2.0e-5;
/// `gᵀd + ½ dᵀ H d` over `lower ≤ d ≤ upper`, where `lower ≤ 0 ≤ upper`, in `N` variables. One without range stays.
pub(super) struct Quadratic<const N: usize> {
    pub gradient: [f32; N],
    pub hessian: [[f32; N]; N],
    pub lower: [f32; N],
    pub upper: [f32; N],
}

impl<const N: usize> Quadratic<N> {
    /// Maximum changes of the active set: every stop on the way is feasible, and not higher.
    const MAX_CHANGES: usize = 4 + 2 * N;

    /// The minimiser; `None` where the model is not positive definite in the variables that are free.
    ///
    /// Starts with the bounds that hold the variables at 0: another start would meet many wrong ones on the way.
    pub fn minimiser(&self) -> Option<[f32; N]> {
        let Self { gradient, lower, upper, .. } = self;
        let mut held: [bool; N] = core::array::from_fn(|i| {
            (lower[i] >= 0.0 && gradient[i] >= 0.0) || (upper[i] <= 0.0 && gradient[i] <= 0.0)
        });
        let mut at = [0.0; N];
        for _ in 0..Self::MAX_CHANGES {
            let way = self.newton(&self.slope(&at), &held)?;
            let (mut share, mut met) = (1.0, None);
            for i in 0..N {
                let space = if way[i] < 0.0 { lower[i] - at[i] } else { upper[i] - at[i] };
                if !held[i] && way[i] * way[i] > 0.0 && space / way[i] < share {
                    (share, met) = (space / way[i], Some(i));
                }
            }
            for i in 0..N {
                at[i] += share * way[i];
            }
            if let Some(i) = met {
                (at[i], held[i]) = (if way[i] < 0.0 { lower[i] } else { upper[i] }, true);
                continue;
            }
            let slope = self.slope(&at);
            let mut worst = (0.0, None);
            for i in 0..N {
                let (pulls_up, pulls_down) = (slope[i] < 0.0 && at[i] < upper[i], slope[i] > 0.0 && at[i] > lower[i]);
                let gain = slope[i] * slope[i] / self.hessian[i][i];
                if held[i] && (pulls_up || pulls_down) && gain > worst.0 {
                    worst = (gain, Some(i));
                }
            }
            match worst.1 {
                Some(i) => held[i] = false,
                None => break,
            }
        }
        Some(core::array::from_fn(|i| crate::math::saturate(at[i], lower[i], upper[i])))
    }

    fn slope(&self, at: &[f32; N]) -> [f32; N] {
        core::array::from_fn(|i| (0..N).fold(self.gradient[i], |sum, k| sum + self.hessian[i][k] * at[k]))
    }

    /// Newton's step of the free variables, by Cholesky's factors.
    fn newton(&self, slope: &[f32; N], held: &[bool; N]) -> Option<[f32; N]> {
        let mut factor = [[0.0_f32; N]; N];
        let mut way = [0.0; N];
        for i in 0..N {
            if held[i] {
                continue;
            }
            way[i] = -slope[i];
            for k in 0..=i {
                let sum = (0..k).fold(self.hessian[i][k], |sum, j| sum - factor[i][j] * factor[k][j]);
                if k < i {
                    // The row of a held variable is 0.
                    factor[i][k] = if held[k] { 0.0 } else { sum * factor[k][k] };
                } else if sum > MIN_PIVOT * self.hessian[i][i] && sum > f32::MIN_POSITIVE {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A box in five variables, against the KKT conditions: the model is convex, so that they are sufficient.
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
            let hessian: [Step; SIZE] =
                core::array::from_fn(|i| core::array::from_fn(|k| product(i, k) + if i == k { 0.1 } else { 0.0 }));
            let at_border = random() > 0.0;
            let model = Quadratic::<SIZE> {
                gradient: core::array::from_fn(|_| 3.0 * random()),
                hessian,
                lower: core::array::from_fn(|i| if at_border && i % 2 == 0 { 0.0 } else { -random().abs() }),
                upper: core::array::from_fn(|i| if at_border && i == 1 { 0.0 } else { random().abs() }),
            };
            let at = model.minimiser().expect("it is convex");
            let slope = model.slope(&at);
            for i in 0..SIZE {
                assert!(at[i] >= model.lower[i] && at[i] <= model.upper[i]);
                // Some twenty roundings of numbers near 5.
                let tolerance = 2e-5;
                assert!(slope[i] < tolerance || at[i] == model.lower[i], "{at:?} {slope:?}");
                assert!(slope[i] > -tolerance || at[i] == model.upper[i], "{at:?} {slope:?}");
            }
        }
    }
}
