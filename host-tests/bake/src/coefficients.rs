//! Coefficients of a table, with the numbers owned.

/// Coefficients on the host: [`palpate::patch::Coefficients`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub enum BakedCoefficients {
    /// `[x, y, z]`, metres.
    Polynomial(Vec<[f32; 3]>),
    /// `[w x, w y, w z, w]`.
    Rational(Vec<[f32; 4]>),
}

impl BakedCoefficients {
    /// One span as `(w x, w y, w z, w)` in `f64`; the numbers are those of the table.
    pub(super) fn homogeneous_span(&self, degree: [usize; 2], span: usize) -> Vec<[f64; 4]> {
        let count = (degree[0] + 1) * (degree[1] + 1);
        let entries = span * count..(span + 1) * count;
        match self {
            Self::Polynomial(all) => {
                let weight = |index: usize| if index == 0 { 1.0 } else { 0.0 };
                let widen =
                    |(index, [x, y, z]): (usize, &[f32; 3])| [(*x).into(), (*y).into(), (*z).into(), weight(index)];
                all[entries].iter().enumerate().map(widen).collect()
            }
            Self::Rational(all) => all[entries].iter().map(|entry| entry.map(f64::from)).collect(),
        }
    }

    /// Bytes in flash.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Polynomial(entries) => size_of_val(entries.as_slice()),
            Self::Rational(entries) => size_of_val(entries.as_slice()),
        }
    }
}
