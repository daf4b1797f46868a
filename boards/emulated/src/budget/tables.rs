//! The bodies that are measured, whatever the image's own body: a patch of several spans, and a body of flat and curved
//! faces.

/// A biquadratic patch of three by three spans.
pub mod table1c {
    include!("../../../bodies/table1c.rs");
}

/// Six bicubic faces of one span.
pub mod capped_box {
    include!("../../../bodies/capped_box.rs");
}
