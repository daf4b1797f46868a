//! Devices by name, with where their numbers come from.
//!
//! Published numbers name their source; our own are marked as assumed. Ranges, maximum rates and minimum margins are
//! ours throughout: wide enough for the workspace and for a hand at 2 to 3 m/s.

mod falcon;
mod gimbal_knob;
mod hapkit;
mod haply;
mod phantom;
mod polhem;
mod protection;
mod wooden_haptics;

pub use falcon::NOVINT_FALCON;
pub use gimbal_knob::{GIMBAL_KNOB, GIMBAL_KNOB_COMMUTATION, GIMBAL_KNOB_PROTECTION};
pub use hapkit::HAPKIT;
pub use haply::{HAPLY_2DIY_V3, HAPLY_KIT_V1};
pub use phantom::PHANTOM_PREMIUM;
pub use polhem::{POLHEM_V2, POLHEM_V2_REFERENCE};
pub use protection::{
    NOVINT_FALCON_PROTECTION, PHANTOM_PREMIUM_PROTECTION, POLHEM_V2_PROTECTION, WOODEN_HAPTICS_2016_PROTECTION,
};
pub use wooden_haptics::WOODEN_HAPTICS_2016;

#[cfg(test)]
mod tests {
    use super::*;

    /// A count at the probe, µm, to the lever by which the source states its resolution.
    fn step(encoder: &crate::device::Encoder, lever: f32) -> f32 {
        encoder.radians_per_count.abs() * lever * 1e6
    }

    #[test]
    fn every_device_resolves_what_is_published() {
        let [hapkit] = &HAPKIT.encoders;
        let [haply, _] = &HAPLY_2DIY_V3.encoders;
        let [kit, _] = &HAPLY_KIT_V1.encoders;
        let [_, polhem, _] = &POLHEM_V2.encoders;
        let [falcon, ..] = &NOVINT_FALCON.encoders;
        let [_, phantom, _] = &PHANTOM_PREMIUM.encoders;
        // To the micrometre it is stated to; the levers are handle, crank, first link, thigh and shin.
        for (found, published) in [
            (step(hapkit, 0.065_659), 16.0),
            (step(haply, 0.07), 90.0),
            (step(kit, 0.05), 23.0),
            (step(polhem, 0.165), 35.0),
            (step(falcon, 0.060), 38.0),
            (step(falcon, 0.1025), 65.0),
        ] {
            assert!((found - published).abs() <= 0.5, "{found} µm, published {published} µm");
        }
        // The Phantom's is published as 0.03 mm.
        assert!((step(phantom, 0.209_55) - 30.0).abs() <= 5.0, "{}", step(phantom, 0.209_55));
    }
}
