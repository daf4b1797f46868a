//! The servo of the knob.

use palpate::commission::Wiring;
use palpate::device::{Device, Dial};
use palpate::servo::{Guarded, Knob};
use palpate_bench::Felt;

use palpate_bench::knob::{KnobServo, PROTECTION, SEARCH, device, servo};

/// Its motor's cogging is its own, and recorded over the line: `docs/howto/knob.md`.
mod cogging {
    include!("cogging.rs");
}

pub static DEVICE: Device<Dial, 1> = device(cogging::COGGING);
static SERVO: KnobServo = servo(&DEVICE, SEARCH, PROTECTION);

/// The servo that the loop runs.
pub struct This;

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Guarded<1>;

    #[inline(always)]
    fn servo(&self) -> &KnobServo {
        &SERVO
    }

    #[inline(always)]
    fn wiring(&self) -> Wiring<1> {
        Wiring::STRAIGHT
    }
}
