// The capped box of a foam, held at its bottom, as the body of an image: how many of its modes move is a feature. The modes:
// cargo palpate bake capped_box --soft host-tests/soft/foam.toml --held bottom --modes 8 --out capped_box.rs

/// The body at rest.
#[allow(dead_code)]
mod rest {
    include!("../bodies/capped_box.rs");
}

/// Its modes.
mod deformed {
    include!("../bodies/capped_box_modes.rs");
}

#[allow(unused_imports)]
pub use rest::TABLE_CRC;

/// The type of the surface.
pub type Surface = palpate::servo::SoftBody<'static>;

/// How many modes.
const COUNT: usize = if cfg!(feature = "soft-eight") {
    8
} else if cfg!(feature = "soft-four") {
    4
} else {
    1
};

/// The body with another effort in each tick.
pub const fn with_effort(effort: palpate::body::Effort) -> Surface {
    let Ok(soft) = palpate::body::Soft::new(rest::BODY.with_effort(effort).fitted(palpate::body::TickLimit::BENCH), deformed::MODES.split_at(COUNT).0) else {
        panic!("modes")
    };
    let Ok(surface) = palpate::servo::SoftBody::new(soft, deformed::MOTION.split_at(COUNT).0, super::SETTINGS.rate_hz) else {
        panic!("motion")
    };
    surface
}
