//! Velocity from encoder positions. None is best at all gains, so there are four and a default.
//!
//! Measured on a simulated hand's motion at 4 kHz and 57.6 µm a count, slow (20 mm/s at most); the stiffest wall is
//! that of the WoodenHaptics arm along one direction at 8 N·s/m (the servo test `velocity` of `host-tests` prints it):
//!
//! | method | delay | noise | stiffest wall | instructions a joint, about |
//! |---|---|---|---|---|
//! | [`VelocityFilter`], 200 Hz: difference and low-pass | 0.75 ms | 11 mm/s | 15.1 kN/m | 5 |
//! | [`TrackingObserver`], same delay | 0.73 ms | 12 mm/s | 15.1 kN/m | 9 |
//! | [`AdaptiveWindow`]: longest line through the last counts | 1.85 ms | 5.7 mm/s | 10.4 kN/m | 15 to 130 |
//! | [`BetweenCounts`], 80 Hz: the observer with play, position believed | 2.1 ms | 5.0 mm/s | 4.1 kN/m | 20 |
//!
//! The default is the low-pass: delay is what limits the wall, it has as little of it as the observer, and it is the
//! cheapest. Take the window where damping is heard as a hum in slow motion.
//!
//! [`BetweenCounts`] is the observer for a wall that is to feel smooth: its position is believed in the place of the
//! counts', so that a spring on it does not buzz. That costs the wall the observer's delay: see
//! [`crate::render::bounds`].

mod adaptive_window;
mod between;
mod low_pass;
mod tracking;

pub use adaptive_window::{AdaptiveWindow, WINDOW, Window};
pub use between::BetweenCounts;
pub use low_pass::VelocityFilter;
pub use tracking::TrackingObserver;

/// Which estimator a loop uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VelocityMethod {
    /// Difference and low-pass.
    #[default]
    LowPass,
    /// First-order adaptive windowing.
    AdaptiveWindow,
    /// Tracking observer.
    Tracking,
    /// Tracking observer with half a count of play, whose position is believed, too.
    BetweenCounts,
}

/// One joint's velocity estimator, ready to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityEstimator {
    /// Difference and low-pass.
    LowPass(VelocityFilter),
    /// First-order adaptive windowing.
    AdaptiveWindow(AdaptiveWindow),
    /// Tracking observer.
    Tracking(TrackingObserver),
    /// Tracking observer with half a count of play, whose position is believed, too.
    BetweenCounts(BetweenCounts),
}

/// What an estimator remembers of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityState {
    /// The last velocity.
    LowPass(f32),
    /// The last moves.
    AdaptiveWindow(Window),
    /// How far the estimate lags behind the position, and the velocity.
    Tracking {
        /// Position less its estimate.
        lag: f32,
        /// The last velocity.
        velocity: f32,
    },
    /// How far the position that is believed lags behind the middle of the count, and the velocity.
    BetweenCounts {
        /// Middle of the count less the position.
        lag: f32,
        /// The last velocity.
        velocity: f32,
    },
}

impl VelocityState {
    /// The middle of the count that was read, less the position that is believed; 0 where every count is believed.
    #[inline]
    pub const fn lag(&self) -> f32 {
        match self {
            Self::BetweenCounts { lag, .. } => *lag,
            Self::LowPass(_) | Self::AdaptiveWindow(_) | Self::Tracking { .. } => 0.0,
        }
    }
}

impl VelocityEstimator {
    /// An estimator for positions sampled at `rate` (Hz). `corner` (Hz) sets the delay of the low-pass and of the
    /// observer to the same `1/(2π corner)`; `count` is one encoder count in the unit of position, which the window
    /// allows for.
    pub const fn new(method: VelocityMethod, corner: f32, rate: f32, count: f32) -> Self {
        match method {
            VelocityMethod::LowPass => Self::LowPass(VelocityFilter::new(corner, rate)),
            VelocityMethod::AdaptiveWindow => Self::AdaptiveWindow(AdaptiveWindow::new(count, rate)),
            VelocityMethod::Tracking => Self::Tracking(TrackingObserver::new(2.0 * corner, rate)),
            VelocityMethod::BetweenCounts => Self::BetweenCounts(BetweenCounts::new(2.0 * corner, rate, count)),
        }
    }

    /// The state at rest.
    pub const fn start(&self) -> VelocityState {
        match self {
            Self::LowPass(_) => VelocityState::LowPass(0.0),
            Self::AdaptiveWindow(_) => VelocityState::AdaptiveWindow(Window::EMPTY),
            Self::Tracking(_) => VelocityState::Tracking { lag: 0.0, velocity: 0.0 },
            Self::BetweenCounts(_) => VelocityState::BetweenCounts { lag: 0.0, velocity: 0.0 },
        }
    }

    /// The velocity, after a period in which the position moved by `moved`. A state of another method starts afresh.
    #[inline]
    pub fn next(&self, state: &mut VelocityState, moved: f32) -> f32 {
        match (self, &mut *state) {
            (Self::LowPass(filter), VelocityState::LowPass(velocity)) => {
                *velocity = filter.next(*velocity, moved);
                *velocity
            }
            (Self::AdaptiveWindow(window), VelocityState::AdaptiveWindow(moves)) => window.next(moves, moved),
            (Self::Tracking(observer), VelocityState::Tracking { lag, velocity }) => {
                (*lag, *velocity) = observer.next(*lag, *velocity, moved);
                *velocity
            }
            (Self::BetweenCounts(observer), VelocityState::BetweenCounts { lag, velocity }) => {
                (*lag, *velocity) = observer.next(*lag, *velocity, moved);
                *velocity
            }
            _ => self.start_afresh(state),
        }
    }

    /// Out of the way: no loop changes its method while it runs.
    #[cold]
    fn start_afresh(&self, state: &mut VelocityState) -> f32 {
        *state = self.start();
        0.0
    }
}
