//! Linear least squares by the normal equations.

/// Rows gathered into the normal equations `Aᵀ A x = Aᵀ b`.
pub struct Normal {
    count: usize,
    matrix: Vec<f64>,
    right: Vec<f64>,
}

impl Normal {
    /// For so many unknowns.
    pub fn new(count: usize) -> Self {
        Self { count, matrix: vec![0.0; count * count], right: vec![0.0; count] }
    }

    /// Adds `Σ factor · x[index] = value`.
    pub fn add(&mut self, row: &[(usize, f64)], value: f64) {
        for (i, a) in row {
            self.right[*i] += a * value;
            for (j, b) in row {
                self.matrix[i * self.count + j] += a * b;
            }
        }
    }

    /// Pulls every unknown towards 0, by this share of the mean of the diagonal.
    pub fn damp(&mut self, share: f64) {
        let trace: f64 = (0..self.count).map(|i| self.matrix[i * self.count + i]).sum();
        let pull = share * trace / self.count.max(1) as f64 + f64::MIN_POSITIVE;
        for i in 0..self.count {
            self.matrix[i * self.count + i] += pull;
        }
    }

    /// By Cholesky's decomposition; none if the matrix is not positive.
    pub fn solve(mut self) -> Option<Vec<f64>> {
        let n = self.count;
        for j in 0..n {
            for k in 0..j {
                let factor = self.matrix[j * n + k];
                for i in j..n {
                    self.matrix[i * n + j] -= self.matrix[i * n + k] * factor;
                }
            }
            let pivot = self.matrix[j * n + j];
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let root = pivot.sqrt();
            for i in j..n {
                self.matrix[i * n + j] /= root;
            }
        }
        let mut x = self.right;
        for i in 0..n {
            for k in 0..i {
                x[i] -= self.matrix[i * n + k] * x[k];
            }
            x[i] /= self.matrix[i * n + i];
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[i] -= self.matrix[k * n + i] * x[k];
            }
            x[i] /= self.matrix[i * n + i];
        }
        Some(x)
    }
}
