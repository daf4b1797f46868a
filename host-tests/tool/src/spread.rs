//! The spread of many counts or errors.

/// Median, 99th percentile and maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread<T> {
    /// The median.
    pub median: T,
    /// The 99th percentile.
    pub most: T,
    /// The maximum.
    pub worst: T,
}

impl<T: Copy + PartialOrd> Spread<T> {
    /// Of at least one value; none may be NaN.
    pub fn of(values: &[T]) -> Option<Self> {
        let mut values = values.to_vec();
        values.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let at = |percent: usize| values.get(((values.len() * percent).div_ceil(100)).max(1) - 1).copied();
        Some(Self { median: at(50)?, most: at(99)?, worst: at(100)? })
    }
}
