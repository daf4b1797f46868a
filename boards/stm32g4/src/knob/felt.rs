//! The servo of the knob.

use palpate::device::{Device, Dial};
use palpate::servo::{Knob, Servo, Unguarded};
use palpate_bench::Felt;

use crate::body::{KnobServo, SEARCH, device, servo};

/// Its motor's cogging is its own: `None` until it has been recorded.
pub static DEVICE: Device<Dial, 1> = device(None);
static SERVO: KnobServo = servo(&DEVICE, SEARCH);

/// What the loop feels.
pub struct This;

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Unguarded;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Knob, Dial, 1> {
        &SERVO
    }
}
