//! The numbers of a table: coefficients of the powers of a span's parameters.

/// The coefficients of all spans: span `(i, j)` is entry `i · spans_v + j`; in a span, row `k` holds the power `k` of
/// `s`, and its columns the powers of `t`. `s` and `t` are the distances from the span's centre, in parameters.
///
/// ```
/// use palpate::patch::Coefficients;
///
/// // Degree (1, 1): 1, t, s, st. A square of 0.2 m around (0, 0, 0.05).
/// static SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.05], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0; 3]];
/// const TABLE: Coefficients = Coefficients::Polynomial(&SQUARE);
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Coefficients<'a> {
    /// `[x, y, z]`, metres.
    Polynomial(&'a [[f32; 3]]),
    /// `[w x, w y, w z, w]`.
    Rational(&'a [[f32; 4]]),
}

impl Coefficients<'_> {
    /// 1 if rational.
    pub(crate) const fn tag(&self) -> u32 {
        matches!(self, Self::Rational(_)) as u32
    }
}

/// The `index`-th word of coefficients.
pub(crate) const fn coefficient_word(coefficients: Coefficients<'_>, index: usize) -> Option<u32> {
    match coefficients {
        Coefficients::Polynomial(entries) if index / 3 < entries.len() => Some(entries[index / 3][index % 3].to_bits()),
        Coefficients::Rational(entries) if index / 4 < entries.len() => Some(entries[index / 4][index % 4].to_bits()),
        _ => None,
    }
}
