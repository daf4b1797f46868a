// The cogging of this board's motor: not recorded yet. `cargo palpate commission --device knob` writes this file.

/// The map.
pub const COGGING: Option<palpate::device::CoggingMap> = None;
