//! Vectors and symmetric matrices of three, in f64: just what the plant's equations need.

/// A vector of three: metres, newtons, or one entry a joint.
pub type Vector = [f64; 3];
/// A matrix by rows.
pub type Matrix = [[f64; 3]; 3];

/// `a · b`.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// `factor a`.
pub fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|entry| entry * factor)
}

/// `a + factor b`.
pub(crate) fn add_scaled(a: Vector, b: Vector, factor: f64) -> Vector {
    core::array::from_fn(|i| a[i] + b[i] * factor)
}

pub(crate) fn difference(a: Vector, b: Vector) -> Vector {
    add_scaled(a, b, -1.0)
}

/// The matrix times a vector.
pub fn times(matrix: &Matrix, vector: Vector) -> Vector {
    matrix.map(|row| dot(row, vector))
}

/// The inverse of a symmetric positive definite matrix, by cofactors.
pub fn inverse(m: &Matrix) -> Matrix {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_the_matrix() {
        let matrix = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.25], [-0.5, 0.25, 2.0]];
        let vector = [0.3, -1.7, 2.9];
        let back = times(&inverse(&matrix), times(&matrix, vector));
        // A few roundings of numbers of order 10.
        assert!(norm(difference(back, vector)) < 1e-14, "{back:?}");
    }
}
