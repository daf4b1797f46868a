//! The simulated user at the device.

use crate::plant::{HandPath, Vector};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The hand at the device, and the button beside it.
#[derive(Clone, Debug)]
pub struct Hand {
    wants: Arc<Mutex<Wants>>,
    /// The middle of the workspace, in the scene.
    middle: Vector,
}

#[derive(Debug)]
struct Wants {
    /// Target of the tip, metres, in the scene.
    place: Vector,
    /// Whether the enable button is pressed.
    enable: bool,
}

impl Hand {
    /// A hand that holds the tip at a place, metres, in a scene in which the middle of the workspace is at `middle`; it
    /// presses no button.
    pub fn at(place: Vector, middle: Vector) -> Self {
        Self { wants: Arc::new(Mutex::new(Wants { place, enable: false })), middle }
    }

    fn lock(&self) -> MutexGuard<'_, Wants> {
        self.wants.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wants the tip to be here, metres, in the scene's frame. It pulls there as a light grip does.
    pub fn goes_to(&self, place: [f64; 3]) {
        self.lock().place = place;
    }

    /// Presses the enable button, or lets go of it.
    pub fn enables(&self, pressed: bool) {
        self.lock().enable = pressed;
    }

    /// Whether the enable button is pressed.
    pub fn is_enabling(&self) -> bool {
        self.lock().enable
    }
}

impl HandPath for Hand {
    fn target(&self, _time: f64) -> Vector {
        let (place, middle) = (self.lock().place, self.middle);
        std::array::from_fn(|axis| place[axis] - middle[axis])
    }

    fn velocity(&self, _time: f64) -> Vector {
        [0.0; 3]
    }
}
