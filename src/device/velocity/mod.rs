//! Velocity from encoder positions. None is best at all gains, so there are three and a default.
//!
//! Measured on a simulated hand's motion at 4 kHz and 57.6 µm a count, slow (20 mm/s at most); the stiffest wall is
//! that of the WoodenHaptics arm along one direction at 8 N·s/m (the servo test `velocity` of `host-tests` prints it):
//!
//! | method | delay | noise | stiffest wall | instructions a joint, about |
//! |---|---|---|---|---|
//! | [`VelocityFilter`], 200 Hz: difference and low-pass | 0.75 ms | 11 mm/s | 13.6 kN/m | 5 |
//! | [`TrackingObserver`], same delay | 0.73 ms | 12 mm/s | 13.8 kN/m | 9 |
//! | [`AdaptiveWindow`]: longest line through the last counts | 1.85 ms | 5.7 mm/s | 10.4 kN/m | 15 to 130 |
//!
//! The default is the low-pass: delay is what limits the wall, it has as little of it as the observer, and it is the
//! cheapest. Take the window where damping is heard as a hum in slow motion.

mod adaptive_window;
mod low_pass;
mod tracking;

pub use adaptive_window::{AdaptiveWindow, WINDOW, Window};
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
        }
    }

    /// The state at rest.
    pub const fn start(&self) -> VelocityState {
        match self {
            Self::LowPass(_) => VelocityState::LowPass(0.0),
            Self::AdaptiveWindow(_) => VelocityState::AdaptiveWindow(Window::EMPTY),
            Self::Tracking(_) => VelocityState::Tracking { lag: 0.0, velocity: 0.0 },
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
            _ => {
                *state = self.start();
                0.0
            }
        }
    }
}
