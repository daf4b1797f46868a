//! The spans of a patch: degrees and borders.

/// Maximum number of spans along either parameter.
pub const MAX_SPANS: usize = 256;

/// The spans of a patch: their degrees, and their borders from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpanGrid<'a> {
    pub degree: [u8; 2],
    pub breaks_u: &'a [f32],
    pub breaks_v: &'a [f32],
}

impl SpanGrid<'_> {
    /// Whether there is one span, from 0 to 1 along both parameters.
    #[inline(always)]
    pub fn is_one_span(&self) -> bool {
        self.breaks_u.len() + self.breaks_v.len() == 4
    }

    /// The span that holds `(u, v)`, and where in it, from its centre. One copy for all kinds of coefficients.
    #[inline(never)]
    pub fn locate(&self, u: f32, v: f32) -> (usize, [f32; 2]) {
        let (span_u, s) = locate(self.breaks_u, u);
        let (span_v, t) = locate(self.breaks_v, v);
        (span_u * (self.breaks_v.len() - 1) + span_v, [s, t])
    }

    /// [`super::Patch::beyond_knots`], with the spans that the evaluation takes.
    #[inline(never)]
    pub fn beyond_borders(&self, from: [f32; 2], to: [f32; 2]) -> [f32; 2] {
        let along = |borders: &[f32], from: f32, to: f32| match guess(borders, from) {
            (_, Some([left, right])) if *left <= to && to <= *right => 0.0,
            (span, Some(_)) => beyond_span(borders, span, to),
            (_, None) => beyond_span(borders, bisect(borders, from).0, to),
        };
        [along(self.breaks_u, from[0], to[0]), along(self.breaks_v, from[1], to[1])]
    }
}

/// [`beyond`] from a span that usually does not hold `to`.
#[inline(never)]
fn beyond_span(borders: &[f32], left: usize, to: f32) -> f32 {
    beyond(borders, left, locate(borders, to).0, to)
}

/// Sum of the squared distances of `to` from the borders between two spans.
#[inline(never)]
pub(crate) fn beyond(borders: &[f32], left: usize, reached: usize, to: f32) -> f32 {
    let (first, last) = if left < reached { (left, reached) } else { (reached, left) };
    let crossed = borders.get(first + 1..=last).unwrap_or(&[]);
    crossed.iter().fold(0.0, |sum, knot| sum + (to - knot) * (to - knot))
}

/// The span between rising borders that holds `parameter`, and the distance from the span's centre. On a border it is
/// either of the two.
#[inline(always)]
fn locate(borders: &[f32], parameter: f32) -> (usize, f32) {
    match guess(borders, parameter) {
        (span, Some([left, right])) => (span, parameter - span_centre(*left, *right)),
        (_, None) => bisect(borders, parameter),
    }
}

/// The span that would hold `parameter` with even borders, which is the usual case, and its borders if it does.
#[inline(always)]
fn guess(borders: &[f32], parameter: f32) -> (usize, Option<&[f32; 2]>) {
    // At most 256. As 32 bits with a sign: of 64 without one the host's conversions are long.
    let spans = borders.len() - 1;
    let even = (parameter * (spans as i32) as f32) as i32;
    let span = (even.cast_unsigned() as usize).min(spans - 1);
    let ends = borders.get(span..).and_then(|rest| rest.first_chunk());
    (span, ends.filter(|[left, right]| *left <= parameter && parameter <= *right))
}

/// Bisection: at most log2([`MAX_SPANS`]) rounds. A parameter beyond the borders is in the first or last span.
#[inline(never)]
pub(crate) fn bisect(borders: &[f32], parameter: f32) -> (usize, f32) {
    let (mut borders, mut span) = (borders, 0);
    while borders.len() > 2 {
        let half = borders.len() / 2;
        if parameter >= borders[half] {
            borders = &borders[half..];
            span += half;
        } else {
            borders = &borders[..=half];
        }
    }
    let [left, right] = *borders else { return (0, 0.0) };
    (span, parameter - span_centre(left, right))
}

/// The centre of a span, about which its powers are taken. The host expands about this `f32`.
pub const fn span_centre(left: f32, right: f32) -> f32 {
    0.5 * (left + right)
}

pub(crate) const fn breaks_are_valid(breaks: &[f32]) -> bool {
    if breaks.len() < 2 || breaks.len() > MAX_SPANS + 1 || breaks[0] != 0.0 || breaks[breaks.len() - 1] != 1.0 {
        return false;
    }
    let mut index = 1;
    while index < breaks.len() {
        let rises = breaks[index] > breaks[index - 1];
        if !rises {
            return false;
        }
        index += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_spans_as_can_be_and_no_more() {
        let even: [f32; MAX_SPANS + 2] = core::array::from_fn(|index| index as f32 / MAX_SPANS as f32);
        assert!(breaks_are_valid(&even[..=MAX_SPANS]));
        let mut more: [f32; MAX_SPANS + 2] = core::array::from_fn(|index| index as f32 / (MAX_SPANS + 1) as f32);
        more[MAX_SPANS + 1] = 1.0;
        assert!(!breaks_are_valid(&more));
    }
}
