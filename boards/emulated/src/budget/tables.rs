//! The bodies that are measured, whatever the image's own body: a patch of several spans, and a body of flat and curved
//! faces.

use crate::body::EFFORT;
use palpate::body::Body;

/// A biquadratic patch of three by three spans.
pub mod table1c {
    include!("../../../bodies/table1c.rs");
}

/// Six faces of one span, a biquadratic dome, ruled sides and a bilinear bottom, at this board's effort.
pub static CAPPED_BOX: Body = capped_box::BODY.with_effort(EFFORT);

/// The same.
pub mod capped_box {
    include!("../../../bodies/capped_box.rs");
}
