//! Symmetric matrices: Cholesky's factors, and the lowest eigenvalues of a pencil.

use std::ops::{Index, IndexMut};

/// A square matrix, by rows.
pub struct Matrix {
    side: usize,
    entries: Vec<f64>,
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.entries[row * self.side + column]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.entries[row * self.side + column]
    }
}

/// Rounding of a pivot of the mass, against its entry: moments are exact to some 1e-13.
pub const SINGULAR: f64 = 1e-12;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Matrix {
    pub fn new(side: usize) -> Self {
        Self { side, entries: vec![0.0; side * side] }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.side..(row + 1) * self.side]
    }

    pub fn times(&self, vector: &[f64]) -> Vec<f64> {
        (0..self.side).map(|row| dot(self.row(row), vector)).collect()
    }

    /// Its first rows and columns.
    pub fn corner(&self, side: usize) -> Self {
        Self { side, entries: (0..side).flat_map(|row| &self.row(row)[..side]).copied().collect() }
    }

    /// `None` unless the matrix is positive definite by more than a part of each entry of its diagonal.
    pub fn cholesky(mut self, part: f64) -> Option<Lower> {
        for row in 0..self.side {
            for column in 0..=row {
                let sum = dot(&self.row(row)[..column], &self.row(column)[..column]);
                let left = self[(row, column)] - sum;
                if row == column {
                    let is_definite = left > part * self[(row, row)];
                    if !is_definite {
                        return None;
                    }
                    self[(row, row)] = left.sqrt();
                } else {
                    self[(row, column)] = left / self[(column, column)];
                }
            }
        }
        Some(Lower(self))
    }
}

/// The lower factor `L` of `L Lᵀ`.
pub struct Lower(Matrix);

impl Lower {
    fn forward(&self, mut vector: Vec<f64>) -> Vec<f64> {
        for row in 0..vector.len() {
            let sum = dot(&self.0.row(row)[..row], &vector[..row]);
            vector[row] = (vector[row] - sum) / self.0[(row, row)];
        }
        vector
    }

    fn backward(&self, mut vector: Vec<f64>) -> Vec<f64> {
        for row in (0..vector.len()).rev() {
            vector[row] /= self.0[(row, row)];
            let (value, of) = (vector[row], self.0.row(row));
            vector[..row].iter_mut().zip(of).for_each(|(entry, of)| *entry -= of * value);
        }
        vector
    }

    pub fn solve(&self, vector: Vec<f64>) -> Vec<f64> {
        self.backward(self.forward(vector))
    }
}

/// The lowest eigenvalues of `K x = λ M x` with their vectors, in rising order, by iteration on a subspace of
/// `(L⁻¹ K L⁻ᵀ + shift)⁻¹` with `M = L Lᵀ`, in which the monomials' condition has gone. `None` where a matrix is singular,
/// or the iteration does not settle.
pub fn lowest(stiffness: &Matrix, mass: &Matrix, count: usize, shift: f64) -> Option<Vec<(f64, Vec<f64>)>> {
    /// Relative change of a value in a round where it has settled, and where rounding alone is left.
    const SETTLED: [f64; 2] = [1e-9, 1e-5];
    let side = mass.side;
    let lower = Matrix { side, entries: mass.entries.clone() }.cholesky(SINGULAR)?;
    let rows: Vec<_> = (0..side).map(|row| lower.forward(stiffness.row(row).to_vec())).collect();
    let mut pencil = Matrix::new(side);
    for column in 0..side {
        let of = lower.forward(rows.iter().map(|row| row[column]).collect());
        (0..side).for_each(|row| pencil[(row, column)] = of[row]);
        pencil[(column, column)] += shift;
    }
    let factor = Matrix { side, entries: pencil.entries.clone() }.cholesky(0.0)?;
    // Half as many more as asked for: the last of those converge by the ratio to the first beyond.
    let width = (count + count / 2 + 4).min(side);
    let mut random = crate::Random::new(1);
    let mut vectors: Vec<Vec<f64>> =
        (0..width).map(|_| (0..side).map(|_| random.between(-1.0, 1.0)).collect()).collect();
    let (mut last, mut change) = (vec![f64::INFINITY; width], f64::INFINITY);
    for _ in 0..60 {
        let (values, next) = reduced(&pencil, vectors.into_iter().map(|vector| factor.solve(vector)).collect());
        vectors = next;
        let changes = values.iter().zip(&last).take(count).map(|(now, last)| (now / last - 1.0).abs());
        change = changes.fold(0.0, f64::max);
        last = values;
        if change < SETTLED[0] {
            break;
        }
    }
    let back = |(value, vector): (f64, Vec<f64>)| (value - shift, lower.backward(vector));
    (change < SETTLED[1]).then(|| last.into_iter().zip(vectors).take(count).map(back).collect())
}

/// Ritz's values and vectors in the span of some vectors.
fn reduced(matrix: &Matrix, vectors: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let vectors = orthonormal(vectors);
    let width = vectors.len();
    let mut small = Matrix::new(width);
    for (column, vector) in vectors.iter().enumerate() {
        let image = matrix.times(vector);
        for (row, vector) in vectors.iter().enumerate() {
            small[(row, column)] = dot(vector, &image);
        }
    }
    let (values, columns) = jacobi(small);
    let mut order: Vec<_> = (0..width).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let vector = |index: &usize| {
        let mut sum = vec![0.0; matrix.side];
        for (row, vector) in vectors.iter().enumerate() {
            let weight = columns[(row, *index)];
            sum.iter_mut().zip(vector).for_each(|(sum, entry)| *sum += weight * entry);
        }
        sum
    };
    (order.iter().map(|index| values[*index]).collect(), order.iter().map(vector).collect())
}

/// Gram and Schmidt's; twice, for vectors that are nearly in one plane.
fn orthonormal(mut vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for index in 0..vectors.len() {
        let (before, rest) = vectors.split_at_mut(index);
        let vector = &mut rest[0];
        for _ in 0..2 {
            for other in &*before {
                let part = dot(other, vector);
                vector.iter_mut().zip(other).for_each(|(entry, other)| *entry -= part * other);
            }
            let length = dot(vector, vector).sqrt();
            vector.iter_mut().for_each(|entry| *entry /= length);
        }
    }
    vectors
}

/// Eigenvalues and vectors, by columns, of a symmetric matrix: Jacobi's rotations.
fn jacobi(mut matrix: Matrix) -> (Vec<f64>, Matrix) {
    let side = matrix.side;
    let mut vectors = Matrix::new(side);
    (0..side).for_each(|index| vectors[(index, index)] = 1.0);
    for _ in 0..30 {
        let mut off = 0.0;
        for p in 0..side {
            for q in p + 1..side {
                let entry = matrix[(p, q)];
                off += entry * entry;
                if entry == 0.0 {
                    continue;
                }
                let theta = 0.5 * (matrix[(q, q)] - matrix[(p, p)]) / entry;
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..side {
                    let (a, b) = (matrix[(k, p)], matrix[(k, q)]);
                    (matrix[(k, p)], matrix[(k, q)]) = (c * a - s * b, s * a + c * b);
                }
                for k in 0..side {
                    let (a, b) = (matrix[(p, k)], matrix[(q, k)]);
                    (matrix[(p, k)], matrix[(q, k)]) = (c * a - s * b, s * a + c * b);
                }
                for k in 0..side {
                    let (a, b) = (vectors[(k, p)], vectors[(k, q)]);
                    (vectors[(k, p)], vectors[(k, q)]) = (c * a - s * b, s * a + c * b);
                }
            }
        }
        let diagonal: f64 = (0..side).map(|index| matrix[(index, index)].powi(2)).sum();
        if off <= 1e-30 * diagonal {
            break;
        }
    }
    ((0..side).map(|index| matrix[(index, index)]).collect(), vectors)
}
