//! First-order adaptive windowing: a long window when slow, a short one when fast.

/// The longest window, in periods.
pub const WINDOW: usize = 16;

/// The slope of the longest line from the newest position to one at most [`WINDOW`] periods back that passes all
/// positions between within a band of one count.
///
/// F. Janabi-Sharifi, V. Hayward, C.-S. J. Chen, *Discrete-time adaptive windowing for velocity estimation*, IEEE
/// Trans. Control Systems Technology 8(6), 2000: the end-fit form. There every line is checked against every point;
/// here the slopes that each point allows are intersected as the window grows, which gives the same window in one pass
/// of at most [`WINDOW`] steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveWindow {
    count: f32,
    rate: f32,
}

/// The last moves, in a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    moves: [f32; WINDOW],
    newest: u8,
    length: u8,
}

impl Window {
    /// No moves yet.
    pub const EMPTY: Self = Self { moves: [0.0; WINDOW], newest: 0, length: 0 };

    /// The ring, and where it stands.
    pub const fn parts(&self) -> ([f32; WINDOW], [u8; 2]) {
        (self.moves, [self.newest, self.length])
    }

    #[inline]
    fn push(&mut self, moved: f32) {
        self.newest = (self.newest + 1) % WINDOW as u8;
        if let Some(entry) = self.moves.get_mut(self.newest as usize) {
            *entry = moved;
        }
        if (self.length as usize) < WINDOW {
            self.length += 1;
        }
    }

    /// The move `back` periods before the newest.
    #[inline]
    fn back(&self, back: usize) -> f32 {
        self.moves.get((self.newest as usize + WINDOW - back) % WINDOW).copied().unwrap_or(0.0)
    }
}

/// `1/n`.
const RECIPROCALS: [f32; WINDOW] = {
    let mut table = [0.0; WINDOW];
    let mut index = 0;
    while index < WINDOW {
        table[index] = 1.0 / (index + 1) as f32;
        index += 1;
    }
    table
};

impl AdaptiveWindow {
    /// A window for positions of `count` a step, in the unit of position, sampled at `rate` Hz.
    pub const fn new(count: f32, rate: f32) -> Self {
        // Of either sign, by the encoder's direction. Whole counts put many points on the very edge of the band: a
        // thousandth more, so that rounding does not decide.
        Self { count: count.abs() * 1.001, rate }
    }

    /// The velocity, after a period in which the position moved by `moved`.
    ///
    /// Not inlined: it is long, and beside it the other estimators' loop over the joints would not be unrolled.
    #[inline(never)]
    pub fn next(&self, window: &mut Window, moved: f32) -> f32 {
        window.push(moved);
        // Per period: how far the position moved over `n` periods, the slopes allowed so far, and the best slope.
        let mut travelled = 0.0;
        let (mut least, mut greatest) = (f32::NEG_INFINITY, f32::INFINITY);
        let mut slope = 0.0;
        for (back, reciprocal) in RECIPROCALS.iter().enumerate().take(window.length as usize) {
            travelled += window.back(back);
            let line = travelled * reciprocal;
            // False for a NaN too: then the last slope stands.
            let passes = least <= line && line <= greatest;
            if !passes {
                break;
            }
            slope = line;
            let allowance = self.count * reciprocal;
            if line - allowance > least {
                least = line - allowance;
            }
            if line + allowance < greatest {
                greatest = line + allowance;
            }
        }
        slope * self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published form: every line against every point.
    fn published(positions: &[f32], count: f32, rate: f32) -> f32 {
        let newest = positions.len() - 1;
        let mut slope = 0.0;
        for n in 1..=WINDOW.min(newest) {
            let line = (positions[newest] - positions[newest - n]) / n as f32;
            let fits = (1..n).all(|j| {
                let off = positions[newest] - line * j as f32 - positions[newest - j];
                off.abs() <= count * 1.001
            });
            if !fits {
                break;
            }
            slope = line;
        }
        slope * rate
    }

    #[test]
    fn one_pass_finds_the_published_window() {
        let (count, rate) = (1.0, 1_000.0);
        let estimator = AdaptiveWindow::new(count, rate);
        let mut window = Window::EMPTY;
        let mut positions = [0.0_f32; 20_000];
        let mut different = 0;
        for step in 1..20_000 {
            let time = step as f32 * 1e-3;
            // From standing still to 20 counts a period.
            let (sine, _) = crate::math::sin_cos(time * 1.7);
            let position = (sine * 8_000.0 * (time * 0.05)) as i32 as f32;
            let moved = position - positions[step - 1];
            positions[step] = position;
            let found = estimator.next(&mut window, moved);
            let expected = published(&positions[..=step], count, rate);
            different += usize::from((found - expected).abs() > 1e-3 * rate);
        }
        assert_eq!(different, 0);
    }

    #[test]
    fn a_step_back_shortens_the_window_and_a_nan_is_forgotten() {
        let estimator = AdaptiveWindow::new(1.0, 1_000.0);
        let mut window = Window::EMPTY;
        for _ in 0..100 {
            estimator.next(&mut window, 10.0);
        }
        assert_eq!(estimator.next(&mut window, -10.0), -10_000.0);
        assert!(estimator.next(&mut window, f32::NAN).is_finite());
        let later = (0..WINDOW).map(|_| estimator.next(&mut window, 2.0)).last();
        assert_eq!(later, Some(2_000.0));
    }
}
