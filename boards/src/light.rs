//! The light's signals.

/// Whether the light is on in a tick: steady while the motors are driven; four times a second after a fault; a short
/// flash a second while something holds or enable has to be released first; dark where nothing is asked for.
pub(crate) const fn is_lit(tick: u32, rate: u32, drives: bool, is_fault: bool, holds: bool) -> bool {
    // A sixteenth of a second, from 0; at most 1.6 million.
    let sixteenth = tick % rate * 16 / rate;
    if drives {
        true
    } else if is_fault {
        sixteenth & 0b10 == 0
    } else {
        holds && sixteenth == 0
    }
}
